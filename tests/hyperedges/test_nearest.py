from __future__ import annotations

import numpy as np
import pytest

from app.hyperedges.nearest import empty_tree, insert, nearest, rebuild, remove
from tests.hyperedges.scenes import troubles

CROWDED = {"all at one place", "all at the origin", "few places", "two places", "signed zeros"}
"""Coincident points, which the tree is spared."""


@pytest.mark.parametrize("dimensions", [2, 3])
def test_nearest_is_what_a_look_at_all_points_finds(dimensions: int) -> None:
    chance = np.random.default_rng(0)
    for name, points in troubles(300).items():
        if name in CROWDED or len(np.unique(points[:, :dimensions], axis=0)) < len(points):
            continue
        tree = empty_tree(300, 200)
        rebuild(tree, points, np.arange(200), dimensions)
        living = set(range(200))
        for newcomer in range(200, 300):
            for victim in chance.choice(sorted(living), 2, replace=False).tolist():
                remove(tree, victim)
                living.remove(victim)
            assert insert(tree, points, newcomer, dimensions)
            living.add(newcomer)
            i = int(chance.choice(sorted(living)))
            partner, distance = nearest(tree, points, i, dimensions)
            squares = ((points[:, :dimensions] - points[i, :dimensions]) ** 2).sum(axis=1)
            others = sorted(living - {i}, key=lambda j: (squares[j], min(i, j), max(i, j)))
            assert partner == others[0], name
            assert distance == squares[partner]


def test_a_point_alone_has_no_neighbour() -> None:
    points = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]])
    tree = empty_tree(2, 2)
    rebuild(tree, points, np.arange(2), 3)
    assert nearest(tree, points, 0, 3) == (1, 1.0)
    remove(tree, 1)
    assert nearest(tree, points, 0, 3) == (-1, np.inf)
