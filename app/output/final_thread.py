"""The one thread that may use Mitsuba: two would end the process."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor, wait
from typing import TypeVar

T = TypeVar("T")

TICK = 0.2
"""Seconds between two signs of life."""

_thread = ThreadPoolExecutor(1, "mitsuba")


def wait_for(work: Callable[[], T], alive: Callable[[], None]) -> T:
    """What ``work`` answers, done in Mitsuba's thread; ``alive`` is called again and again.

    If ``alive`` raises, so does this, but not before ``work`` has come to its end.
    """
    future = _thread.submit(work)
    try:
        while not wait([future], TICK).done:
            alive()
    except BaseException:
        wait([future])
        raise
    return future.result()
