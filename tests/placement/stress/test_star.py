from __future__ import annotations

import numpy as np
import pytest

from app.placement.stress.star import GROWTH, SPOKE, components_of, distances_from, part_of, star_of


def test_a_hyperedge_is_a_centre_with_spokes() -> None:
    star = star_of(np.array([1.0, 2.0, 0.5]), np.array([0, 3]), np.array([0, 1, 2]))
    assert star.neighbours[star.starts[3] : star.starts[4]].tolist() == [0, 1, 2]
    far = distances_from(star.starts, star.neighbours, star.lengths, np.array([0]))[0]
    spoke = SPOKE * (1.0 + GROWTH)
    assert far == pytest.approx([0.0, 3.0 + 2 * spoke, 1.5 + 2 * spoke, 1.0 + spoke])


def test_components_are_found_with_their_centres() -> None:
    star = star_of(np.ones(5), np.array([0, 2, 4]), np.array([0, 2, 1, 4]))
    assert [each.tolist() for each in components_of(star)] == [[0, 2, 5], [1, 4, 6], [3]]
    part = part_of(star, np.array([1, 4, 6]))
    assert part.neighbours.tolist() == [2, 2, 0, 1]
    far = distances_from(star.starts, star.neighbours, star.lengths, np.array([0]))[0]
    assert np.isinf(far[[1, 3, 4, 6]]).all()
