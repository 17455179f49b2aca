"""The least radius of curvature of cubics, beside what very many places show."""

from __future__ import annotations

import numpy as np
import pytest

from app.arrays import Floats
from app.hyperedges.weaving.curvature import least_radius

ALONG = np.linspace(0.0, 1.0, 4001)


def radius_by_hand(curve: Floats) -> float:
    """Of |B'|³ over |B' x B''| at all of `ALONG`."""
    first, second = 3 * np.diff(curve, axis=0), 6 * np.diff(curve, 2, axis=0)
    t = ALONG[:, None]
    velocity = (1 - t) ** 2 * first[0] + 2 * t * (1 - t) * first[1] + t * t * first[2]
    acceleration = (1 - t) * second[0] + t * second[1]
    bends = np.linalg.norm(np.cross(velocity, acceleration), axis=1)
    return float(1.0 / (bends / np.linalg.norm(velocity, axis=1) ** 3).max())


def test_of_two_tight_places_the_tighter_one_counts() -> None:
    # As relaxation fitted it: the place that looks tightest at first is not.
    curve = np.array(
        [
            [8.302807825920391, 9.312552490032301, 1.2424998292175757],
            [8.420216275346895, 9.335800507748667, 1.6346090930449115],
            [9.384505116371935, 9.952907278963568, 2.028213736787875],
            [8.940459441752225, 9.310298544653936, 2.4511743529732795],
        ]
    )
    assert least_radius(curve) == pytest.approx(radius_by_hand(curve), rel=1e-3)


def test_of_random_curves_next_to_none_is_tighter_than_is_said() -> None:
    chance = np.random.default_rng(3)
    curves = chance.normal(size=(2000, 4, 3))
    curves[:, 1] = curves[:, 0] + 0.5 * curves[:, 1]
    said = np.array([least_radius(curve) for curve in curves])
    seen = np.array([radius_by_hand(curve) for curve in curves])
    turning = said > 0.0  # others turn by more than a right angle at once
    over = said[turning] / seen[turning]
    assert turning.mean() > 0.9
    assert over.min() > 0.999
    assert np.quantile(over, 0.99) < 1.002


@pytest.mark.parametrize("size", [1.0, 1e-50, 1e-60, 1e-160])
def test_a_straight_curve_of_no_size_is_no_error(size: float) -> None:
    straight = np.linspace([0.0, 0.0, 0.0], [3.0, 0.0, 0.0], 4)
    assert least_radius(size * straight) in (np.inf, 0.0)
