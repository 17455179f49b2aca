"""How many faults a document has shown so far: a million are found no faster than a thousand."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

from pydantic import ValidationError
from pydantic_core import PydanticCustomError

ENOUGH = 1_000
"""Faults after which the rest of a document is not looked at: each costs time and memory."""

MOST_KEYS = 1_000
"""Keys of one object that are looked at one by one."""

Checked = TypeVar("Checked")


class Tally:
    """Counts faults while a document is validated; handed through as pydantic's context."""

    __slots__ = ("found",)

    def __init__(self) -> None:
        self.found = 0

    @property
    def full(self) -> bool:
        """Whether there may be more faults than were found."""
        return self.found >= ENOUGH

    def taking(self, value: Any, validate: Callable[[Any], Checked]) -> Checked:
        """``value`` validated; as it is where enough is wrong elsewhere. Raises what pydantic does.

        A document with faults is refused, so nobody sees what has not been validated.
        """
        before = self.found
        if before >= ENOUGH:
            unseen: Checked = value
            return unseen
        if isinstance(value, dict) and len(value) > MOST_KEYS:
            self.found = before + 1
            raise PydanticCustomError("too_many_keys", "Has far more keys than there are")
        try:
            return validate(value)
        except ValidationError as error:
            # Faults of inner parts are among these, and were counted there already.
            self.found = max(self.found, before + error.error_count())
            raise
