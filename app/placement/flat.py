"""Placement for flat drawings: seen from above, with labels on top and attachments in one plane."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from app.placement.placement import LabelPlace, Placement
from app.placement.turning import UNTURNED, matrices
from app.solids.solid import Box, Solid, Text, Tray


def flattened(placement: Placement) -> Placement:
    """The same places, with every attachment in one plane above all items."""
    positions = placement.attachment_positions.copy()
    positions[:, 2] = _above(placement)
    directions = np.tile([0.0, 0.0, 1.0], (len(positions), 1))
    labels = tuple(
        None if label is None else _on_top(label, solid)
        for label, solid in zip(placement.labels, placement.solids, strict=True)
    )
    return replace(
        placement,
        attachment_positions=positions,
        attachment_directions=directions,
        labels=labels,
    )


def plane_of(placement: Placement) -> float:
    """Where a flattened placement's attachments are: world z."""
    return float(placement.attachment_positions[:, 2].max(initial=0.0))


def _above(placement: Placement) -> float:
    if len(placement.centers) == 0:
        return 0.0
    turned = np.abs(matrices(placement.rotations))
    halves = (turned @ placement.sizes[:, :, None])[:, 2, 0] / 2
    return float((placement.centers[:, 2] + halves).max()) + 2.0 * float(
        placement.radii.max(initial=0.0)
    )


def _on_top(label: LabelPlace, solid: Solid) -> LabelPlace:
    """A label that stands upright lies down: on a block, or before another solid."""
    match solid:
        case Tray() | Text():
            return label
        case Box(size=(_, _, height)):
            return replace(label, position=(0.0, 0.0, height / 2), rotation=UNTURNED)
        case _:
            x, y, z = label.position
            lower = z - label.size[1] / 2
            return replace(label, position=(x, y - label.size[1] / 2, lower), rotation=UNTURNED)
