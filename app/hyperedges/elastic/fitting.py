"""Cubic segments through chains of beads (Numba).

Beads are the control points of a uniform cubic B-spline (de Boor 1978), so that a curve has no
jumps of curvature and stays beside its beads. It begins and ends at attachments, straight, and at
joins, along these' tangents; there handles are chosen that bend it least.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from app.arrays import Flags, Floats, Indices
from app.hyperedges.elastic.beads import Beads
from app.hyperedges.elastic.bending import join_tangent
from app.hyperedges.elastic.chains import Chains
from app.hyperedges.elastic.merging import GENTLE, TIGHT, sweep, wider
from app.hyperedges.weaving.curvature import bend_between, least_radius


class Pieces(NamedTuple):
    """Cubics (p, 4, 3) along chains: ``chains`` (p,), and between which beads of these.

    ``spans`` (p, 2), counted along the chain from 0. ``tangents`` (j, 3) are those of joins.
    """

    curves: Floats
    chains: Indices
    spans: Indices
    tangents: Floats


def fit(
    x: Floats,
    beads: Beads,
    chains: Chains,
    stems: Indices,
    sweeps: Indices,
    before: Pieces | None = None,
    active: Flags | None = None,
) -> Pieces:
    """Cubics along all chains.

    ``stems`` (j,) say which link of a join is its stem; ``sweeps`` (c, 2) over how many segments
    the first and the last cubic go at joins. Hyperedges that are not ``active`` (h,) keep the
    cubics of ``before``.
    """
    tangents = np.zeros((len(stems), 3))
    count = int(beads.segment_starts[-1])
    if before is None or active is None:
        anew = np.ones(len(chains.ends), dtype=np.bool_)
        old, firsts = np.zeros((0, 4, 3)), np.zeros(len(anew) + 1, dtype=np.int64)
        old_spans = np.zeros((0, 2), dtype=np.int64)
    else:
        anew, old, old_spans = active[chains.owners], before.curves, before.spans
        firsts = np.searchsorted(before.chains, np.arange(len(anew) + 1))
    curves, of = np.empty((count, 4, 3)), np.empty(count, np.int64)
    spans = np.empty((count, 2), np.int64)
    made = _fit(
        x,
        beads.ends,
        beads.starts,
        beads.segment_starts,
        beads.links,
        stems,
        chains.radii[chains.owners],
        sweeps,
        anew,
        (old, old_spans, firsts),
        tangents,
        curves,
        of,
        spans,
    )
    return Pieces(curves[:made], of[:made], spans[:made], tangents)


@njit(cache=True, error_model="numpy")
def _fit(
    x: Floats,
    ends: Indices,
    starts: Indices,
    segment_starts: Indices,
    links: Indices,
    stems: Indices,
    radii: Floats,
    sweeps: Indices,
    anew: Flags,
    before: tuple[Floats, Indices, Indices],
    tangents: Floats,
    curves: Floats,
    of: Indices,
    spans: Indices,
) -> int:
    joins = len(stems)
    for i in range(joins):
        join_tangent(x, links, stems[i], i, tangents[i])
    made = 0
    longest = np.diff(segment_starts).max() if len(ends) else 0
    places, speeds = np.empty((longest + 1, 3)), np.empty((longest + 1, 3))
    units = np.empty((longest + 1, 3))
    old, old_spans, firsts = before
    for c in range(len(ends)):
        if not anew[c]:
            for row in range(firsts[c], firsts[c + 1]):
                curves[made], spans[made], of[made] = old[row], old_spans[row], c
                made += 1
            continue
        count = segment_starts[c + 1] - segment_starts[c]
        _knots(x, ends[c], starts[c], count, places, speeds)
        for side in range(2):
            join = ends[c, side]
            if join < joins:
                inwards = starts[c] if side == 0 else starts[c + 1] - 1
                is_stem = links[join, stems[join]] == inwards
                sign = 1.0 if is_stem == (side == 0) else -1.0
                _set_speed(speeds[0 if side == 0 else count], tangents[join], sign)
        for k in range(count + 1):
            length = np.sqrt(speeds[k, 0] ** 2 + speeds[k, 1] ** 2 + speeds[k, 2] ** 2)
            for axis in range(3):
                units[k, axis] = speeds[k, axis] / max(length, 1e-12)
        first = sweep(ends[c, 0] < joins, sweeps[c, 0], True, count, places, units, radii[c])
        last = sweep(ends[c, 1] < joins, sweeps[c, 1], False, count, places, units, radii[c])
        joined = (ends[c, 0] < joins, ends[c, 1] < joins)
        if first + last > max(count, 2):
            # Both ends want more than there is: one cubic from end to end.
            first = last = count
        inner = (first if joined[0] else 0, count - last if joined[1] else count)
        before_made = made
        made = _cut(places, speeds, units, radii[c], count, first, last, inner, curves, spans, made)
        of[before_made:made] = c
    return made


@njit(cache=True, error_model="numpy")
def _cut(
    places: Floats,
    speeds: Floats,
    units: Floats,
    radius: float,
    count: int,
    first: int,
    last: int,
    inner: tuple[int, int],
    curves: Floats,
    spans: Indices,
    made: int,
) -> int:
    """Write the cubics of a chain behind the ``made`` ones; how many there are then.

    The ``first`` and the ``last`` one go over so many segments, the others over one, or over more
    between two of the knots ``inner`` where they would bend too much.
    """
    begin, start = 0, made
    while begin < count:
        end = first if begin == 0 else begin + 1
        if begin > 0 and begin >= count - last:
            end = count
        _set_cubic(places, speeds, begin, end, curves[made])
        bend = least_radius(curves[made])
        if end > begin + 1 or bend < GENTLE * radius:
            bend = bend_between(curves[made], units[begin], units[end], GENTLE * radius)
        if bend < TIGHT * radius and end == begin + 1:
            begin, end = wider(inner, begin, places, units, radius, bend, curves[made])
            # What it takes the place of.
            while made > start and spans[made - 1, 0] >= begin:
                curves[made - 1] = curves[made]
                made -= 1
        spans[made, 0], spans[made, 1] = begin, end
        made += 1
        begin = end
    return made


@njit(cache=True, error_model="numpy")
def _set_cubic(places: Floats, speeds: Floats, begin: int, end: int, curve: Floats) -> None:
    """The spline's cubic, if ``end`` is the knot after ``begin``."""
    for axis in range(3):
        curve[0, axis], curve[3, axis] = places[begin, axis], places[end, axis]
        curve[1, axis] = places[begin, axis] + speeds[begin, axis] / 3.0
        curve[2, axis] = places[end, axis] - speeds[end, axis] / 3.0


@njit(cache=True, error_model="numpy")
def _knots(
    x: Floats, ends: Indices, start: int, count: int, places: Floats, speeds: Floats
) -> None:
    """Places of a spline's knots, and its velocities there."""
    for axis in range(3):
        before, here = 0.0, x[ends[0], axis]
        for k in range(count + 1):
            after = x[ends[1], axis] if k == count - 1 else 0.0
            if k < count - 1:
                after = x[start + k, axis]
            if k == 0:
                places[0, axis], speeds[0, axis] = here, after - here
            elif k == count:
                places[k, axis], speeds[k, axis] = here, here - before
            else:
                places[k, axis] = (before + 4.0 * here + after) / 6.0
                speeds[k, axis] = 0.5 * (after - before)
            before, here = here, after


@njit(cache=True, error_model="numpy")
def _set_speed(speed: Floats, tangent: Floats, sign: float) -> None:
    length = np.sqrt(speed[0] ** 2 + speed[1] ** 2 + speed[2] ** 2)
    for axis in range(3):
        speed[axis] = sign * length * tangent[axis]
