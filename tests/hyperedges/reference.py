"""The paper's CURVES word for word: recursive, over plain tuples, with the cubic search."""

from __future__ import annotations

from itertools import combinations

import numpy as np

from app.arrays import Floats

Point = tuple[int, Floats]


def curves(attachments: Floats, plane: float, prose: bool, dimensions: int = 3) -> Floats:
    """Control points (2N - 3, 4, 3), in the order in which CURVES makes them."""
    points = [(number, np.array(point, dtype=float)) for number, point in enumerate(attachments)]
    return np.array(_curves(plane, points, {}, prose, dimensions, len(points)))


def _centroid(points: list[Floats]) -> Floats:
    return np.asarray(sum(points[1:], points[0]) / len(points))


def _shifted(point: Floats, plane: float) -> Floats:
    return np.array([point[0], point[1], plane])


def _curves(
    plane: float,
    points: list[Point],
    following: dict[int, Floats],
    prose: bool,
    dimensions: int,
    number: int,
) -> list[list[Floats]]:
    if len(points) == 2:
        (i, first), (j, second) = points
        if i in following and j in following:
            return [[first, following[i], following[j], second]]
        if i in following:
            return [[first, following[i], _centroid([following[i], second]), second]]
        if j in following:
            return [[first, _centroid([following[j], first]), following[j], second]]
        thirds = [(2 * first + second) / 3, (first + 2 * second) / 3]
        return [[first, _shifted(thirds[0], plane), _shifted(thirds[1], plane), second]]

    def apart(pair: tuple[Point, Point]) -> tuple[float, int, int]:
        difference = (pair[0][1] - pair[1][1])[:dimensions]
        return (float((difference**2).sum()), pair[0][0], pair[1][0])

    pair = min(combinations(points, 2), key=apart)
    rest = [point for point in points if point[0] not in (pair[0][0], pair[1][0])]
    others = _centroid([point for _, point in rest])
    join = _shifted(_centroid([pair[0][1], pair[1][1], others]), plane)
    entering = _centroid([join, pair[0][1], pair[1][1]]) if prose else others
    made = [
        [point, following.get(i, _centroid([point, join])), entering, join] for i, point in pair
    ]
    onward = {**following, number: 2 * join - entering}
    return made + _curves(plane, [*rest, (number, join)], onward, prose, dimensions, number + 1)
