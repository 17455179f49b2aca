"""What work costs beside other work of the same run, so that a slow or busy machine changes both.

What is bounded is how cost grows with size, or that it is less than that of other work which is
known to be bearable. A process that shares its processor computes longer, too, so of some tries
the least counts.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass

from tests.service import Service, large_program

TRIES = 3

SLACK = 3.0
"""By how much cost may grow faster than size: caches overflow, and others use the machine."""

TIMES = 8
"""How much larger the larger size is: where cost grows with the square, it grows by 64, not 24."""

GOOD_ITEMS = 600
"""Of a document that takes about a second to lay out, by the clock and in CPU time."""


def cpu_of(work: Callable[[], object], tries: int = TRIES) -> float:
    """CPU seconds of this process for ``work``, the least of some tries."""
    found = []
    for _ in range(tries):
        began = time.process_time()
        work()
        found.append(time.process_time() - began)
    return min(found)


def check_growth(work: Callable[[int], object], size: int, slack: float = SLACK) -> None:
    """Check that ``work`` on a multiple of ``size`` costs about that multiple, or less.

    ``size`` takes some milliseconds at least. The first call, which may fill caches, does not
    count.
    """
    work(size)
    small, large = (cpu_of(lambda count=count: work(count)) for count in (size, TIMES * size))  # type: ignore[misc]
    assert large < slack * TIMES * small


def check_costs_less(
    work: Callable[[], object], other: Callable[[], object], times: float, tries: int = TRIES
) -> None:
    """Check that ``work`` costs less than so many ``times`` of ``other``."""
    assert cpu_of(work, tries) < times * cpu_of(other, tries)


@dataclass(frozen=True, slots=True)
class Cost:
    """``seconds`` by the clock, and CPU seconds of the service and its workers."""

    seconds: float
    cpu: float


def cost_of(service: Service, ask: Callable[[], object]) -> Cost:
    """What it takes the service to answer."""
    cpu, began = service.computed(), time.monotonic()
    ask()
    return Cost(time.monotonic() - began, service.computed() - cpu)


def cost_of_good_document(service: Service) -> Cost:
    """Of one that no service has seen, and that takes about a second on a usual machine."""
    with service.client() as client:
        document = large_program(GOOD_ITEMS)
        return cost_of(
            service, lambda: client.post("/v1/layout", content=document).raise_for_status()
        )
