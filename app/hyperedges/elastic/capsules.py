"""Capsules around the segments of chains, and how they push each other apart (Numba)."""

from __future__ import annotations

import numpy as np
from numba import njit

from app.arrays import Flags, Floats, Indices

TOUCHING = 1e-5
"""Axes nearer than this, in document units, pass through each other."""

LEAST_SHARE = 0.05
"""Beads that have less to do with the nearest place are not moved for it all the farther."""


@njit(cache=True, error_model="numpy")
def separate(
    x: Floats,
    segments: Indices,
    pairs: Indices,
    rooms: Floats,
    beside: Floats,
    free: Floats,
    size: float,
    sums: Floats,
    weights: Floats,
) -> None:
    """Add what moves ``pairs`` (m, 2) of segments as far apart as both need.

    That is ``size`` times the sum of their ``rooms`` (s,), and how far their curves run ``beside``
    (b,) their beads. Each bead gets its share by how near it is, in ``sums`` (b, 3), and that share
    in ``weights`` (b,).
    """
    for row in range(len(pairs)):
        k, q = pairs[row, 0], pairs[row, 1]
        a, b, c, d = segments[k, 0], segments[k, 1], segments[q, 0], segments[q, 1]
        s, t = nearest(x, a, b, c, d)
        u = x[a, 0] + s * (x[b, 0] - x[a, 0]) - x[c, 0] - t * (x[d, 0] - x[c, 0])
        v = x[a, 1] + s * (x[b, 1] - x[a, 1]) - x[c, 1] - t * (x[d, 1] - x[c, 1])
        w = x[a, 2] + s * (x[b, 2] - x[a, 2]) - x[c, 2] - t * (x[d, 2] - x[c, 2])
        square = u * u + v * v + w * w
        need = (rooms[k] + rooms[q]) * size + max(beside[a], beside[b]) + max(beside[c], beside[d])
        if square >= need * need:
            continue
        distance = np.sqrt(square)
        if distance < TOUCHING:
            # Any way out will do, but always the same one.
            u, v, w = float((k * 7919) % 13 - 6), float((q * 104729) % 11 - 5), 1.3
            distance = np.sqrt(u * u + v * v + w * w)
            push = need / distance
        else:
            push = (need - distance) / distance
        wa, wb, wc, wd = (1.0 - s) * free[a], s * free[b], (1.0 - t) * free[c], t * free[d]
        total = wa * (1.0 - s) + wb * s + wc * (1.0 - t) + wd * t
        if total <= 0.0:
            continue
        push /= max(total, LEAST_SHARE)
        _add(sums, weights, a, wa, push, u, v, w)
        _add(sums, weights, b, wb, push, u, v, w)
        _add(sums, weights, c, wc, -push, u, v, w)
        _add(sums, weights, d, wd, -push, u, v, w)


@njit(cache=True, error_model="numpy")
def within(x: Floats, segments: Indices, pairs: Indices, reach: Floats) -> Flags:
    """Which ``pairs`` (m, 2) of segments are nearer than the sum of their ``reach`` (s,)."""
    found = np.empty(len(pairs), np.bool_)
    for row in range(len(pairs)):
        k, q = pairs[row, 0], pairs[row, 1]
        a, b, c, d = segments[k, 0], segments[k, 1], segments[q, 0], segments[q, 1]
        s, t = nearest(x, a, b, c, d)
        square = 0.0
        for axis in range(3):
            way = x[a, axis] + s * (x[b, axis] - x[a, axis])
            way -= x[c, axis] + t * (x[d, axis] - x[c, axis])
            square += way * way
        found[row] = square < (reach[k] + reach[q]) ** 2
    return found


@njit(cache=True, error_model="numpy", inline="always")
def _add(
    sums: Floats,
    weights: Floats,
    i: int,
    weight: float,
    push: float,
    u: float,
    v: float,
    w: float,
) -> None:
    sums[i, 0] += weight * push * u
    sums[i, 1] += weight * push * v
    sums[i, 2] += weight * push * w
    weights[i] += weight


@njit(cache=True, error_model="numpy", inline="always")
def nearest(x: Floats, a: int, b: int, c: int, d: int) -> tuple[float, float]:
    """Where on the lines from ``x[a]`` to ``x[b]`` and from ``x[c]`` to ``x[d]`` they are nearest.

    As shares of their lengths (Ericson 2005, 5.1.9).
    """
    uu = vv = uv = uw = vw = 0.0
    for axis in range(3):
        u, v, w = x[b, axis] - x[a, axis], x[d, axis] - x[c, axis], x[a, axis] - x[c, axis]
        uu += u * u
        vv += v * v
        uv += u * v
        uw += u * w
        vw += v * w
    uu += 1e-18
    vv += 1e-18
    over = uu * vv - uv * uv
    s = 0.5
    if over > 1e-9 * uu * vv:
        s = min(max((uv * vw - uw * vv) / over, 0.0), 1.0)
    t = (uv * s + vw) / vv
    if t < 0.0:
        t, s = 0.0, min(max(-uw / uu, 0.0), 1.0)
    elif t > 1.0:
        t, s = 1.0, min(max((uv - uw) / uu, 0.0), 1.0)
    return s, t
