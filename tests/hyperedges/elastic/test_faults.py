from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from app.arrays import Floats
from app.hyperedges.clearance.obstacles import Obstacles, obstacles_of
from app.hyperedges.elastic.faults import _outward
from app.solids.solid import Box, Sphere
from tests.hyperedges.clearance.furniture import furnished


@given(st.integers(0, 2**32 - 1))
@settings(max_examples=30)
def test_the_way_out_of_a_box_is_the_shortest(seed: int) -> None:
    chance = np.random.default_rng(seed)
    scene = furnished(
        [Box((2.0, 1.0, 0.6), 0.0), Sphere(0.5)],
        [[0.0, 0.0, 0.0], [5.0, 0.0, 0.0]],
        rotations=np.array([[0.0, 0.0, np.sin(0.3), np.cos(0.3)], [0.0, 0.0, 0.0, 1.0]]),
    )
    boxes = np.repeat([0, 1], 20)
    places = scene.centers[boxes] + chance.uniform(-1.2, 1.2, (40, 3))
    ways = _outward(obstacles_of(scene), boxes, places)
    np.testing.assert_allclose(np.linalg.norm(ways, axis=1), 1.0)
    # A step that way gains more distance than one in any other direction.
    obstacles = obstacles_of(scene)
    others = chance.normal(size=(50, 3))
    others /= np.linalg.norm(others, axis=1)[:, None]
    for k, box in enumerate(boxes.tolist()):
        gained = depth(obstacles, box, places[k] + 0.01 * ways[k])
        assert gained >= max(depth(obstacles, box, places[k] + 0.01 * way) for way in others) - 1e-4


def depth(obstacles: Obstacles, k: int, place: Floats) -> float:
    """How far a place is outside of a box, less than 0 within it."""
    local = np.abs(obstacles.rotations[k].T @ (place - obstacles.centers[k]))
    over = local - obstacles.halves[k]
    outside = float(np.linalg.norm(np.maximum(over, 0.0)))
    return outside - float(obstacles.roundings[k]) if outside > 0.0 else float(over.max())
