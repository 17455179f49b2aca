"""The name that was meant, for one that does not exist."""

from __future__ import annotations

from collections.abc import Collection
from difflib import get_close_matches

EFFORT = 3_000_000
"""Comparisons of letters that hints for one document are worth: some tenths of a second."""


class Hints:
    """Looks for names that may have been meant, as long as that stays cheap.

    >>> Hints().at("labl", ["label", "kind"])
    ' Did you mean "label"?'
    """

    __slots__ = ("_effort",)

    def __init__(self, effort: int = EFFORT) -> None:
        self._effort = effort

    def at(self, name: str, known: Collection[str]) -> str:
        """A hint at the known name nearest to ``name``, with a blank before it; or nothing."""
        # At worst difflib compares every letter with every other; 50 is a comparison's fixed cost.
        cost = len(known) * (50 + len(name) ** 2)
        if cost > self._effort:
            return ""
        self._effort -= cost
        matches = get_close_matches(name, known, n=1)
        return f' Did you mean "{matches[0]}"?' if matches else ""
