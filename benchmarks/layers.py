"""Random netlists in layers: whether all are proven clear, and how long they take.

``python -m benchmarks.layers [COUNT [CELLS]]``; left out, 75 netlists of 20 to 45 cells. Seconds
are the whole layouts', by the clock, when kernels are compiled.
"""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Sequence

from app.formats import registry
from app.hyperedges.clearance.overlaps import find_overlaps
from app.layout import judge, lay_out
from app.settings import Settings
from benchmarks.random_netlists import random_netlist

COUNT = 75
LEAST, MOST = 20, 45


def faults_and_seconds(seed: int, cells: int) -> tuple[int, float]:
    """Conflicts, pinches, own contacts and overlaps of one netlist together, and its seconds."""
    data = json.dumps(random_netlist(seed, cells)).encode()
    program = registry.read("yosys", data, Settings(), (("placement", "layers"),))
    begun = time.perf_counter()
    layout = lay_out(program)
    seconds = time.perf_counter() - begun
    verdict = judge(layout)
    assert verdict is not None
    faults = len(verdict.certificate.conflicts) + len(verdict.pinches.segments)
    faults += len(verdict.certificate.own.hyperedges)
    faults += len(find_overlaps(layout.placement).items)
    return faults + (not verdict.certificate.certified), seconds


def main(arguments: Sequence[str]) -> int:
    """Lay out so many netlists, and print how many are clear, and their seconds."""
    count = int(arguments[0]) if arguments else COUNT
    faults_and_seconds(0, LEAST)
    found = [
        faults_and_seconds(
            seed, int(arguments[1]) if len(arguments) > 1 else LEAST + seed % (MOST - LEAST + 1)
        )
        for seed in range(count)
    ]
    seconds = sorted(each for _, each in found)
    clear = sum(not faults for faults, _ in found)
    print(
        f"{clear} of {count} clear; {seconds[count // 2]:.2f} s each, {seconds[-1]:.2f} s at most"
    )
    return 0 if clear == count else 1


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
