"""The paper's CURVES (Spratt and Ambler 1994), for all hyperedges of a program at once.

The paper's words and its symbols disagree about the third control point of the two curves that
enter a join M. With C the centroid of the points that are not joined yet:

- ``prose``: J, the centroid of M and the two points joined; the curve that leaves M follows 2M - J.
- ``symbolic``: C; the curve that leaves M follows 2M - C.

The symbols make hairpins (1.8 times the length for three points), so the words are the default.
"""

from __future__ import annotations

from typing import Literal, NamedTuple

import numpy as np
from numba import njit

from app.arrays import Floats, Indices
from app.hyperedges.closest import add, closest_directly, start, take_closest

Reading = Literal["prose", "symbolic"]

DIRECT = 40
"""Up to so many attachments, looking at every pair is faster than keeping a tree."""

NO_LENGTH = 1e-12
"""Vectors shorter than this have no direction."""


class Curves(NamedTuple):
    """What `lay_out` finds; for shapes see `app.hyperedges.routing.Routing`."""

    control_points: Floats
    ends: Indices
    joins: Floats
    tangents: Floats


def lay_out(
    attachments: Floats,
    directions: Floats,
    starts: Indices,
    join_planes: Floats,
    *,
    reading: Reading = "prose",
    closest: Literal["space", "plane"] = "space",
    square: bool = False,
) -> Curves:
    """CURVES of h hyperedges.

    ``attachments`` and their unit ``directions`` (a, 3), those of hyperedge k from ``starts[k]`` to
    ``starts[k + 1]`` (h + 1,), two or more each; ``join_planes`` (h,). With ``square`` the control
    point next to an attachment lies along the attachment's direction, as far away as the paper has
    it. Returns ``control_points`` (s, 4, 3), ``ends`` (s, 2), ``joins`` (j, 3) and unit
    ``tangents`` (j, 3), where a hyperedge of N attachments has 2N - 3 segments and N - 2 joins.
    """
    hyperedges = len(starts) - 1
    segments = 2 * len(attachments) - 3 * hyperedges
    joins = len(attachments) - 2 * hyperedges
    curves = Curves(
        np.empty((segments, 4, 3)),
        np.empty((segments, 2), dtype=np.int64),
        np.empty((joins, 3)),
        np.empty((joins, 3)),
    )
    if hyperedges:
        _lay_out_all(
            np.ascontiguousarray(attachments, dtype=np.float64),
            np.ascontiguousarray(directions, dtype=np.float64),
            np.ascontiguousarray(starts, dtype=np.int64),
            np.ascontiguousarray(join_planes, dtype=np.float64),
            reading == "prose",
            square,
            3 if closest == "space" else 2,
            *curves,
        )
    return curves


@njit(cache=True)
def _lay_out_all(
    attachments: Floats,
    directions: Floats,
    starts: Indices,
    planes: Floats,
    prose: bool,
    square: bool,
    dimensions: int,
    segments: Floats,
    ends: Indices,
    joins: Floats,
    tangents: Floats,
) -> None:
    largest = 0
    for k in range(len(starts) - 1):
        if starts[k + 1] - starts[k] <= DIRECT:
            largest = max(largest, starts[k + 1] - starts[k])
    points = np.empty((2 * largest, 3))
    following = np.empty((2 * largest, 3))
    living = np.empty(2 * largest, np.int64)
    for k in range(len(starts) - 1):
        first, last = starts[k], starts[k + 1]
        s = slice(2 * first - 3 * k, 2 * last - 3 * (k + 1))
        j = slice(first - 2 * k, last - 2 * (k + 1))
        if last - first <= DIRECT:
            _few(
                attachments[first:last],
                directions[first:last],
                planes[k],
                prose,
                square,
                dimensions,
                points,
                following,
                living,
                segments[s],
                ends[s],
                joins[j],
                tangents[j],
            )
        else:
            _many(
                attachments[first:last],
                directions[first:last],
                planes[k],
                prose,
                square,
                dimensions,
                segments[s],
                ends[s],
                joins[j],
                tangents[j],
            )


@njit(cache=True)
def _few(
    attachments: Floats,
    directions: Floats,
    plane: float,
    prose: bool,
    square: bool,
    dimensions: int,
    points: Floats,
    following: Floats,
    living: Indices,
    segments: Floats,
    ends: Indices,
    joins: Floats,
    tangents: Floats,
) -> None:
    """CURVES of a hyperedge of few attachments; ``points`` to ``living`` are scratch."""
    count = len(attachments)
    centroid = np.empty(3)
    for i in range(count):
        living[i] = i
        for axis in range(3):
            points[i, axis] = attachments[i, axis]
    for step in range(count - 2):
        left = count - step
        a, b = closest_directly(points, living, left, dimensions)
        first, second = living[a], living[b]
        kept = 0
        for axis in range(3):
            centroid[axis] = 0.0
        for place in range(left):
            if place not in (a, b):
                i = living[place]
                living[kept] = i
                kept += 1
                for axis in range(3):
                    centroid[axis] += points[i, axis]
        for axis in range(3):
            centroid[axis] /= kept
        living[kept] = count + step
        _join(
            points,
            following,
            directions,
            count,
            step,
            first,
            second,
            centroid,
            plane,
            prose,
            square,
            segments,
            ends,
            joins,
            tangents,
        )
    _finish(
        points, following, directions, count, living[0], living[1], plane, square, segments, ends
    )


