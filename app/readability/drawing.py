"""What of a layout is seen: tubes, bodies of items, and labels."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from app.arrays import Floats, Indices
from app.hyperedges.clearance.obstacles import Obstacles, obstacles_of
from app.hyperedges.routing import Routing
from app.placement.placement import Placement
from app.placement.turning import matrices
from app.readability.lines import Lines, lines_along
from app.solids.solid import Text


class Balls(NamedTuple):
    """``centers`` (b, 3), ``radii`` (b,) and the items (b,) they are of."""

    centers: Floats
    radii: Floats
    items: Indices


class Triangles(NamedTuple):
    """``corners`` (t, 3, 3), and the items (t,) they are of."""

    corners: Floats
    items: Indices


class Labels(NamedTuple):
    """``middles`` (l, 3), ``sizes`` (l, 2): width and height, and the items (l,) they name."""

    middles: Floats
    sizes: Floats
    items: Indices


class Drawing(NamedTuple):
    """Tubes of so many ``hyperedges``, and items and their labels, in document units.

    Items are numbered from 0, and letters hide what is behind them as bodies do.
    """

    lines: Lines
    hyperedges: int
    balls: Balls
    triangles: Triangles
    labels: Labels


def drawing_of(routing: Routing, placement: Placement) -> Drawing:
    """What is seen of a layout.

    Items are what is in the way of hyperedges: balls, and boxes (`Obstacles`).
    """
    owners = np.repeat(np.arange(len(routing.radii)), np.diff(routing.segment_starts))
    lines = lines_along(routing.control_points, owners, routing.radii[owners])
    obstacles = obstacles_of(placement)
    are_balls = (obstacles.halves == 0.0).all(axis=1)
    balls = obstacles.only(np.flatnonzero(are_balls))
    return Drawing(
        lines,
        len(routing.radii),
        Balls(balls.centers, balls.roundings, balls.items),
        faces_of(obstacles.only(np.flatnonzero(~are_balls))),
        labels_of(placement),
    )


def labels_of(placement: Placement) -> Labels:
    """All labels, where they are in the world; items that are letters themselves among them."""
    rows = [number for number, label in enumerate(placement.labels) if label is not None]
    letters = [number for number, solid in enumerate(placement.solids) if isinstance(solid, Text)]
    labels = [label for label in placement.labels if label is not None]
    within = np.array([label.position for label in labels]).reshape(-1, 3)
    turned = np.einsum("kij,kj->ki", matrices(placement.rotations[rows]), within)
    sizes = np.array([label.size[:2] for label in labels]).reshape(-1, 2)
    return Labels(
        np.concatenate([placement.centers[rows] + turned, placement.centers[letters]]),
        np.concatenate([sizes, placement.sizes[letters, :2]]),
        np.array([*rows, *letters], dtype=np.int64),
    )


def faces_of(boxes: Obstacles) -> Triangles:
    """The faces of boxes, two triangles each; roundings make a box larger on all sides."""
    halves = boxes.halves + boxes.roundings[:, None]
    corners = boxes.centers[:, None] + np.einsum(
        "kij,kcj->kci", boxes.rotations, _CORNERS * halves[:, None]
    )
    triangles = corners[:, _FACES].reshape(-1, 3, 3)
    return Triangles(triangles, np.repeat(boxes.items, len(_FACES)))


_CORNERS = np.array([[x, y, z] for x in (-1.0, 1.0) for y in (-1.0, 1.0) for z in (-1.0, 1.0)])
_FACES = np.array(
    [
        triangle
        for a, b, c, d in (
            (0, 1, 3, 2),
            (4, 5, 7, 6),
            (0, 1, 5, 4),
            (2, 3, 7, 6),
            (0, 2, 6, 4),
            (1, 3, 7, 5),
        )
        for triangle in ((a, b, c), (a, c, d))
    ]
)
