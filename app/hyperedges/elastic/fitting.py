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
from app.hyperedges.weaving.curvature import bend_between, least_radius

GENTLE = 2.5
"""Radius of curvature, over the tube's, at which no better handles are looked for."""

TIGHT = 1.65
"""The same below which the last piece before a join becomes one with those before."""


MOST_SEGMENTS = 5
"""So many at most."""


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
        first = _sweep(ends[c, 0] < joins, sweeps[c, 0], True, count, places, units, radii[c])
        last = _sweep(ends[c, 1] < joins, sweeps[c, 1], False, count, places, units, radii[c])
        if first + last > max(count, 2):
            # Both ends want more than there is: one cubic from end to end.
            first = last = count
        begin = 0
        while begin < count:
            end = first if begin == 0 else begin + 1
            if begin > 0 and begin >= count - last:
                end = count
            _set_cubic(places, speeds, begin, end, curves[made])
            if end > begin + 1 or least_radius(curves[made]) < GENTLE * radii[c]:
                bend_between(curves[made], units[begin], units[end], GENTLE * radii[c])
            of[made], spans[made, 0], spans[made, 1] = c, begin, end
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


@njit(cache=True, error_model="numpy")
def _sweep(
    at_join: bool,
    wanted: int,
    at_start: bool,
    count: int,
    places: Floats,
    units: Floats,
    radius: float,
) -> int:
    """Over how many segments the cubic at an end goes: more where one would be too tight."""
    if not at_join or count < 2:
        return 1
    if wanted > 1:
        return min(wanted, count)
    curve = np.empty((4, 3))
    best, widest = 1, 0.0
    for k in range(1, min(MOST_SEGMENTS, count) + 1):
        begin, end = (0, k) if at_start else (count - k, count)
        curve[0], curve[3] = places[begin], places[end]
        radius_there = bend_between(curve, units[begin], units[end], GENTLE * radius)
        if radius_there > widest:
            best, widest = k, radius_there
        if widest >= TIGHT * radius:
            break
    return best
