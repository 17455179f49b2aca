"""Placements as plane drawings: seen from above, with every label on top."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from app.arrays import Floats
from app.placement.placement import LabelPlace, Placement
from app.placement.turning import UNTURNED, matrices
from app.program.model import Program
from app.solids.solid import Size, Text, Tray

ABOVE = 1.5
"""Thickest radii between the highest item and the plane that all hyperedges run in."""

INSIDE = 1.0
"""Radii by which a hyperedge ends within its item's edge, where it has no point of its own."""


def flattened(placement: Placement, program: Program) -> Placement:
    """The same items with labels to be read from above, and all attachments in one plane.

    The plane is higher than every item. A hyperedge that names no attachment point ends at the edge
    of its item, seen from above, on the side of its other ends; the directions of all attachments
    lie in the plane.
    """
    labels = tuple(
        label if label is None or isinstance(solid, Tray) else _on_top(label, size)
        for label, solid, size in zip(
            placement.labels, placement.solids, placement.sizes.tolist(), strict=True
        )
    )
    laid = replace(placement, labels=labels)
    if not program.hyperedges:
        return laid
    named = np.array(
        [end.point is not None for each in program.hyperedges for end in each.attachments]
    )
    positions, directions = _ends(placement, named)
    return replace(laid, attachment_positions=positions, attachment_directions=directions)


def _on_top(label: LabelPlace, size: Sequence[float]) -> LabelPlace:
    ink: Size = label.size
    letters = Text(label.text.text, label.text.height, label.text.depth)
    return LabelPlace(letters, (0.0, 0.0, size[2] / 2), UNTURNED, ink)


def _ends(placement: Placement, named: NDArray[np.bool_]) -> tuple[Floats, Floats]:
    """Positions and unit directions (a, 3) in the plane."""
    starts, items = placement.attachment_starts, placement.attachment_items
    counts = np.diff(starts)
    owners = np.repeat(np.arange(len(counts)), counts)
    radii = placement.radii[owners]
    turns = matrices(placement.rotations)
    centers = placement.centers[items]
    at = np.where(named[:, None], placement.attachment_positions, centers)[:, :2]
    others = (np.add.reduceat(at, starts[:-1], axis=0)[owners] - at) / (counts[owners] - 1)[:, None]
    own = turns[items].transpose(0, 2, 1)
    towards = np.einsum("aij,aj->ai", own, np.column_stack([others - at, np.zeros(len(at))]))[:, :2]
    towards[~towards.any(axis=1)] = (0.0, 1.0)
    halves = placement.sizes[items, :2] / 2
    share = np.abs(towards) / np.maximum(halves, 1e-12)
    across = np.argmax(share, axis=1)
    rows = np.arange(len(at))
    normals = np.zeros((len(at), 3))
    normals[rows, across] = np.where(towards[rows, across] < 0, -1.0, 1.0)
    edges = np.column_stack([towards / share.max(axis=1)[:, None], np.zeros(len(at))])
    # Not nearer to the item's corners than its rounding, nor beyond its middle.
    inset = np.minimum(INSIDE * radii, halves[rows, across])
    edges -= normals * inset[:, None]
    placed = np.einsum("aij,aj->ai", turns[items], edges) + centers
    outward = np.einsum("aij,aj->ai", turns[items], normals)
    outward[named] = placement.attachment_directions[named]
    outward[:, 2] = 0.0
    upright = np.hypot(outward[:, 0], outward[:, 1]) < 1e-6
    outward[upright, :2] = (others - at)[upright]
    lengths = np.linalg.norm(outward, axis=1)
    outward[lengths < 1e-12] = (0.0, 1.0, 0.0)
    outward /= np.maximum(np.linalg.norm(outward, axis=1), 1e-12)[:, None]
    positions = np.where(named[:, None], placement.attachment_positions, placed)
    positions[:, 2] = plane(placement)
    return positions, outward


def plane(placement: Placement) -> float:
    """The height that all hyperedges run at: above every item."""
    reach = np.abs(matrices(placement.rotations)[:, 2]) * placement.sizes / 2
    tops = placement.centers[:, 2] + reach.sum(axis=1)
    return float(tops.max() + ABOVE * placement.radii.max())
