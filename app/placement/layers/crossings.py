"""How often nets cross in a channel, each with one vertical trunk there (Numba)."""

from __future__ import annotations

from numba import njit

from app.arrays import Floats, Indices


@njit(cache=True)
def left_of(
    one: int, other: int, starts: Indices, middles: Indices, heights: Floats, low: Floats,
    high: Floats,
) -> int:  # fmt: skip
    """Crossings of two groups where the trunk of ``one`` is left of the ``other``'s.

    ``heights`` (t,) are the terminals'; each trunk reaches from ``low`` (g,) to ``high`` (g,). The
    one's way to the right meets the other's trunk, and the other's way to the left the one's.
    """
    found = 0
    for t in range(middles[one], starts[one + 1]):
        found += low[other] < heights[t] < high[other]
    for t in range(starts[other], middles[other]):
        found += low[one] < heights[t] < high[one]
    return found


@njit(cache=True)
def between(one: int, other: int, starts: Indices, middles: Indices, heights: Floats) -> int:
    """Crossings of two groups by the orders of their terminals on each side alone.

    Each way across crosses one that begins above it and ends below it, or the contrary; and what
    turns back on one side crosses whatever begins between its ends there.
    """
    found = 0
    for a in range(starts[one], middles[one]):
        for b in range(starts[other], middles[other]):
            for c in range(middles[one], starts[one + 1]):
                for d in range(middles[other], starts[other + 1]):
                    found += (heights[a] < heights[b]) != (heights[c] < heights[d])
    return (
        found
        + _turning(starts[one], middles[one], starts[other], middles[other], heights)
        + _turning(starts[other], middles[other], starts[one], middles[one], heights)
        + _turning(middles[one], starts[one + 1], middles[other], starts[other + 1], heights)
        + _turning(middles[other], starts[other + 1], middles[one], starts[one + 1], heights)
    )


@njit(cache=True)
def _turning(first: int, end: int, others: int, last: int, heights: Floats) -> int:
    """Terminals of another group between those of one group, on one side."""
    if end - first < 2 or others == last:
        return 0
    low = high = heights[first]
    for t in range(first + 1, end):
        low, high = min(low, heights[t]), max(high, heights[t])
    found = 0
    for t in range(others, last):
        found += low < heights[t] < high
    return found


@njit(cache=True)
def reaches(
    group: int, starts: Indices, heights: Floats, low: Floats, high: Floats
) -> None:  # fmt: skip
    """Write from where to where a group's trunk reaches."""
    low[group] = heights[starts[group]]
    high[group] = low[group]
    for t in range(starts[group] + 1, starts[group + 1]):
        low[group] = min(low[group], heights[t])
        high[group] = max(high[group], heights[t])


@njit(cache=True)
def all_between(channel_starts: Indices, starts: Indices, middles: Indices, heights: Floats) -> int:
    """Crossings in all channels, by the orders of terminals."""
    found = 0
    for channel in range(len(channel_starts) - 1):
        for one in range(channel_starts[channel], channel_starts[channel + 1]):
            for other in range(channel_starts[channel], one):
                found += between(one, other, starts, middles, heights)
    return found
