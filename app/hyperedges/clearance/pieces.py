"""Segments cut into pieces, none of which comes near itself."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from app.arrays import Floats, Indices

TURN = math.pi
"""Of the radius: so far apart along the tree are the ends of a half turn as tight as a tube allows,
whose surfaces touch. What is nearer is not measured, or every bend would count."""


class Pieces(NamedTuple):
    """Segments in p pieces; those of segment s are ``starts[s]`` to ``starts[s + 1]``, in order.

    ``curves`` (p, 4, 3), their ``segments`` (p,) and the ``lengths`` (p,) of their chords.
    """

    curves: Floats
    segments: Indices
    lengths: Floats
    starts: Indices


def cut(control_points: Floats, radii: Floats) -> Pieces:
    """Pieces of segments (s, 4, 3) of ``radii`` (s,).

    One that is no longer than half a turn as tight as its tube stays whole, one no longer than two
    such is halved, any other is quartered.
    """
    limits = TURN * radii
    lengths = np.linalg.norm(np.diff(control_points, axis=1), axis=2).sum(axis=1)
    counts = 1 + (lengths > limits) + 2 * (lengths > 2 * limits)
    starts = np.concatenate([[0], np.cumsum(counts)])
    segments = np.repeat(np.arange(len(counts)), counts)
    curves = np.empty((len(segments), 4, 3))
    for count, cuts in _CUTS.items():
        chosen = np.flatnonzero(counts == count)
        places = starts[chosen][:, None] + np.arange(count)
        curves[places] = cuts @ control_points[chosen][:, None]
    chords = np.linalg.norm(curves[:, 3] - curves[:, 0], axis=1)
    return Pieces(curves, segments, chords, starts)


# De Casteljau's scheme is linear: rows are the control points of the halves, and of their halves.
_FIRST = np.array([[8, 0, 0, 0], [4, 4, 0, 0], [2, 4, 2, 0], [1, 3, 3, 1]]) / 8
_HALVES = np.stack([_FIRST, _FIRST[::-1, ::-1]])
_CUTS = {
    1: np.eye(4)[None],
    2: _HALVES,
    4: np.einsum("aij,bjk->baik", _HALVES, _HALVES).reshape(4, 4, 4),
}
