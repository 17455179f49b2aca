from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.arrays import Floats
from app.placement.placement import Placement
from app.placement.separating import LACK, separated
from app.solids.solid import Box
from tests.hyperedges.clearance.furniture import furnished

CLEARANCE, RADIUS = 0.05, 0.1
NEED = 2 * RADIUS + CLEARANCE
BOX = Box((3.0, 3.0, 1.0), 0.05)


def beside(places: Floats, items: list[int] | None = None) -> Placement:
    """One hyperedge from each place (n, 2) on top of item 0 to an item far away."""
    count = len(places)
    scene = furnished(
        [BOX, BOX, BOX],
        [[0.0, 0.0, 0.5], [20.0, 0.0, 0.5], [0.0, 0.0, 0.5]],
        attachments=[[(items or [0] * count)[k], 1] for k in range(count)],
        radius=RADIUS,
    )
    positions = scene.attachment_positions.copy()
    positions[::2, :2] = places
    positions[1::2, 1] = np.arange(count)
    return replace(scene, attachment_positions=positions)


def nobody(scene: Placement) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    return np.zeros(len(scene.attachment_items), dtype=np.bool_)


def apart(scene: Placement) -> Floats:
    ends = scene.attachment_positions[::2]
    far = np.linalg.norm(ends[:, None] - ends[None], axis=2)
    return np.asarray(far[np.triu_indices(len(ends), 1)])


def test_two_ends_move_by_half_of_what_they_lack() -> None:
    scene = beside(np.array([[0.0, 0.0], [0.23, 0.0]]))
    found = separated(scene, CLEARANCE, nobody(scene))
    assert NEED < apart(found)[0] < 1.01 * NEED
    ends = found.attachment_positions[::2]
    assert ends[0, 0] == pytest.approx(0.23 - ends[1, 0])
    np.testing.assert_array_equal(ends[:, 1:], scene.attachment_positions[::2, 1:])
    np.testing.assert_array_equal(
        found.attachment_positions[1::2], scene.attachment_positions[1::2]
    )


def test_what_is_held_lets_the_other_move() -> None:
    scene = beside(np.array([[0.0, 0.0], [0.23, 0.0]]))
    held = nobody(scene)
    held[0] = True
    found = separated(scene, CLEARANCE, held)
    np.testing.assert_array_equal(found.attachment_positions[0], scene.attachment_positions[0])
    assert NEED < apart(found)[0] < 1.01 * NEED


@pytest.mark.parametrize(
    ("places", "items"),
    [
        ([[0.0, 0.0], [NEED * (1 - LACK) - 0.01, 0.0]], [0, 0]),  # too much is missing
        ([[0.0, 0.0], [0.26, 0.0]], [0, 0]),  # nothing is
        ([[0.0, 0.0], [0.23, 0.0]], [0, 2]),  # on two items
    ],
)
def test_all_else_stays_to_the_bit(places: list[list[float]], items: list[int]) -> None:
    scene = beside(np.array(places), items)
    found = separated(scene, CLEARANCE, nobody(scene))
    np.testing.assert_array_equal(found.attachment_positions, scene.attachment_positions)


@given(st.integers(0, 2**32 - 1), st.integers(2, 9))
@settings(max_examples=30)
def test_nobody_moves_farther_than_what_is_missing_around(seed: int, count: int) -> None:
    chance = np.random.default_rng(seed)
    scene = beside(chance.uniform(-0.4, 0.4, (count, 2)))
    found = separated(scene, CLEARANCE, nobody(scene))
    moved = np.linalg.norm(found.attachment_positions - scene.attachment_positions, axis=1)
    assert moved.max() < count * LACK * NEED
    again = separated(scene, CLEARANCE, nobody(scene))
    np.testing.assert_array_equal(found.attachment_positions, again.attachment_positions)
