"""As many faults as anybody reads."""

from __future__ import annotations

from collections.abc import Iterable

from app.errors import Fault

MOST_FAULTS = 100


def first(faults: Iterable[Fault], *, at_least: bool = False) -> list[Fault]:
    """The first hundred of ``faults``, and one that says how many more there are.

    ``at_least``: looking for faults was given up before all were found.

    >>> first([Fault(f"/{number}", "Wrong.") for number in range(300)])[-1]
    Fault(pointer='', detail='And 200 more faults.')
    """
    told: list[Fault] = []
    more = 0
    for fault in faults:
        if len(told) < MOST_FAULTS:
            told.append(fault)
        else:
            more += 1
    if more:
        told.append(Fault("", f"And {'at least ' if at_least else ''}{more} more faults."))
    return told
