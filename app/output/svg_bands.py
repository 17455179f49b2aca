"""Tubes as bands: where they are in the picture, and where they pass behind something."""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np

from app.arrays import Flags, Floats, Indices
from app.hyperedges.routing import Routing
from app.output.projection import Projection

STEP = 4.0
"""Pixels from one place on a curve to the next."""

MOST_STEPS = 80
"""Of one segment."""

SHALLOW = 0.35
"""Sine of the flattest crossing for which gaps still grow."""

APART = 2.5
"""Radii between two tubes of one hyperedge from which on they cross, and do not meet."""


@dataclass(frozen=True, slots=True, eq=False)
class Lines:
    """Centre lines of all s segments, one after another.

    ``places`` (p, 3) are pixels and distance from the camera, ``halves`` (p,) half the band's
    width in pixels, ``radii`` (p,) the tube's radius. Those of segment k are ``starts[k]`` to
    ``starts[k + 1]``; ``hyperedges`` (s,) say whose it is.
    """

    places: Floats
    halves: Floats
    radii: Floats
    starts: Indices
    hyperedges: Indices

    @staticmethod
    def of(routing: Routing, projection: Projection) -> Lines:
        """The segments of a routing as the camera sees them."""
        curves = routing.control_points
        hyperedges = np.repeat(np.arange(len(routing.radii)), np.diff(routing.segment_starts))
        seen = projection(curves)[..., :2]
        lengths = np.linalg.norm(np.diff(seen, axis=1), axis=2).sum(axis=1)
        counts = np.clip(np.ceil(lengths / STEP), 4, MOST_STEPS).astype(np.int64) + 1
        starts = np.concatenate([[0], np.cumsum(counts)])
        segment = np.repeat(np.arange(len(curves)), counts)
        t = (np.arange(starts[-1]) - starts[segment]) / (counts[segment] - 1)
        weights = np.stack([(1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t * t * (1 - t), t**3], axis=1)
        places = projection((weights[:, :, None] * curves[segment]).sum(axis=1))
        radii = routing.radii[hyperedges[segment]]
        return Lines(places, radii * projection.scales(places[:, 2]), radii, starts, hyperedges)

    @property
    def segments(self) -> Indices:
        """Of which segment each place is, (p,)."""
        return np.repeat(np.arange(len(self.starts) - 1), np.diff(self.starts))

    def before(self, depths: Floats, slack: float = 0.0) -> Flags:
        """Whether each place (p,) is before the surfaces in a depth buffer (height, width).

        A tube that is less than its radius behind a surface touches it; ``slack`` are more radii,
        for surfaces that may be the tube's own.
        """
        height, width = depths.shape
        column = np.clip(self.places[:, 0].astype(np.int64), 0, width - 1)
        row = np.clip(self.places[:, 1].astype(np.int64), 0, height - 1)
        inside = (self.places[:, :2] >= 0).all(axis=1)
        inside &= (self.places[:, 0] < width) & (self.places[:, 1] < height)
        nearest = np.where(inside, depths[row, column], np.inf)
        return np.asarray(self.places[:, 2] - (1.0 + slack) * self.radii <= nearest)

    def under(self, halo: float) -> Flags:
        """Whether each place (p,) is within the gap where the band passes under another.

        The gap is wider than the band above by ``halo`` radii of that on either side.
        """
        first = np.flatnonzero(np.diff(self.segments) == 0)
        start, end = self.places[first], self.places[first + 1]
        one, other, t, u = _crossings(start[:, :2], end[:, :2])
        depth = start[:, 2]
        slope = end[:, 2] - start[:, 2]
        above = depth[one] + t * slope[one] < depth[other] + u * slope[other]
        near, far = np.where(above, one, other), np.where(above, other, one)
        s = np.where(above, u, t)
        at_near = np.where(above, depth[one] + t * slope[one], depth[other] + u * slope[other])
        at_far = np.where(above, depth[other] + u * slope[other], depth[one] + t * slope[one])
        owner = self.hyperedges[self.segments]
        thick = np.maximum(self.radii[first[near]], self.radii[first[far]])
        counts = (owner[first[near]] != owner[first[far]]) | (at_far - at_near > APART * thick)
        gaps = np.zeros(len(self.places), dtype=bool)
        for i, j, share in zip(near[counts], far[counts], s[counts], strict=True):
            self._cut(gaps, first[i], first[j], float(share), halo)
        return gaps

    def _cut(self, gaps: Flags, near: int, far: int, share: float, halo: float) -> None:
        """Mark the places of the band at ``far`` that are too near to the one at ``near``."""
        along = self.places[far + 1, :2] - self.places[far, :2]
        across = self.places[near + 1, :2] - self.places[near, :2]
        lengths = np.linalg.norm(along) * np.linalg.norm(across)
        sine = abs(float(along[0] * across[1] - along[1] * across[0])) / max(float(lengths), 1e-12)
        reach = self.halves[near] * (1.0 + halo) / max(sine, SHALLOW)
        cosine = np.sqrt(max(1.0 - sine * sine, 0.0))
        reach += self.halves[far] * cosine / max(sine, SHALLOW)
        middle = self.places[far, :2] + share * along
        segment = int(np.searchsorted(self.starts, far, side="right")) - 1
        places = slice(self.starts[segment], self.starts[segment + 1])
        away = np.linalg.norm(self.places[places, :2] - middle, axis=1)
        gaps[places] |= away < reach


def runs(shown: Flags) -> list[tuple[int, int]]:
    """First and last places (inclusive) of all stretches that are shown, of two places or more."""
    edges = np.diff(np.concatenate([[0], np.asarray(shown, dtype=np.int8), [0]]))
    starts, ends = np.flatnonzero(edges == 1), np.flatnonzero(edges == -1) - 1
    return [(a, b) for a, b in zip(starts.tolist(), ends.tolist(), strict=True) if b > a]


def sides(places: Floats, halves: Floats) -> tuple[Floats, Floats]:
    """The two edges (p, 2) of a band along ``places`` (p, 2)."""
    tangents = np.gradient(places, axis=0)
    tangents /= np.maximum(np.linalg.norm(tangents, axis=1, keepdims=True), 1e-9)
    normals = np.stack([-tangents[:, 1], tangents[:, 0]], axis=1) * halves[:, None]
    return places + normals, places - normals


MOST_PAIRS = 4_000_000
"""Looked at together."""


def _crossings(start: Floats, end: Floats) -> tuple[Indices, Indices, Floats, Floats]:
    """Pairs of pieces (n, 2) to (n, 2) that cross, each once, and where on both, 0 to 1."""
    low, high = np.minimum(start, end), np.maximum(start, end)
    order = np.argsort(low[:, 0], kind="stable")
    reach = np.searchsorted(low[order, 0], high[order, 0], side="right")
    counts = np.maximum(reach - np.arange(len(order)) - 1, 0)
    found: list[tuple[Indices, Indices, Floats, Floats]] = []
    edges = [0]
    total = 0
    for number, count in enumerate(counts.tolist()):
        total += count
        if total > MOST_PAIRS:
            edges.append(number)
            total = count
    edges.append(len(counts))
    for a, b in itertools.pairwise(edges):
        part = counts[a:b]
        one = np.repeat(np.arange(a, b), part)
        begins = np.cumsum(part) - part
        other = one + 1 + np.arange(len(one)) - begins[one - a]
        i, j = order[one], order[other]
        near = (low[i, 1] <= high[j, 1]) & (low[j, 1] <= high[i, 1])
        found.append(_crossing(i[near], j[near], start, end))
    one, other, t, u = (np.concatenate(column) for column in zip(*found, strict=True))
    return one, other, t, u


def _crossing(
    i: Indices, j: Indices, start: Floats, end: Floats
) -> tuple[Indices, Indices, Floats, Floats]:
    d, e, w = end[i] - start[i], end[j] - start[j], start[j] - start[i]
    area = d[:, 0] * e[:, 1] - d[:, 1] * e[:, 0]
    safe = np.where(np.abs(area) > 1e-12, area, np.nan)
    t = (w[:, 0] * e[:, 1] - w[:, 1] * e[:, 0]) / safe
    u = (w[:, 0] * d[:, 1] - w[:, 1] * d[:, 0]) / safe
    # Half open, so that a crossing at a place counts once; NaN is never within.
    hit = (t >= 0) & (t < 1) & (u >= 0) & (u < 1)
    return i[hit], j[hit], t[hit], u[hit]
