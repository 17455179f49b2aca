"""Lines drawn along bands and edges: the light on a tube, and what is hidden, dashed."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from app.arrays import Floats, Indices
from app.output.svg_bands import Bands
from app.output.svg_faces import block_edges, corners_of
from app.output.svg_projection import Projection
from app.output.svg_raster import Foremost
from app.output.svg_visible import Grid, Surroundings
from app.placement.placement import Placement
from app.placement.turning import matrices
from app.solids.solid import Box, Tray

FINE = 4
"""Places between two samples of a band at which it is asked whether they are to be seen."""

SHINE = 0.3
"""Radii by which the light line lies to the light at most."""

LIGHT = np.array([-0.5, -0.866])
"""Where light comes from on the sheet, y down."""

DASHED = 2.0
"""Pixels between the places on an edge at which it is asked whether they are hidden."""

BEHIND = 3.0
"""Pixels, turned into depth, by which a face must be before an edge to hide it."""

SHORTEST = 3
"""Places that a run of hidden ones must have."""


def shine(bands: Bands, around: Surroundings, hyperedge: int) -> list[Floats]:
    """Lines (k, 2) along the visible parts of a hyperedge's tubes, on the side of the light."""
    found: list[Floats] = []
    for samples in _segments(bands, hyperedge):
        side = bands.sides[samples]
        shift = side * (SHINE * (side @ LIGHT) * bands.widths[samples])[:, None]
        points, radii = _finely(bands.centers[samples], bands.radii[samples])
        moved, _ = _finely(bands.centers[samples, :2] + shift, bands.radii[samples])
        runs = _runs(~around.hides(points, radii, hyperedge))
        found += [_thinned(moved, begin, end) for begin, end in runs if end - begin > FINE]
    return found


def hidden_sides(bands: Bands, around: Surroundings, hyperedge: int) -> list[Floats]:
    """Lines (k, 2) along both sides of a hyperedge's tubes where they are hidden."""
    found: list[Floats] = []
    for samples in _segments(bands, hyperedge):
        for sign in (-1.0, 1.0):
            edge = bands.centers[samples].copy()
            edge[:, :2] += bands.sides[samples] * (sign * bands.widths[samples])[:, None]
            points, radii = _finely(edge, bands.radii[samples])
            runs = _runs(around.hides(points, radii, hyperedge))
            found += [
                _thinned(points[:, :2], begin, end) for begin, end in runs if end - begin > SHORTEST
            ]
    return found


def hidden_edges(
    number: int, placement: Placement, faces: Foremost, view: Projection, grid: Grid
) -> list[Floats]:
    """Lines (k, 2) along the edges of a block where faces hide them; other bodies have none."""
    solid = placement.solids[number]
    if not isinstance(solid, Box | Tray):
        return []
    corners = corners_of(solid) @ matrices(placement.rotations[number]).T
    ends = view.seen(corners + placement.centers[number])[block_edges(solid)]
    found: list[Floats] = []
    for begin, end in ends:
        count = int(np.hypot(*(end - begin)[:2]) / DASHED) + 2
        points = begin + np.linspace(0.0, 1.0, count)[:, None] * (end - begin)
        room = BEHIND / np.maximum(view.sizes(points[:, 2]), 1e-12)
        before = faces.nearness[grid.places(points[:, :2])]
        runs = _runs(before > view.nearer(points[:, 2], room))
        found += [points[[first, last - 1], :2] for first, last in runs if last - first > SHORTEST]
    return found


def _segments(bands: Bands, hyperedge: int) -> Sequence[Indices]:
    """The samples of each segment of a hyperedge."""
    pieces = np.arange(bands.starts[hyperedge], bands.starts[hyperedge + 1])
    breaks = np.flatnonzero(np.diff(bands.segments[pieces])) + 1
    return [
        np.arange(bands.firsts[part[0]], bands.firsts[part[-1]] + 2)
        for part in np.split(pieces, breaks)
        if len(part)
    ]


def _finely(points: Floats, radii: Floats) -> tuple[Floats, Floats]:
    """`FINE` places for each step from one point (n, d) to the next, and their radii."""
    at = np.arange((len(points) - 1) * FINE + 1) / FINE
    whole = np.minimum(at.astype(np.int64), len(points) - 2)
    share = (at - whole)[:, None]
    return points[whole] * (1 - share) + points[whole + 1] * share, radii[whole]


def _thinned(points: Floats, begin: int, end: int) -> Floats:
    """A run of fine places, by the samples among them and its ends."""
    inner = [place for place in range(begin + 1, end - 1) if place % FINE == 0]
    return np.asarray(points[[begin, *inner, end - 1], :2])


def _runs(flags: NDArray[np.bool_]) -> list[tuple[int, int]]:
    """From where to where, the last not included, ``flags`` (n,) are true."""
    changes = np.flatnonzero(np.diff(flags.astype(np.int8), prepend=0, append=0))
    return list(zip(changes[::2].tolist(), changes[1::2].tolist(), strict=True))
