"""How much is wrong with curves, to choose the better ones."""

from __future__ import annotations

from typing import NamedTuple


class Count(NamedTuple):
    """Pairs of hyperedges, or of a hyperedge and an item, that are too near to each other.

    And ``others``: segments that pinch, and hyperedges that touch themselves. Fewer conflicts count
    more than fewer of these.
    """

    conflicts: int
    others: int


NONE = Count(0, 0)

UNKNOWN = Count(1 << 60, 0)
"""Where there was no time to count."""
