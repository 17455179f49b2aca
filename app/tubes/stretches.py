"""Where a tube can be one body: stretches of rings along which it does not run into itself.

A swept tube runs into itself where its curve bends more tightly than the tube is thick (there it
is turned inside out), and where the curve comes back to itself. Cut into stretches between such
places, every stretch is a body in the strict sense, and what lies between them can be made of
balls that follow the curve.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numba import njit
from numpy.typing import NDArray

from app.arrays import Floats, Indices
from app.tubes.chains import Rings

# Along less turning than this (radians), a curve that bends no tighter than its tube is thick goes
# on and on: nothing of it lies ahead of any of its ends' planes but what follows.
_ONWARDS = 1.5

# How far apart two places must be, in radii, where the curve has turned by more than that.
_APART = 2.05

# By how much each vertex must be ahead of the ring before, in radii.
_AHEAD = 1e-3


@dataclass(frozen=True, slots=True, eq=False)
class Stretches:
    """Stretches of c chains, in order.

    Those of chain k are ``starts[k]`` to ``starts[k + 1]`` (c + 1,). Stretch i runs from ring
    ``first[i]`` to ring ``last[i]`` of its chain, where the next one begins. Where it is ``open``
    the rings can be swept; elsewhere the hull of balls around its two end rings holds all that the
    tube fills there.
    """

    starts: Indices
    first: Indices
    last: Indices
    open: NDArray[np.bool_]


def stretches_of(rings: Rings, tolerances: Floats) -> Stretches:
    """Cut the rings of c chains into as few stretches as can be told with certainty.

    ``tolerances`` (c,), document units, say by how far a hull may miss the curve.
    """
    most = int(np.sum(rings.counts - 1))
    first, last = np.empty(most, dtype=np.int64), np.empty(most, dtype=np.int64)
    unfolded = np.empty(most, dtype=np.bool_)
    starts = np.zeros(len(rings.counts) + 1, dtype=np.int64)
    found = _cut(
        rings.vertices,
        rings.radials,
        rings.starts,
        rings.sides,
        rings.counts,
        rings.radii,
        tolerances,
        starts,
        first,
        last,
        unfolded,
    )
    return Stretches(starts, first[:found], last[:found], unfolded[:found])


@njit(cache=True, error_model="numpy")
def _cut(
    vertices: Floats,
    radials: Floats,
    ring_starts: Indices,
    sides: Indices,
    counts: Indices,
    radii: Floats,
    tolerances: Floats,
    starts: Indices,
    first: Indices,
    last: Indices,
    unfolded: NDArray[np.bool_],
) -> int:
    """Fill ``starts``, ``first``, ``last`` and ``unfolded``; returns how many stretches there are.

    A track here is rows of centres 0 to 2, unit tangents 3 to 5, and the length 6 and turning 7 up
    to each ring.
    """
    most = 1
    for s in range(len(counts)):
        most = max(most, counts[s])
    track, onwards = np.empty((8, most)), np.empty(most, dtype=np.bool_)
    found = 0
    for s in range(len(counts)):
        n, radius, end = sides[s], radii[s], counts[s] - 1
        _follow(vertices, radials, ring_starts[s], n, counts[s], radius, track)
        for i in range(end):
            onwards[i] = _goes_on(vertices, ring_starts[s] + i * n, n, radius, track, i)
        starts[s] = found
        i = 0
        while i < end:
            j = i + 1
            if onwards[i]:
                while j < end and onwards[j] and _keeps_away(track, i, j + 1, radius):
                    j += 1
            else:
                while j < end and not onwards[j] and _strays(track, i, j + 1) <= tolerances[s]:
                    j += 1
            first[found], last[found], unfolded[found] = i, j, onwards[i]
            found += 1
            i = j
    starts[len(counts)] = found
    return found


@njit(cache=True, error_model="numpy")
def _follow(
    vertices: Floats,
    radials: Floats,
    start: int,
    n: int,
    count: int,
    radius: float,
    track: Floats,
) -> None:
    quarter = n // 4
    for i in range(count):
        a = start + i * n
        b = a + quarter
        for axis in range(3):
            track[axis, i] = vertices[a, axis] - radius * radials[a, axis]
        x = radials[a, 1] * radials[b, 2] - radials[a, 2] * radials[b, 1]
        y = radials[a, 2] * radials[b, 0] - radials[a, 0] * radials[b, 2]
        z = radials[a, 0] * radials[b, 1] - radials[a, 1] * radials[b, 0]
        length = math.sqrt(x * x + y * y + z * z)
        track[3, i], track[4, i], track[5, i] = x / length, y / length, z / length
    track[6, 0], track[7, 0] = 0.0, 0.0
    for i in range(1, count):
        step, along = 0.0, 0.0
        for axis in range(3):
            step += (track[axis, i] - track[axis, i - 1]) ** 2
            along += track[3 + axis, i] * track[3 + axis, i - 1]
        track[6, i] = track[6, i - 1] + math.sqrt(step)
        track[7, i] = track[7, i - 1] + math.acos(min(1.0, max(-1.0, along)))


@njit(cache=True, error_model="numpy")
def _goes_on(vertices: Floats, at: int, n: int, radius: float, track: Floats, i: int) -> bool:
    """Whether ring i + 1 is wholly ahead of ring i, and ring i wholly behind ring i + 1."""
    least = _AHEAD * radius
    for k in range(n):
        here, there = at + k, at + n + k
        ahead, behind = 0.0, 0.0
        for axis in range(3):
            ahead += (vertices[there, axis] - track[axis, i]) * track[3 + axis, i]
            behind += (track[axis, i + 1] - vertices[here, axis]) * track[3 + axis, i + 1]
        if not (ahead > least and behind > least):
            return False
    return True


@njit(cache=True, error_model="numpy")
def _keeps_away(track: Floats, first: int, last: int, radius: float) -> bool:
    """Whether the step to ring ``last`` is far from all since ``first`` that it has turned from."""
    for i in range(first, last - 1):
        if track[7, last - 1] - track[7, i + 1] <= _ONWARDS:
            return True
        if not _apart(track, i, last - 1) > _APART * radius:
            return False
    return True


@njit(cache=True, error_model="numpy")
def _apart(track: Floats, i: int, j: int) -> float:
    """The distance between the steps from rings i and j (Ericson 2005, section 5.1.9)."""
    aa, ab, bb, ac, bc = 0.0, 0.0, 0.0, 0.0, 0.0
    for axis in range(3):
        a, b = track[axis, i + 1] - track[axis, i], track[axis, j + 1] - track[axis, j]
        c = track[axis, i] - track[axis, j]
        aa, ab, bb, ac, bc = aa + a * a, ab + a * b, bb + b * b, ac + a * c, bc + b * c
    area = aa * bb - ab * ab
    s = min(1.0, max(0.0, (ab * bc - ac * bb) / area)) if area > 0.0 else 0.0
    t = (ab * s + bc) / bb
    if t < 0.0:
        t, s = 0.0, min(1.0, max(0.0, -ac / aa))
    elif t > 1.0:
        t, s = 1.0, min(1.0, max(0.0, (ab - ac) / aa))
    square = 0.0
    for axis in range(3):
        a, b = track[axis, i + 1] - track[axis, i], track[axis, j + 1] - track[axis, j]
        square += (track[axis, i] + s * a - track[axis, j] - t * b) ** 2
    return math.sqrt(square)


@njit(cache=True, error_model="numpy")
def _strays(track: Floats, first: int, last: int) -> float:
    """How far the curve may be from the chord between two rings: at most length times turning."""
    length, turning = track[6, last] - track[6, first], track[7, last] - track[7, first]
    return float(0.125 * length * turning)
