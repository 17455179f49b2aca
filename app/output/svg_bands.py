"""Tubes as bands: the centre curves on the sheet with their widths, in short pieces."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from app.arrays import Floats, Indices
from app.hyperedges.routing import Routing
from app.output.svg_projection import Projection
from app.output.svg_strips import CIRCLE, Course, cover

TOLERANCE = 0.06
"""Pixels between a curve and its chords."""

LARGEST_TURN = 0.26
"""Radians between the pictures of a curve at neighbouring samples; less where tubes are thick."""

MOST = 96
"""Pieces of a segment."""

ROUND = 0.4
"""Radians: a tube whose picture turns more from sample to sample comes towards us: balls there."""


@dataclass(frozen=True, slots=True, eq=False)
class Bands:
    """All curves as samples, and pieces between neighbouring samples of one segment.

    Of ``course``, ``centers`` (n, 3) are x, y and nearness; ``widths`` (n,) are the tube's radius
    in pixels, ``sides`` (n, 2) unit vectors across it; ``balls`` (n,) says where the tube is drawn
    as balls. Piece p lies between samples ``firsts[p]`` and the next, and belongs to segment
    ``segments[p]`` of hyperedge ``hyperedges[p]``, whose pieces are ``starts[k]`` to
    ``starts[k + 1]``. ``radii`` (n,), document units.
    """

    course: Course
    hyperedges: Indices
    starts: Indices
    segments: Indices
    radii: Floats

    @property
    def centers(self) -> Floats:
        """Where samples are, (n, 3)."""
        return self.course.centers

    @property
    def widths(self) -> Floats:
        """Radii (n,) in pixels."""
        return self.course.widths

    @property
    def sides(self) -> Floats:
        """Unit vectors (n, 2) across the band."""
        return self.course.sides

    @property
    def firsts(self) -> Indices:
        """The first sample of each piece, (p,)."""
        return self.course.firsts

    @staticmethod
    def of(routing: Routing, view: Projection, lifts: Floats) -> Bands:
        """Those of a routing; ``lifts`` (h,) bring hyperedges nearer, in document units."""
        control = routing.control_points
        hyperedge = np.repeat(np.arange(len(routing.radii)), np.diff(routing.segment_starts))
        widths = _widths(routing, hyperedge, view)
        pieces = _pieces(control, widths, view)
        counts = pieces + 1
        ends = np.cumsum(counts)
        segment = np.repeat(np.arange(len(control)), counts)
        number = np.arange(int(ends[-1]) if len(ends) else 0) - np.repeat(ends - counts, counts)
        t = number / pieces[segment]
        places, tangents = _curve(control[segment], t)
        centers = view.seen(places)
        radii = routing.radii[hyperedge[segment]]
        widths = view.sizes(centers[:, 2]) * radii
        lifted = lifts[hyperedge[segment]]
        centers[:, 2] = view.nearer(centers[:, 2], lifted)
        along = view.seen(places + tangents * (1e-3 * radii[:, None]))[:, :2]
        along -= view.seen(places - tangents * (1e-3 * radii[:, None]))[:, :2]
        sides = _sides(along, centers[:, :2], segment)
        is_piece = segment[1:] == segment[:-1]
        firsts = np.flatnonzero(is_piece)
        owners = hyperedge[segment[firsts]]
        starts = np.searchsorted(owners, np.arange(len(routing.radii) + 1))
        of_attachments = routing.attachment_counts[hyperedge]
        begin = (ends - counts)[routing.segment_ends[:, 0] < of_attachments]
        end = ends[routing.segment_ends[:, 1] < of_attachments] - 1
        samples = np.concatenate([begin, end])
        feet = np.full((2, len(firsts)), -1)
        feet[0, np.searchsorted(firsts, begin)] = np.arange(len(begin))
        feet[1, np.searchsorted(firsts, end - 1)] = len(begin) + np.arange(len(end))
        course = Course(
            centers=centers,
            widths=widths,
            sides=sides,
            balls=_balls(sides, segment),
            firsts=firsts,
            feet=feet,
            foot_samples=samples,
            rims=_rims(samples, places, tangents, radii, view),
        )
        return Bands(course, owners, starts, segment[firsts], radii)

    def triangles(self, wider: float, rise: float, view: Projection) -> Floats:
        """Triangles (4 p, 3, 3) of all pieces, like a roof: its ridge is ``rise`` radii nearer.

        ``wider`` is how wide they are, in radii.
        """
        offset = self.sides * (self.widths * wider)[:, None]
        left, right, ridge = (self.centers.copy() for _ in range(3))
        left[:, :2] += offset
        right[:, :2] -= offset
        ridge[:, 2] = view.nearer(ridge[:, 2], rise * self.radii)
        i, j = self.firsts, self.firsts + 1
        corners = [
            (left[i], ridge[i], ridge[j]),
            (left[i], ridge[j], left[j]),
            (ridge[i], right[i], right[j]),
            (ridge[i], right[j], ridge[j]),
        ]
        return np.stack([np.stack(corner, axis=1) for corner in corners], axis=1).reshape(-1, 3, 3)

    def shapes(
        self, pieces: Indices, wider: float, inset: float = 0.0, *, feet: bool = True
    ) -> list[Floats]:
        """Contours (k, 2), counter-clockwise by their numbers, that cover ``pieces``.

        They are ``wider`` radii wide, less ``inset`` pixels, with round ends where there are
        ``feet``.
        """
        return cover(self.course, pieces, wider, inset, feet=feet)


def _widths(routing: Routing, hyperedge: Indices, view: Projection) -> Floats:
    """Radii (s,) of segments in pixels, at the nearest of their control points."""
    if len(hyperedge) == 0:
        return np.zeros(0)
    nearest = view.seen(routing.control_points)[..., 2].max(axis=1)
    return view.sizes(nearest) * routing.radii[hyperedge]


def _pieces(control: Floats, widths: Floats, view: Projection) -> Indices:
    """How many pieces each segment (s, 4, 3) is cut into: Wang's formula, and small turns."""
    if len(control) == 0:
        return np.zeros(0, dtype=np.int64)
    seen = view.seen(control)[..., :2]
    second = np.diff(seen, n=2, axis=1)
    bend = np.hypot(second[..., 0], second[..., 1]).max(axis=1)
    legs = np.diff(seen, axis=1)
    angles = np.unwrap(np.arctan2(legs[..., 1], legs[..., 0]), axis=1)
    turn = np.abs(np.diff(angles, axis=1)).sum(axis=1)
    # A side of the band is off its chord by width · turn² / 8.
    largest = np.minimum(np.sqrt(8 * TOLERANCE / np.maximum(widths, 1e-9)), LARGEST_TURN)
    pieces = np.maximum(np.sqrt(0.75 * bend / TOLERANCE), 1.3 * turn / largest)
    found: Indices = np.clip(np.ceil(pieces), 1, MOST).astype(np.int64)
    return found


