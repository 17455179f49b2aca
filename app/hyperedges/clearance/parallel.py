"""Work on many rows, on all cores."""

from __future__ import annotations

import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numpy as np

FEW = 4096
"""Rows below which a second thread costs more than it saves."""


CORES = os.cpu_count() or 1


def in_parts(count: int, work: Callable[[int, int], Any], few: int = FEW) -> list[Any]:
    """The results of ``work(begin, end)`` on stretches of ``count`` rows, in order.

    Threads, where each has ``few`` rows or more to do; ``work`` has to give up the interpreter's
    lock.
    """
    threads = min(CORES, count // few)
    if threads < 2:
        return [work(0, count)]
    # More parts than threads, because some take longer.
    cuts = np.linspace(0, count, 4 * threads + 1).astype(np.int64).tolist()
    with ThreadPoolExecutor(threads) as pool:
        return list(pool.map(work, cuts[:-1], cuts[1:]))
