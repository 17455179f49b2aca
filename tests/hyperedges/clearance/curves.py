"""Cubics to measure, and their distance by sampling: never less than the true one."""

from __future__ import annotations

import os
from typing import Literal

import numpy as np
from hypothesis import strategies as st

from app.arrays import Floats

CASES = int(os.environ.get("CERTIFICATE_CASES", "2000"))
"""How many random pairs are tried: ``make test CERTIFICATE_CASES=10000`` tries more."""

EPSILON = float(np.finfo(np.float64).eps)

Relation = Literal["free", "common end", "shifted", "part", "crossing", "mirrored", "line"]
RELATIONS: tuple[Relation, ...] = (
    "free",
    "common end",
    "shifted",
    "part",
    "crossing",
    "mirrored",
    "line",
)


def points_at(curve: Floats, parameters: Floats) -> Floats:
    t = parameters[:, None]
    r = 1 - t
    p, q, s, e = curve
    found: Floats = r**3 * p + 3 * r**2 * t * q + 3 * r * t**2 * s + t**3 * e
    return found


def sampled_distance(first: Floats, second: Floats) -> float:
    """The smallest distance of many points, looked for more closely where it was smallest."""
    best = np.inf
    low, high = np.zeros(2), np.ones(2)
    for _ in range(3):
        u, v = np.linspace(low[0], high[0], 32), np.linspace(low[1], high[1], 32)
        ways = points_at(first, u)[:, None] - points_at(second, v)[None]
        distances = np.sqrt((ways**2).sum(axis=2))
        a, b = np.unravel_index(int(distances.argmin()), distances.shape)
        best = min(best, float(distances[a, b]))
        step = (high - low) / 31
        middle = np.array([u[a], v[b]])
        low, high = np.maximum(middle - 2 * step, 0), np.minimum(middle + 2 * step, 1)
    return best


def noise(*curves: Floats) -> float:
    """What rounding can do to a sampled point."""
    return 32 * EPSILON * max(float(np.abs(curve).max()) for curve in curves)


def first_part(curve: Floats, t: float) -> Floats:
    """The curve from 0 to ``t``, by de Casteljau."""
    points = [curve]
    while len(points[-1]) > 1:
        points.append((1 - t) * points[-1][:-1] + t * points[-1][1:])
    return np.stack([row[0] for row in points])


def related(curve: Floats, other: Floats, relation: Relation) -> Floats:
    """A second curve that makes trouble with the first."""
    found: Floats
    match relation:
        case "free":
            found = other
        case "common end":
            found = other - other[0] + curve[3]
        case "shifted":
            found = curve + 0.1 * other[0]
        case "part":
            found = first_part(curve, 0.7)[::-1]
        case "crossing":
            found = other + (points_at(curve, np.array([0.3])) - points_at(other, np.array([0.6])))
        case "mirrored":
            found = curve * [1.0, 1.0, -1.0]
        case "line":
            way = curve[3] - curve[0]
            found = curve[0] + np.array([0.5, 0.7, 1.2, 1.5])[:, None] * way
    return found


@st.composite
def pairs_of_curves(draw: st.DrawFn) -> tuple[Floats, Floats]:
    """On a coarse lattice, where much coincides, or anywhere; near or far from the origin."""
    chance = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    points = chance.uniform(-6, 6, (2, 4, 3))
    if draw(st.booleans()):
        points = np.round(points / draw(st.sampled_from([1, 3])))
    if draw(st.booleans()):
        points[:, :, 2] = 0.0
    first, second = points[0], related(points[0], points[1], draw(st.sampled_from(RELATIONS)))
    scale = draw(st.sampled_from([1.0, 1e-9, 1e-3, 1e4]))
    shift = draw(st.sampled_from([0.0, 1.0, 1e5]))
    return first * scale + shift, second * scale + shift


def turned(seed: int) -> Floats:
    """A random orthogonal matrix."""
    found: Floats = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))[0]
    return found
