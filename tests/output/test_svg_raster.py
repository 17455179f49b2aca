"""Who is in front of whom, on a grid."""

from __future__ import annotations

import numpy as np

from app.output.svg_order import order
from app.output.svg_raster import NOBODY, foremost, hidden, overlaps

NEAR = [(0.0, 0.0, 2.0), (8.0, 0.0, 2.0), (0.0, 8.0, 2.0)]
FAR = [(0.0, 0.0, 1.0), (8.0, 0.0, 1.0), (8.0, 8.0, 1.0)]


def test_what_is_nearer_is_foremost() -> None:
    found = foremost(np.array([FAR, NEAR]), np.array([0, 1]), 8, 8)
    assert found.owners[1, 1] == 1
    assert found.owners[4, 7] == 0
    assert found.owners[7, 4] == NOBODY


def test_neighbours_in_depth_are_pairs() -> None:
    pairs, counts = overlaps(np.array([FAR, NEAR]), np.array([3, 5]), 8, 8)
    assert pairs.tolist() == [[3, 5]]
    assert counts.tolist() == [16]


def test_one_of_the_same_family_hides_only_from_farther_away() -> None:
    before = foremost(np.array([NEAR]), np.array([0]), 8, 8)
    own = np.array([[7], [2]])
    for family, room, expected in ((1, 0.5, 1), (1, 1.5, 0), (2, 0.5, 0)):
        rooms = np.array([[room], [5.0]])
        pairs, _ = hidden(np.array([FAR]), own, np.array([family]), rooms, before)
        assert len(pairs) == expected


def test_a_ring_is_broken_where_it_weighs_least() -> None:
    pairs = np.array([[0, 1], [1, 2], [2, 0]])
    assert order(3, pairs, np.array([5, 4, 1])) == [0, 1, 2]
