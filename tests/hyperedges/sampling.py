"""What dense samples on curves show: an oracle that shares nothing with the certificate.

Samples can only find what is there: a distance between them is never less than the true one, and
at most some 0.002 more where samples are 0.05 apart and tubes thicker than 0.1. Items are taken for
upright blocks.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from app.arrays import Floats, Indices
from app.hyperedges.routing import Routing
from app.placement.placement import Placement

SPACING = 0.05
"""Between samples on one curve, at most."""

ALONG = np.linspace(0.0, 1.0, 257)
"""Where curvature is looked at."""


@dataclass(frozen=True, slots=True, eq=False)
class Samples:
    """``points`` (m, 3) on the curves of hyperedges ``owners`` (m,)."""

    points: Floats
    owners: Indices


def owners(routing: Routing) -> Indices:
    """The hyperedge of each segment, (s,)."""
    return np.repeat(np.arange(len(routing.radii)), np.diff(routing.segment_starts))


def sample(routing: Routing, spacing: float = SPACING) -> Samples:
    """Points on all curves, neighbours at most ``spacing`` apart, ends included."""
    cubics = routing.control_points
    speeds = 3.0 * np.linalg.norm(np.diff(cubics, axis=1), axis=2).max(axis=1, initial=0.0)
    counts = np.ceil(speeds / spacing).astype(np.int64) + 1
    segments = np.repeat(np.arange(len(cubics)), counts)
    places = np.arange(len(segments)) - np.repeat(np.cumsum(counts) - counts, counts)
    t = places / np.maximum(counts - 1, 1)[segments]
    return Samples(bernstein(cubics[segments], t), owners(routing)[segments])


def bernstein(cubics: Floats, t: Floats) -> Floats:
    """The point (m, 3) at ``t`` (m,) of each of ``cubics`` (m, 4, 3)."""
    weights = np.stack([(1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t * t * (1 - t), t**3], axis=-1)
    return np.asarray(np.einsum("mk,mkc->mc", weights, cubics))


def tubes_too_near(samples: Samples, radii: Floats, clearance: float) -> set[tuple[int, int]]:
    """Pairs of hyperedges whose surfaces are seen nearer than ``clearance``."""
    reach = 2.0 * float(radii.max(initial=0.0)) + clearance
    near = cKDTree(samples.points).query_pairs(reach, output_type="ndarray")
    one, other = samples.owners[near.T]
    near, one, other = near[one != other], one[one != other], other[one != other]
    distances = np.linalg.norm(samples.points[near[:, 0]] - samples.points[near[:, 1]], axis=1)
    hit = distances < radii[one] + radii[other] + clearance
    pairs = np.sort(np.column_stack([one[hit], other[hit]]), axis=1)
    return {(int(a), int(b)) for a, b in np.unique(pairs, axis=0)}


def items_too_near(
    samples: Samples, placement: Placement, clearance: float
) -> set[tuple[int, int]]:
    """Hyperedges, and items that they do not attach to and are seen too near to."""
    arities = np.diff(placement.attachment_starts)
    attached = set(
        zip(
            np.repeat(np.arange(len(arities)), arities).tolist(),
            placement.attachment_items.tolist(),
            strict=True,
        )
    )
    tree = cKDTree(samples.points)
    thickest = float(placement.radii.max(initial=0.0)) + clearance
    found: set[tuple[int, int]] = set()
    for item, (center, size) in enumerate(zip(placement.centers, placement.sizes, strict=True)):
        about = tree.query_ball_point(center, float(np.linalg.norm(size)) / 2 + thickest)
        outside = np.maximum(np.abs(samples.points[about] - center) - size / 2, 0.0)
        near = samples.owners[about]
        hit = near[np.linalg.norm(outside, axis=1) < placement.radii[near] + clearance]
        found.update((int(k), item) for k in np.unique(hit) if (int(k), item) not in attached)
    return found


def tightest_bends(routing: Routing) -> Floats:
    """The smallest radius of curvature seen on each segment, (s,)."""
    p = routing.control_points
    tightest = np.full(len(p), np.inf)
    first, second = 3 * np.diff(p, axis=1), 6 * np.diff(p, 2, axis=1)
    for t in ALONG:
        velocity = (1 - t) ** 2 * first[:, 0] + 2 * t * (1 - t) * first[:, 1] + t * t * first[:, 2]
        acceleration = (1 - t) * second[:, 0] + t * second[:, 1]
        turning = np.linalg.norm(np.cross(velocity, acceleration), axis=1)
        cubed = np.linalg.norm(velocity, axis=1) ** 3
        with np.errstate(divide="ignore", invalid="ignore"):
            bend = np.where(turning > 1e-12 * cubed, cubed / turning, np.inf)
        tightest = np.minimum(tightest, bend)
    return tightest


def pinched(routing: Routing, share: float = 1.5) -> Indices:
    """Segments that somewhere bend tighter than ``share`` of their tube's radius."""
    tight = tightest_bends(routing) < share * routing.radii[owners(routing)] * (1 - 1e-6)
    return np.flatnonzero(tight)


def lengths(routing: Routing) -> Floats:
    """The length of each segment, (s,), by Gauss and Legendre's rule in four pieces."""
    places, weights = np.polynomial.legendre.leggauss(8)
    total = np.zeros(len(routing.control_points))
    steps = 3 * np.diff(routing.control_points, axis=1)
    for piece in range(4):
        for place, weight in zip(places, weights, strict=True):
            t = (piece + 0.5 + place / 2) / 4
            velocity = (
                (1 - t) ** 2 * steps[:, 0] + 2 * t * (1 - t) * steps[:, 1] + t * t * steps[:, 2]
            )
            total += weight / 8 * np.linalg.norm(velocity, axis=1)
    return total
