"""Where along a segment its rings stand: close together in bends, far apart where it is straight.

Between two rings a tube is straight. Over a length L in which the curve turns by an angle a, the
outer side of the bend is then off by (L + r a) a / 8, so an error of e needs
sqrt((L + r a) a / 8 e) steps. That sum, the load, is made over short intervals, and the rings are
spread evenly over it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numba import njit

from app.arrays import Floats, Indices
from app.tubes.ends import Ends

# How finely a curve's turning is looked at, and how much more finely in an interval in which it
# turns by more than half a radian (here as 1 - cos).
_INTERVALS = 16
_FINER = 8
_SHARP = 0.125

# A chord off by this share of the curve's length is as good as the curve. It bounds the rings.
_FINEST = 1e-6


@dataclass(frozen=True, slots=True, eq=False)
class RingPlan:
    """How many rings s segments need, and what is needed to place them.

    ``counts`` (s,), at least the two ends. ``loads`` (s, 17) are the steps needed from a segment's
    start up to each sixteenth of its parameter; bit k of ``sharp`` (s,) is set where the curve
    turns so sharply in interval k that these are not enough.
    """

    counts: Indices
    loads: Floats
    sharp: Indices


def plan_rings(
    control_points: Floats, hyperedges: Indices, ends: Ends, radii: Floats, tolerances: Floats
) -> RingPlan:
    """Plan the rings of s segments.

    ``radii`` and ``tolerances`` (h,) are those of the hyperedges, ``hyperedges`` (s,) says which
    segment is of which.
    """
    count = len(control_points)
    plan = RingPlan(
        counts=np.empty(count, dtype=np.int64),
        loads=np.empty((count, _INTERVALS + 1)),
        sharp=np.empty(count, dtype=np.int64),
    )
    _plan(
        control_points,
        hyperedges,
        ends.tangents,
        ends.tiny,
        radii,
        tolerances,
        plan.counts,
        plan.loads,
        plan.sharp,
    )
    return plan


@njit(cache=True, error_model="numpy")
def _plan(
    control_points: Floats,
    hyperedges: Indices,
    tangents: Floats,
    tiny: Floats,
    radii: Floats,
    tolerances: Floats,
    counts: Indices,
    loads: Floats,
    sharp: Indices,
) -> None:
    slopes, samples = np.empty(9), np.empty((5, _INTERVALS + 1))
    finer = np.empty(_FINER + 1)
    for s in range(len(control_points)):
        radius, tolerance = radii[hyperedges[s]], tolerances[hyperedges[s]]
        length = hodograph(control_points, s, slopes)
        _sample(slopes, tangents, s, tiny[s], samples)
        share = 0.125 / max(tolerance, _FINEST * length, 1e-300)
        _load(samples, radius, share, loads, s)
        sharp[s] = 0
        total = 0.0
        for k in range(_INTERVALS):
            load = loads[s, k]
            if samples[4, k] > _SHARP:
                sharp[s] |= 1 << k
                load = _look_closer(slopes, tangents, s, tiny[s], radius, share, k, finer)
            loads[s, k] = total
            total += load
        loads[s, _INTERVALS] = total
        counts[s] = 1 + max(1, math.ceil(total - 1e-9))


@njit(cache=True, error_model="numpy")
def hodograph(control_points: Floats, s: int, slopes: Floats) -> float:
    """Fill ``slopes`` (9,) with a curve's derivative: x, y, z of its terms in 1, t and t².

    Returns the length of the control polygon; no curve is longer.
    """
    first, second, third = 0.0, 0.0, 0.0
    for axis in range(3):
        a = control_points[s, 1, axis] - control_points[s, 0, axis]
        b = control_points[s, 2, axis] - control_points[s, 1, axis]
        c = control_points[s, 3, axis] - control_points[s, 2, axis]
        slopes[axis], slopes[3 + axis] = 3.0 * a, 6.0 * (b - a)
        slopes[6 + axis] = 3.0 * ((c - b) - (b - a))
        first, second, third = first + a * a, second + b * b, third + c * c
    return math.sqrt(first) + math.sqrt(second) + math.sqrt(third)


@njit(cache=True, error_model="numpy")
def _sample(slopes: Floats, tangents: Floats, s: int, tiny: float, samples: Floats) -> None:
    """Unit tangents and speeds at the ends of all intervals, into rows 0 to 3 of ``samples``."""
    a, b, c = slopes[0], slopes[3], slopes[6]
    d, e, f = slopes[1], slopes[4], slopes[7]
    g, h, k = slopes[2], slopes[5], slopes[8]
    for i in range(_INTERVALS + 1):
        t = i * (1.0 / _INTERVALS)
        x, y, z = a + t * (b + t * c), d + t * (e + t * f), g + t * (h + t * k)
        speed = math.sqrt(x * x + y * y + z * z)
        inverse = 1.0 / speed
        samples[0, i], samples[1, i], samples[2, i] = x * inverse, y * inverse, z * inverse
        samples[3, i] = speed
    for axis in range(3):
        samples[axis, 0], samples[axis, _INTERVALS] = tangents[s, 0, axis], tangents[s, 1, axis]
    for i in range(1, _INTERVALS):
        if not samples[3, i] * samples[3, i] > tiny:
            for axis in range(3):
                samples[axis, i] = samples[axis, i - 1]


@njit(cache=True, error_model="numpy")
def _load(samples: Floats, radius: float, share: float, loads: Floats, s: int) -> None:
    """Steps needed in each interval, into ``loads[s]``; 1 - cos of its turn into row 4."""
    for i in range(_INTERVALS):
        x, y = samples[0, i + 1] - samples[0, i], samples[1, i + 1] - samples[1, i]
        z = samples[2, i + 1] - samples[2, i]
        bend = 0.5 * (x * x + y * y + z * z)
        way = (0.5 / _INTERVALS) * (samples[3, i] + samples[3, i + 1])
        turn = _angle(bend)
        samples[4, i] = bend
        loads[s, i] = math.sqrt(share * turn * (way + radius * turn))


@njit(cache=True, error_model="numpy")
def _angle(bend: float) -> float:
    """The angle whose 1 - cos is ``bend``, by the series of its square; a little less if large."""
    return math.sqrt(bend * (2.0 + bend * (1.0 / 3.0 + bend * (4.0 / 45.0))))


@njit(cache=True, error_model="numpy")
def _look_closer(
    slopes: Floats,
    tangents: Floats,
    s: int,
    tiny: float,
    radius: float,
    share: float,
    interval: int,
    finer: Floats,
) -> float:
    """Steps needed in one interval; ``finer`` (9,) is filled with those up to each eighth of it."""
    start = interval / _INTERVALS
    x, y, z = tangents[s, 0, 0], tangents[s, 0, 1], tangents[s, 0, 2]
    ex, ey, ez, speed = direction(slopes, start, tiny, x, y, z)
    if interval > 0:
        x, y, z = ex, ey, ez
    finer[0] = 0.0
    for i in range(_FINER):
        t = start + (i + 1) / (_INTERVALS * _FINER)
        ex, ey, ez, fast = direction(slopes, t, tiny, x, y, z)
        if interval == _INTERVALS - 1 and i == _FINER - 1:
            ex, ey, ez = tangents[s, 1, 0], tangents[s, 1, 1], tangents[s, 1, 2]
        turn = _angle(0.5 * ((ex - x) ** 2 + (ey - y) ** 2 + (ez - z) ** 2))
        way = (0.5 / (_INTERVALS * _FINER)) * (speed + fast)
        finer[i + 1] = finer[i] + math.sqrt(share * turn * (way + radius * turn))
        x, y, z, speed = ex, ey, ez, fast
    return float(finer[_FINER])


@njit(cache=True, error_model="numpy")
def direction(
    slopes: Floats, t: float, tiny: float, before_x: float, before_y: float, before_z: float
) -> tuple[float, float, float, float]:
    """The unit tangent and the speed at ``t``; at a cusp the tangent before it stays."""
    x = slopes[0] + t * (slopes[3] + t * slopes[6])
    y = slopes[1] + t * (slopes[4] + t * slopes[7])
    z = slopes[2] + t * (slopes[5] + t * slopes[8])
    square = x * x + y * y + z * z
    speed = math.sqrt(square)
    if not square > tiny:
        return before_x, before_y, before_z, speed
    inverse = 1.0 / speed
    return x * inverse, y * inverse, z * inverse, speed


@njit(cache=True, error_model="numpy")
def place_rings(
    loads: Floats,
    sharp: Indices,
    slopes: Floats,
    tangents: Floats,
    s: int,
    tiny: float,
    radius: float,
    count: int,
    finer: Floats,
    parameters: Floats,
) -> None:
    """Fill ``parameters`` with where the ``count`` rings of segment ``s`` stand, from 0 to 1.

    Overwrites ``finer`` (9,).
    """
    share = loads[s, _INTERVALS] / (count - 1)
    parameters[0] = 0.0
    i, load = 1, share
    for interval in range(_INTERVALS):
        start, stop = loads[s, interval], loads[s, interval + 1]
        if not load <= stop:
            continue
        inverse = 1.0 / (stop - start)
        closer = sharp[s] >> interval & 1
        if closer:
            _look_closer(slopes, tangents, s, tiny, radius, 1.0, interval, finer)
        while load <= stop and i < count - 1:
            inside = (load - start) * inverse
            if closer:
                inside = _invert(finer, inside)
            parameters[i] = (interval + inside) * (1.0 / _INTERVALS)
            i += 1
            load = i * share
    while i < count:
        parameters[i] = 1.0
        i += 1


@njit(cache=True, error_model="numpy")
def _invert(finer: Floats, share: float) -> float:
    """Where in an interval a share of its steps is reached."""
    load = share * finer[_FINER]
    part = 0
    while part < _FINER - 1 and finer[part + 1] < load:
        part += 1
    gap = finer[part + 1] - finer[part]
    inside = min((load - finer[part]) / gap, 1.0) if gap > 0.0 else 1.0
    return (part + inside) / _FINER
