"""The paper's CURVES (Spratt and Ambler 1994), for all hyperedges of a program at once.

The paper's words and its symbols disagree about the third control point of the two curves that
enter a join M. With C the centroid of the points that are not joined yet:

- ``prose``: J, the centroid of M and the two points joined; the curve that leaves M follows 2M - J.
- ``symbolic``: C; the curve that leaves M follows 2M - C.

The symbols make hairpins (1.8 times the length for three points), so the words are the default.

A join takes the place after all attachments and earlier joins, which is what counts where two pairs
are equally close. Of a pair, the curve from the point with the smaller number is listed first.
"""

from __future__ import annotations

from typing import Literal

import numpy as np
from numba import njit

from app.arrays import Floats, Indices
from app.hyperedges.centroid import accumulate, average
from app.hyperedges.closest import add, closest_directly, living_points, start, take_closest
from app.hyperedges.segments import Curves, Points, Rules, join_last, join_two, normal

FEW = 40
"""With so many connection points, looking at every pair is as fast as keeping a tree."""


def lay_out(
    attachments: Floats,
    directions: Floats,
    starts: Indices,
    join_planes: Floats,
    *,
    reading: Literal["prose", "symbolic"] = "prose",
    fidelity: Literal["best", "paper"] = "best",
    closest: Literal["space", "plane"] = "space",
    search: Literal["tree", "direct"] = "tree",
) -> Curves:
    """CURVES of h hyperedges.

    ``attachments`` and their unit, outward ``directions`` (a, 3), those of hyperedge k from
    ``starts[k]`` to ``starts[k + 1]`` (h + 1,), two or more each; ``join_planes`` (h,). With
    ``fidelity`` "best" the control point next to an attachment lies along its direction, as far
    away as the paper has it; "plane" measures what is closest as seen from above.

    A hyperedge of N attachments has 2N - 3 segments and N - 2 joins, in the order in which CURVES
    makes them. ``search`` "direct" finds the same pairs in cubic time.

    Raises `ValueError` where a hyperedge has fewer than two attachments.

    >>> ends = np.array([[0.0, 0.0, 0.0], [3.0, 0.0, 0.0]])
    >>> up = np.array([[0.0, 0.0, 1.0], [0.0, 0.0, 1.0]])
    >>> curves = lay_out(ends, up, np.array([0, 2]), np.array([2.0]), fidelity="paper")
    >>> curves.control_points[0].tolist()
    [[0.0, 0.0, 0.0], [1.0, 0.0, 2.0], [2.0, 0.0, 2.0], [3.0, 0.0, 0.0]]
    """
    hyperedges = len(starts) - 1
    if hyperedges and int(np.diff(starts).min()) < 2:
        raise ValueError("A hyperedge has two or more attachments.")
    segments = 2 * len(attachments) - 3 * hyperedges
    joins = len(attachments) - 2 * hyperedges
    curves = Curves(
        np.zeros((segments, 4, 3)),
        np.zeros((segments, 2), dtype=np.int64),
        np.zeros((joins, 3)),
        np.zeros((joins, 3)),
    )
    if hyperedges:
        _lay_out_all(
            np.ascontiguousarray(attachments, dtype=np.float64),
            np.ascontiguousarray(directions, dtype=np.float64),
            np.ascontiguousarray(starts, dtype=np.int64),
            np.ascontiguousarray(join_planes, dtype=np.float64),
            Rules(
                reading == "prose",
                fidelity == "best",
                3 if closest == "space" else 2,
                search == "direct",
            ),
            curves,
        )
    return curves


def segment_starts(starts: Indices) -> Indices:
    """Where each hyperedge's segments begin, (h + 1,), from where its attachments do."""
    return 2 * starts - 3 * np.arange(len(starts))


def join_starts(starts: Indices) -> Indices:
    """Where each hyperedge's joins begin, (h + 1,), from where its attachments do."""
    return starts - 2 * np.arange(len(starts))


@njit(cache=True)
def _lay_out_all(
    attachments: Floats,
    directions: Floats,
    starts: Indices,
    join_planes: Floats,
    rules: Rules,
    curves: Curves,
) -> None:
    most = 0
    for k in range(len(starts) - 1):
        most = max(most, starts[k + 1] - starts[k])
    positions = np.empty((2 * most - 2, 3))
    following = np.empty((2 * most - 2, 3))
    living = np.empty(most, np.int64)
    centroid = np.empty(3)
    for k in range(len(starts) - 1):
        begin = starts[k]
        count = starts[k + 1] - begin
        for i in range(count):
            for axis in range(3):
                positions[i, axis] = normal(attachments[begin + i, axis])
        points = Points(positions, following, directions[begin : begin + count], count)
        segment = 2 * begin - 3 * k
        row = begin - 2 * k
        done = 0
        if count > FEW:
            done = _join_many(points, living, centroid, join_planes[k], rules, curves, segment, row)
        else:
            for i in range(count):
                living[i] = i
        _join_few(points, living, centroid, join_planes[k], rules, curves, segment, row, done)


@njit(cache=True)
def _join_many(
    points: Points,
    living: Indices,
    centroid: Floats,
    plane: float,
    rules: Rules,
    curves: Curves,
    segment: int,
    row: int,
) -> int:
    """Join points until `FEW` are left; the number of joins made. Writes ``living``."""
    at, count = points.positions, points.number
    total = np.zeros((2, 3))
    for i in range(count):
        accumulate(total, at[i], 1.0)
        living[i] = i
    pairs = start(at[: 2 * count - 2], 0 if rules.directly else count, rules.dimensions)
    steps = count - FEW
    for step in range(steps):
        left = count - step
        join = count + step
        if rules.directly:
            first, second = _take_directly(at, living, left, rules.dimensions)
            living[left - 2] = join
        else:
            first, second = take_closest(pairs, at)
        accumulate(total, at[first], -1.0)
        accumulate(total, at[second], -1.0)
        for axis in range(3):
            centroid[axis] = total[0, axis] / (left - 2)
        join_two(
            points,
            first,
            second,
            join,
            centroid,
            plane,
            rules,
            curves,
            segment + 2 * step,
            row + step,
        )
        accumulate(total, at[join], 1.0)
        if not rules.directly:
            add(pairs, at, join)
    if not rules.directly:
        living[:FEW] = living_points(pairs)
    return steps


@njit(cache=True)
def _join_few(
    points: Points,
    living: Indices,
    centroid: Floats,
    plane: float,
    rules: Rules,
    curves: Curves,
    segment: int,
    row: int,
    done: int,
) -> None:
    """Join the points ``living`` that are left when ``done`` joins have been made."""
    count = points.number
    for step in range(done, count - 2):
        left = count - step
        join = count + step
        first, second = _take_directly(points.positions, living, left, rules.dimensions)
        average(points.positions, living, left - 2, centroid)
        living[left - 2] = join
        join_two(
            points,
            first,
            second,
            join,
            centroid,
            plane,
            rules,
            curves,
            segment + 2 * step,
            row + step,
        )
    join_last(points, living[0], living[1], plane, rules, curves, segment + 2 * (count - 2))


@njit(cache=True)
def _take_directly(
    positions: Floats, living: Indices, left: int, dimensions: int
) -> tuple[int, int]:
    """The closest pair of ``living[:left]``, which leaves it; the others move up, in order."""
    a, b = closest_directly(positions, living, left, dimensions)
    first, second = living[a], living[b]
    kept = a
    for place in range(a + 1, left):
        if place != b:
            living[kept] = living[place]
            kept += 1
    return first, second
