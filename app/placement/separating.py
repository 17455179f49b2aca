"""Ends at attachment points that are almost far enough apart are moved by what is missing."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from app.arrays import Flags, Floats, Indices
from app.placement.placement import Placement

LACK = 0.125
"""The most that may be missing, over what tubes need: less than is seen. What lacks more is left
where the document wants it, and reported as a conflict."""

SPARE = 1e-3
"""So much more than is needed, over that: the certificate cannot decide what is exactly as far."""

ROUNDS = 16
"""Moving one end apart from a second may bring it nearer to a third."""


def separated(placement: Placement, clearance: float, held: Flags) -> Placement:
    """The placement with such ends of different hyperedges apart, but for those ``held`` (a,).

    Both ends of a pair move by half of what is missing, square to their directions; a held one lets
    the other move by all of it.
    """
    from scipy.spatial import cKDTree

    starts, items = placement.attachment_starts, placement.attachment_items
    owners = np.repeat(np.arange(len(placement.radii)), np.diff(starts))
    radii = placement.radii[owners]
    if len(owners) == 0:
        return placement
    need = (2.0 * float(radii.max()) + clearance) * (1.0 + SPARE)
    positions = placement.attachment_positions.copy()
    pairs: Indices = cKDTree(positions).query_pairs(need, output_type="ndarray")
    pairs = pairs[items[pairs[:, 0]] == items[pairs[:, 1]]]
    pairs = pairs[owners[pairs[:, 0]] != owners[pairs[:, 1]]]
    pairs = pairs[~held[pairs].all(axis=1)]
    needs = (radii[pairs].sum(axis=1) + clearance) * (1.0 + SPARE)
    far = np.linalg.norm(positions[pairs[:, 0]] - positions[pairs[:, 1]], axis=1)
    few = (far < needs) & (far >= (1.0 - LACK) * needs)
    pairs, needs = pairs[few], needs[few]
    if len(pairs) == 0:
        return placement
    pairs, needs = pairs[(order := np.lexsort(pairs.T[::-1]))], needs[order]
    for _ in range(ROUNDS):
        if not _move(positions, placement.attachment_directions, pairs, needs, held):
            break
    return replace(placement, attachment_positions=positions)


def _move(
    positions: Floats, directions: Floats, pairs: Indices, needs: Floats, held: Flags
) -> bool:
    """Move pairs (n, 2) of ends by what they lack, in place. False where none lacks anything."""
    ways = positions[pairs[:, 0]] - positions[pairs[:, 1]]
    far = np.linalg.norm(ways, axis=1)
    near = far < needs
    if not near.any():
        return False
    shares = np.where(held[pairs], 0.0, 1.0)
    shares /= shares.sum(axis=1, keepdims=True)
    for side, sign in ((0, 1.0), (1, -1.0)):
        ends = pairs[near, side]
        step = (sign * shares[near, side] * (needs - far)[near] / far[near])[:, None] * ways[near]
        along = np.einsum("nj,nj->n", step, directions[ends])
        np.add.at(positions, ends, step - along[:, None] * directions[ends])
    return True
