"""Single cubics in place of several that bend too much."""

from __future__ import annotations

import numpy as np
import pytest

from app.arrays import Floats
from app.hyperedges.elastic.merging import TIGHT, wider
from app.hyperedges.weaving.curvature import least_radius

RADIUS = 0.1

# Up, round a corner that is narrower than a tube may bend, and down again.
PLACES = np.array(
    [
        [0.0, 0, 0],
        [0, 0, 0.4],
        [0.02, 0, 0.8],
        [0.25, 0, 0.95],
        [0.5, 0, 0.8],
        [0.52, 0, 0.4],
        [0.52, 0, 0],
    ]
)
UP, OVER = [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]
UNITS = np.array([UP, UP, UP, OVER, [0, 0, -1.0], [0, 0, -1.0], [0, 0, -1.0]])


def tight_piece() -> Floats:
    """From the place before the turn to its top, with handles far too short."""
    a, b = PLACES[2], PLACES[3]
    return np.array([a, a + 0.02 * UNITS[2], b - 0.02 * UNITS[3], b])


@pytest.mark.parametrize("inner", [(0, 6), (2, 6), (0, 4)])
def test_a_cubic_over_more_knots_bends_less(inner: tuple[int, int]) -> None:
    curve = tight_piece()
    before = least_radius(curve)
    assert before < 1.5 * RADIUS
    first, last = wider(inner, 2, PLACES, UNITS, RADIUS, before, curve)
    assert inner[0] <= first <= 2
    assert 3 <= last <= inner[1]
    assert last - first > 1
    np.testing.assert_array_equal(curve[[0, 3]], PLACES[[first, last]])
    for handle, unit in ((curve[1] - curve[0], UNITS[first]), (curve[3] - curve[2], UNITS[last])):
        np.testing.assert_allclose(handle / np.linalg.norm(handle), unit, atol=1e-12)
    assert least_radius(curve) >= TIGHT * RADIUS


def test_where_there_is_no_room_the_piece_stays() -> None:
    curve = tight_piece()
    assert wider((2, 3), 2, PLACES, UNITS, RADIUS, least_radius(curve), curve) == (2, 3)
    np.testing.assert_array_equal(curve, tight_piece())