@njit(cache=True)
def _many(
    attachments: Floats,
    directions: Floats,
    plane: float,
    prose: bool,
    square: bool,
    dimensions: int,
    segments: Floats,
    ends: Indices,
    joins: Floats,
    tangents: Floats,
) -> None:
    """CURVES of a hyperedge of many attachments: the same curves, found through a k-d tree."""
    count = len(attachments)
    points = np.empty((2 * count - 2, 3))
    following = np.empty((2 * count - 2, 3))
    centroid = np.empty(3)
    # Kahan's compensation keeps the running sum of many points right to the last digits.
    total = np.zeros(3)
    lost = np.zeros(3)
    for i in range(count):
        for axis in range(3):
            points[i, axis] = attachments[i, axis]
        _accumulate(total, lost, points[i], 1.0)
    pairs = start(points, count, dimensions)
    for step in range(count - 2):
        first, second = take_closest(pairs, points, dimensions)
        _accumulate(total, lost, points[first], -1.0)
        _accumulate(total, lost, points[second], -1.0)
        for axis in range(3):
            centroid[axis] = total[axis] / (count - step - 2)
        _join(
            points,
            following,
            directions,
            count,
            step,
            first,
            second,
            centroid,
            plane,
            prose,
            square,
            segments,
            ends,
            joins,
            tangents,
        )
        _accumulate(total, lost, points[count + step], 1.0)
        add(pairs, points, count + step, dimensions)
    first, second = take_closest(pairs, points, dimensions)
    _finish(points, following, directions, count, first, second, plane, square, segments, ends)


@njit(cache=True)
def _join(
    points: Floats,
    following: Floats,
    directions: Floats,
    count: int,
    step: int,
    first: int,
    second: int,
    centroid: Floats,
    plane: float,
    prose: bool,
    square: bool,
    segments: Floats,
    ends: Indices,
    joins: Floats,
    tangents: Floats,
) -> None:
    """Join two connection points: one step of CURVES for more than two points."""
    join = count + step
    length = 0.0
    for axis in range(3):
        middle = (points[first, axis] + points[second, axis] + centroid[axis]) / 3.0
        if axis == 2:
            middle = plane
        if prose:
            entering = (middle + points[first, axis] + points[second, axis]) / 3.0
        else:
            entering = centroid[axis]
        points[join, axis] = middle
        following[join, axis] = 2.0 * middle - entering
        joins[step, axis] = middle
        tangents[step, axis] = middle - entering
        length += (middle - entering) ** 2
        for side in range(2):
            segments[2 * step + side, 2, axis] = entering
            segments[2 * step + side, 3, axis] = middle
    if length <= NO_LENGTH * NO_LENGTH:
        # No tangent from the formula: go towards what is still to be joined.
        length = 0.0
        for axis in range(3):
            onward = centroid[axis] - (points[first, axis] + points[second, axis]) / 2.0
            tangents[step, axis] = onward
            length += onward * onward
    for axis in range(3):
        if length > NO_LENGTH * NO_LENGTH:
            tangents[step, axis] /= np.sqrt(length)
        else:
            tangents[step, axis] = 1.0 if axis == 0 else 0.0
    for side in range(2):
        end = first if side == 0 else second
        segment = segments[2 * step + side]
        for axis in range(3):
            segment[0, axis] = points[end, axis]
            if end >= count:
                segment[1, axis] = following[end, axis]
            else:
                segment[1, axis] = (points[end, axis] + points[join, axis]) / 2.0
        if square and end < count:
            _turn_square(segment, 0, 1, directions[end])
        ends[2 * step + side, 0] = end
        ends[2 * step + side, 1] = join


@njit(cache=True)
def _finish(
    points: Floats,
    following: Floats,
    directions: Floats,
    count: int,
    first: int,
    second: int,
    plane: float,
    square: bool,
    segments: Floats,
    ends: Indices,
) -> None:
    """The curve between the two connection points that are left."""
    last = 2 * (count - 2)
    segment = segments[last]
    first_joined = first >= count
    second_joined = second >= count
    for axis in range(3):
        one = points[first, axis]
        other = points[second, axis]
        segment[0, axis] = one
        segment[3, axis] = other
        if first_joined and second_joined:
            segment[1, axis] = following[first, axis]
            segment[2, axis] = following[second, axis]
        elif first_joined:
            segment[1, axis] = following[first, axis]
            segment[2, axis] = (following[first, axis] + other) / 2.0
        elif second_joined:
            segment[1, axis] = (following[second, axis] + one) / 2.0
            segment[2, axis] = following[second, axis]
        else:
            segment[1, axis] = (2.0 * one + other) / 3.0 if axis < 2 else plane
            segment[2, axis] = (one + 2.0 * other) / 3.0 if axis < 2 else plane
    if square and not first_joined:
        _turn_square(segment, 0, 1, directions[first])
    if square and not second_joined:
        _turn_square(segment, 3, 2, directions[second])
    ends[last, 0] = first
    ends[last, 1] = second


@njit(cache=True)
def _turn_square(segment: Floats, end: int, interior: int, direction: Floats) -> None:
    """Turn an interior control point about its end to lie along ``direction``."""
    length = 0.0
    for axis in range(3):
        length += (segment[interior, axis] - segment[end, axis]) ** 2
    length = np.sqrt(length)
    for axis in range(3):
        segment[interior, axis] = segment[end, axis] + length * direction[axis]


@njit(cache=True)
def _accumulate(total: Floats, lost: Floats, summand: Floats, sign: float) -> None:
    for axis in range(3):
        corrected = sign * summand[axis] - lost[axis]
        summed = total[axis] + corrected
        lost[axis] = (summed - total[axis]) - corrected
        total[axis] = summed
