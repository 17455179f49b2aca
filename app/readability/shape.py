"""What curves are like wherever they are seen from: how long, how winding, how upright."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from app.arrays import Floats
from app.hyperedges.routing import Routing
from app.hyperedges.steiner.trees import short_trees
from app.placement.placement import Placement

UPRIGHT = np.radians(5.0)
"""How far from vertical a pipe may be."""

STRAIGHT = 0.01
"""Largest curvature of a pipe, over one by the tube's radius."""

STEPS = 64
"""Tangents along a curve between which turning is summed up."""


@dataclass(frozen=True, slots=True, eq=False)
class Shapes:
    """Figures of h hyperedges, (h,) each.

    ``lengths`` of their curves, and ``shortest``, those of short trees between their attachments,
    in document units; ``turning``, the sum of all angles by which their curves turn, radians;
    ``upright``, the length of what are vertical pipes: straight, and within `UPRIGHT` of vertical.
    """

    lengths: Floats
    shortest: Floats
    turning: Floats
    upright: Floats

    @property
    def stretch(self) -> float:
        """Length of all curves over that of the shortest trees; 1 where these have none."""
        shortest = float(self.shortest.sum())
        return float(self.lengths.sum()) / shortest if shortest > 0.0 else 1.0

    @property
    def mean_turning(self) -> float:
        """Radians for each hyperedge."""
        return float(self.turning.mean()) if len(self.turning) else 0.0

    @property
    def upright_share(self) -> float:
        """Share of all curves' length that is vertical pipes."""
        length = float(self.lengths.sum())
        return float(self.upright.sum()) / length if length > 0.0 else 0.0


def shapes_of(routing: Routing, placement: Placement) -> Shapes:
    """The shapes of a routing's hyperedges."""
    hyperedges = len(routing.radii)
    owners = np.repeat(np.arange(hyperedges), np.diff(routing.segment_starts))
    lengths, upright = _lengths(routing.control_points, routing.radii[owners])
    sums = np.zeros((hyperedges, 3))
    each = np.stack([lengths, turning(routing.control_points), upright], axis=1)
    np.add.at(sums, owners, each)
    return Shapes(sums[:, 0], shortest_lengths(placement), sums[:, 1], sums[:, 2])


def shortest_lengths(placement: Placement) -> Floats:
    """Lengths of short trees between the attachments of each hyperedge, (h,)."""
    starts, positions = placement.attachment_starts, placement.attachment_positions
    hyperedges = len(starts) - 1
    if hyperedges == 0:
        return np.zeros(0)
    trees = short_trees(np.ascontiguousarray(positions), starts)
    nodes = np.concatenate([positions, trees.joins])
    owners = np.repeat(np.arange(hyperedges), np.diff(trees.edge_starts))
    counts = np.diff(starts)[owners, None]
    at_attachment = trees.edges < counts
    joins = len(positions) + trees.join_starts[owners, None] + trees.edges - counts
    rows = np.where(at_attachment, starts[owners, None] + trees.edges, joins)
    lengths = np.linalg.norm(nodes[rows[:, 0]] - nodes[rows[:, 1]], axis=1)
    return np.asarray(np.bincount(owners, weights=lengths, minlength=hyperedges))


def turning(control_points: Floats) -> Floats:
    """The sum of angles by which each of the cubics (s, 4, 3) turns, (s,), radians.

    Where a curve stands still it goes on as before.
    """
    found = np.zeros(len(control_points))
    before = np.zeros((len(control_points), 3))
    for t in np.linspace(0.0, 1.0, STEPS + 1):
        velocity, _ = _derivatives(control_points, float(t))
        speeds = np.linalg.norm(velocity, axis=1)
        moving = speeds > 1e-12
        now = np.where(moving[:, None], velocity / np.where(moving, speeds, 1.0)[:, None], before)
        sines = np.linalg.norm(np.cross(before, now), axis=1)
        found += np.arctan2(sines, (before * now).sum(axis=1))
        before = now
    return found


def _lengths(control_points: Floats, radii: Floats) -> tuple[Floats, Floats]:
    """The length of each cubic (s, 4, 3), and of what of it is vertical pipes; (s,) each.

    By the rule of Gauss and Legendre.
    """
    lengths, upright = np.zeros(len(radii)), np.zeros(len(radii))
    places, weights = np.polynomial.legendre.leggauss(24)
    for place, weight in zip(places.tolist(), weights.tolist(), strict=True):
        velocity, acceleration = _derivatives(control_points, 0.5 + 0.5 * place)
        speeds = np.linalg.norm(velocity, axis=1)
        sweeps = np.linalg.norm(np.cross(velocity, acceleration), axis=1)
        is_straight = sweeps * radii <= STRAIGHT * speeds**3
        is_upright = np.abs(velocity[:, 2]) >= np.cos(UPRIGHT) * speeds
        step = 0.5 * weight * speeds
        lengths += step
        upright += np.where(is_straight & is_upright, step, 0.0)
    return lengths, upright


def _derivatives(control_points: Floats, t: float) -> tuple[Floats, Floats]:
    """First and second derivatives of cubics (s, 4, 3) at ``t``, (s, 3) each."""
    first, second = 3.0 * np.diff(control_points, axis=1), 6.0 * np.diff(control_points, 2, axis=1)
    rest = 1.0 - t
    velocity = rest**2 * first[:, 0] + 2 * rest * t * first[:, 1] + t**2 * first[:, 2]
    return velocity, rest * second[:, 0] + t * second[:, 1]
