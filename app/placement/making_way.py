"""In a row or a column, neighbours make way for what has grown."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from app.arrays import Floats
from app.placement.rooms import TOUCHING
from app.placement.sized import Place


@dataclass(frozen=True, slots=True)
class Way:
    """The rectangles (4,) of what grew and of those that make way for it, by number.

    ``lean`` says how far what grew moves itself, to one side.
    """

    lean: Place
    rectangles: Mapping[int, Floats]


def made_way(
    line: Mapping[int, Floats],
    child: int,
    choices: Sequence[tuple[Place, Floats]],
    gap: float,
    arrangement: Literal["row", "column"],
) -> Way:
    """The way in which the fewest make way for ``child``, and by the least.

    ``line`` are the rectangles (4,) of those that stand in line with it, by number. Each of
    ``choices`` is a way that ``child`` can lean, and its rectangle then; the first is where it
    stood.
    """
    axis = 0 if arrangement == "row" else 1
    stood = choices[0][1]
    middle = float(stood[axis] + stood[axis + 2])
    ways = [
        Way(lean, {child: rectangle, **_pushed(line, rectangle, middle, gap, axis)})
        for lean, rectangle in choices
    ]
    return min(ways, key=lambda way: (len(way.rectangles), _length(way, line)))


def _pushed(
    line: Mapping[int, Floats], rectangle: Floats, middle: float, gap: float, axis: int
) -> dict[int, Floats]:
    """Where those of ``line`` go that are too near, and those that they come too near to then.

    Half of ``middle`` is the coordinate along ``axis`` that parts those before from those behind.
    """
    order = sorted(line, key=lambda child: float(line[child][axis] + line[child][axis + 2]))
    middles = {child: line[child][axis] + line[child][axis + 2] for child in order}
    pushed: dict[int, Floats] = {}
    for side, members in (
        (1, [child for child in order if middles[child] >= middle]),
        (-1, [child for child in reversed(order) if middles[child] < middle]),
    ):
        front, back = (axis, axis + 2) if side > 0 else (axis + 2, axis)
        end = float(rectangle[back])
        for child in members:
            lacking = side * (end - float(line[child][front])) + gap
            if lacking <= TOUCHING:
                break
            by = np.zeros(4)
            by[[axis, axis + 2]] = side * lacking
            pushed[child] = line[child] + by
            end = float(pushed[child][back])
    return pushed


def _length(way: Way, line: Mapping[int, Floats]) -> float:
    """How far all move together."""
    return float(
        sum(
            np.abs(rectangle - line[child])[:2].sum()
            for child, rectangle in way.rectangles.items()
            if child in line
        )
    )
