"""How a service bears hostile requests: ``python -m benchmarks.hostile [AMOUNT] [SEED]``."""

from __future__ import annotations

import sys
import tempfile
import time
from pathlib import Path

from tests.hostile import all_hostile
from tests.hostile_run import attack
from tests.service import running_service

MEGABYTE = 2**20


def main(amount: int = 1000, seed: int = 1) -> int:
    """Attack a fresh service and print what came of it; the exit status is the number of faults."""
    with (
        tempfile.TemporaryDirectory() as folder,
        running_service(Path(folder), workers=2) as service,
    ):
        began = time.perf_counter()
        report = attack(service, all_hostile(amount, seed))
        seconds = time.perf_counter() - began
    statuses = ", ".join(
        f"{status}: {number}" for status, number in sorted(report.statuses.items())
    )
    memory = [round(size / MEGABYTE) for size in report.memory]
    print(f"{amount} requests with seed {seed} in {seconds:.0f} s; statuses {statuses}.")
    tenths = ", ".join(str(memory[(len(memory) - 1) * tenth // 10]) for tenth in range(11))
    print(f"Memory of service and workers, in MiB, at the start and after each tenth: {tenths}.")
    print()
    print(report.table())
    for fault in report.faults:
        print(fault)
    return len(report.faults)


if __name__ == "__main__":
    sys.exit(min(main(*map(int, sys.argv[1:])), 100))
