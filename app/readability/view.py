"""How readable a drawing is from where it is seen."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from app.arrays import Floats
from app.readability.crossings import count_crossings
from app.readability.drawing import Drawing
from app.readability.hiding import covered_shares, hidden_shares
from app.readability.picture import Picture, empty_picture, paint_capsules, paint_triangles
from app.readability.projection import Projection, Seen

ACUTE = np.radians(20.0)
"""Crossings below this angle are hard to follow."""

FREE = 0.2
"""Labels of which less is covered can be read."""

BEFORE = 0.05
"""How much nearer than a label's middle, in document units, what covers it must be."""

LONGEST = 1200
"""Pixels of the longer side of the picture in which hiding is measured."""


@dataclass(frozen=True, slots=True, eq=False)
class Readability:
    """What a reader sees.

    ``crossings`` of different hyperedges' middle lines, of which ``acute`` below `ACUTE`;
    ``hidden`` (h,): the share of each hyperedge that is behind others or items; ``covered`` (l,):
    that of each label.
    """

    crossings: int
    acute: int
    hidden: Floats
    covered: Floats

    @property
    def mean_hidden(self) -> float:
        """Mean hidden share of hyperedges; 0 where there are none."""
        return float(self.hidden.mean()) if len(self.hidden) else 0.0

    @property
    def free_labels(self) -> float:
        """Share of labels that can be read; 1 where there are none."""
        return float((self.covered < FREE).mean()) if len(self.covered) else 1.0


def readability(drawing: Drawing, projection: Projection, longest: int = LONGEST) -> Readability:
    """What a reader sees of a drawing.

    Hiding is measured in a picture whose longer side has ``longest`` pixels. Raises `ValueError`
    where something is not before the eye.
    """
    crossings, acute = crossings_seen(drawing, projection)
    picture = paint(drawing, projection, longest)
    lines, labels = drawing.lines, drawing.labels
    hidden = hidden_shares(
        picture,
        projection.seen(lines.begins),
        projection.seen(lines.ends),
        np.linalg.norm(lines.ends - lines.begins, axis=1),
        lines.owners,
        drawing.hyperedges,
    )
    covered = covered_shares(
        picture,
        projection.seen(labels.middles),
        labels.sizes,
        projection.seen(labels.middles, BEFORE).nearness,
        drawing.hyperedges + labels.items,
    )
    return Readability(crossings, acute, hidden, covered)


def crossings_seen(drawing: Drawing, projection: Projection) -> tuple[int, int]:
    """Apparent crossings, and those below `ACUTE`."""
    lines = drawing.lines
    begins, ends = projection.seen(lines.begins).places, projection.seen(lines.ends).places
    return count_crossings(begins, ends, lines.owners, float(ACUTE))


def fewest_crossings(drawing: Drawing, projections: Sequence[Projection]) -> int:
    """The number of the projection with the fewest crossings; the first of several.

    Those below `ACUTE` decide where there are as many. There must be a projection.
    """
    found = [crossings_seen(drawing, projection) for projection in projections]
    return found.index(min(found))


def paint(drawing: Drawing, projection: Projection, longest: int = LONGEST) -> Picture:
    """The picture of all there is: hyperedges by their numbers, items numbered after them."""
    lines, balls, triangles = drawing.lines, drawing.balls, drawing.triangles
    begins, ends = projection.seen(lines.begins), projection.seen(lines.ends)
    middles = projection.seen(balls.centers)
    corners = projection.seen(triangles.corners.reshape(-1, 3))
    labels = projection.seen(drawing.labels.middles)
    every = np.concatenate(
        [
            *_bounds(begins, lines.radii[:, None]),
            *_bounds(ends, lines.radii[:, None]),
            *_bounds(middles, balls.radii[:, None]),
            *_bounds(labels, 0.5 * drawing.labels.sizes),
            corners.places,
        ]
    )
    if len(every) == 0:
        every = np.zeros((1, 2))
    picture = empty_picture(every.min(axis=0), every.max(axis=0), longest)
    first = drawing.hyperedges
    paint_triangles(picture, corners, first + triangles.items)
    fronts = projection.seen(balls.centers, balls.radii).nearness
    paint_capsules(picture, middles, middles, (fronts, fronts), balls.radii, first + balls.items)
    fronts, others = (
        projection.seen(points, lines.radii).nearness for points in (lines.begins, lines.ends)
    )
    paint_capsules(picture, begins, ends, (fronts, others), lines.radii, lines.owners)
    return picture


def _bounds(seen: Seen, reach: Floats) -> tuple[Floats, Floats]:
    """Corners (n, 2) of what reaches so far about what is seen, (n, 1) or (n, 2)."""
    far = reach * seen.scales[:, None]
    return seen.places - far, seen.places + far