def _curve(control: Floats, t: Floats) -> tuple[Floats, Floats]:
    """Places and unit tangents (n, 3) at parameters (n,) of curves (n, 4, 3)."""
    t, s = t[:, None], 1 - t[:, None]
    p0, p1, p2, p3 = control.transpose(1, 0, 2)
    places = s**3 * p0 + 3 * s * s * t * p1 + 3 * s * t * t * p2 + t**3 * p3
    tangents = s * s * (p1 - p0) + 2 * s * t * (p2 - p1) + t * t * (p3 - p2)
    lengths = np.linalg.norm(tangents, axis=1, keepdims=True)
    chords = p3 - p0
    tangents = np.where(lengths > 1e-12, tangents, chords)
    lengths = np.maximum(np.linalg.norm(tangents, axis=1, keepdims=True), 1e-12)
    return places, tangents / lengths


def _rims(
    samples: Indices, places: Floats, tangents: Floats, radii: Floats, view: Projection
) -> Floats:
    """Round ends (f, 20, 2) of tubes around their middles, in pixels."""
    ahead = tangents[samples]
    other = np.where(np.abs(ahead[:, 2:]) < 0.9, [[0.0, 0.0, 1.0]], [[1.0, 0.0, 0.0]])
    across = np.cross(ahead, other)
    across *= (radii[samples] / np.linalg.norm(across, axis=1))[:, None]
    up = np.cross(ahead, across)
    rims = across[:, None] * CIRCLE[:, :1] + up[:, None] * CIRCLE[:, 1:]
    seen = view.seen(places[samples, None] + rims)[..., :2]
    return _turned(seen - view.seen(places[samples])[:, None, :2])


def _sides(along: Floats, at: Floats, segment: Indices) -> Floats:
    """Unit vectors (n, 2) across a curve in the picture; where it points at us, by its chord."""
    lengths = np.hypot(along[:, 0], along[:, 1])
    weak = lengths < 1e-9
    if weak.any():
        last = len(at) - 1
        before, after = (
            np.maximum(np.arange(len(at)) - 1, 0),
            np.minimum(np.arange(len(at)) + 1, last),
        )
        before = np.where(segment[before] == segment, before, np.arange(len(at)))
        after = np.where(segment[after] == segment, after, np.arange(len(at)))
        along = np.where(weak[:, None], at[after] - at[before] + np.array([1e-9, 0.0]), along)
        lengths = np.hypot(along[:, 0], along[:, 1])
    return np.column_stack([along[:, 1], -along[:, 0]]) / lengths[:, None]


def _balls(sides: Floats, segment: Indices) -> NDArray[np.bool_]:
    """Where (n,) the picture of a curve turns so fast that the tube must come towards us."""
    found = np.zeros(len(sides), dtype=np.bool_)
    if len(sides) > 1:
        cosines = np.einsum("ni,ni->n", sides[1:], sides[:-1])
        sharp = (cosines < np.cos(ROUND)) & (segment[1:] == segment[:-1])
        found[1:] |= sharp
        found[:-1] |= sharp
    return found


def _turned(rings: Floats) -> Floats:
    """Convex contours (m, k, 2), all turning the same way."""
    a, b = rings[:, 5] - rings[:, 0], rings[:, 10] - rings[:, 0]
    area = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
    return np.where(area[:, None, None] < 0, rings[:, ::-1], rings)
