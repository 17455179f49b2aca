"""Curves as polylines that no eye could tell from them."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from app.arrays import Floats, Indices
from app.grouped import starts_of

FLATNESS = 0.05
"""How far a polyline may be from its curve, over the tube's radius."""

MOST_PIECES = 256
"""Pieces of one curve."""


class Lines(NamedTuple):
    """The s straight pieces of all polylines, those of a curve one after another.

    ``begins`` and ``ends`` (s, 3), document units; ``owners`` (s,) the hyperedges; ``radii`` (s,)
    of the tubes.
    """

    begins: Floats
    ends: Floats
    owners: Indices
    radii: Floats


def lines_along(control_points: Floats, owners: Indices, radii: Floats) -> Lines:
    """Polylines along cubics (n, 4, 3) of tubes of ``radii`` (n,), which are of ``owners`` (n,).

    A chord between two points of a curve, h apart in its parameter, is no farther from it than
    h² / 8 times the largest second derivative, and that is at a cubic's end.

    >>> straight = np.array([[[0.0, 0, 0], [1, 0, 0], [2, 0, 0], [3, 0, 0]]])
    >>> lines_along(straight, np.array([7]), np.array([0.1])).ends.tolist()
    [[3.0, 0.0, 0.0]]
    """
    bends = 6.0 * np.linalg.norm(np.diff(control_points, 2, axis=1), axis=2).max(axis=1, initial=0)
    wanted = np.ceil(np.sqrt(bends / (8.0 * FLATNESS * radii)))
    counts = np.clip(wanted, 1, MOST_PIECES).astype(np.int64)
    of = np.repeat(np.arange(len(counts)), counts)
    step = np.arange(len(of)) - starts_of(counts)[of]
    cubics = control_points[of]
    # A curve's last point is said by its own numbers, as that of the next curve is.
    begins = points_at(cubics, step / counts[of])
    ends = points_at(cubics, (step + 1) / counts[of])
    return Lines(begins, ends, owners[of], radii[of])


def points_at(cubics: Floats, t: Floats) -> Floats:
    """The point (m, 3) at ``t`` (m,) of each of ``cubics`` (m, 4, 3)."""
    rest = 1.0 - t
    weights = np.stack([rest**3, 3 * rest**2 * t, 3 * rest * t**2, t**3], axis=1)
    return np.asarray(np.einsum("mk,mkc->mc", weights, cubics))
