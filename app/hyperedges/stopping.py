"""Work that ends before its end, with the best that there is so far."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

Spent = Callable[[], float]
"""Says which share of the time for a work is over: from 0 to 1, or more where it took longer."""


def nothing_spent() -> float:
    """Where there is time without end."""
    return 0.0


class StoppedError(Exception):
    """Raised by reports of progress: end now, with the best that there is so far."""


@dataclass(slots=True)
class Allowance:
    """The time for a work. ``ran_out`` says whether any of it ended early."""

    spent: Spent = nothing_spent
    ran_out: bool = False

    def check(self, share: float = 1.0) -> None:
        """Raise `StoppedError` where so large a share of the time is over."""
        if self.spent() >= share:
            self.ran_out = True
            raise StoppedError


def unchecked() -> None:
    """Where work goes on to its end."""
