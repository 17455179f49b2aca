"""Rows of ports on the sides of items that stand in layers."""

from __future__ import annotations

ROW = 0.6
"""Height of a row, document units."""


def rows_beside(left: int, right: int) -> tuple[list[int], list[int]]:
    """Rows of ports on both sides: in the middle of each other, and all of them whole.

    >>> rows_beside(2, 1), rows_beside(3, 2)
    (([0, 2], [1]), ([0, 1, 2], [0, 2]))
    """

    def spread(count: int, others: int) -> list[int]:
        return [0, 2] if count == 2 and others % 2 else list(range(count))

    def centred(rows: list[int]) -> list[int]:
        return [row + (last - rows[-1]) // 2 for row in rows]

    one, other = spread(left, right), spread(right, left)
    last = max([0, *one, *other])
    return centred(one), centred(other)
