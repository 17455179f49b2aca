"""How points are seen."""

from __future__ import annotations

import numpy as np
import pytest

from app.readability.projection import directions
from tests.readability.views import ABOVE, seen_from


def test_from_far_away() -> None:
    seen = ABOVE.seen(np.array([[1.0, 2.0, 3.0]]), 0.5)
    assert np.allclose(seen.places, [[1.0, 2.0]])
    assert seen.nearness.tolist() == [3.5]
    assert seen.scales.tolist() == [1.0]


def test_from_nearby() -> None:
    here = seen_from(0.0, 0.0, 1.0, eye=(0.0, 0.0, 10.0))
    seen = here.seen(np.array([[1.0, 2.0, 6.0], [1.0, 2.0, 0.0]]))
    assert np.allclose(seen.places, [[0.25, 0.5], [0.1, 0.2]])
    assert np.allclose(seen.scales, [0.25, 0.1])
    assert seen.nearness[0] > seen.nearness[1]


@pytest.mark.parametrize("height", [10.0, 11.0])
def test_what_is_not_before_the_eye_cannot_be_seen(height: float) -> None:
    here = seen_from(0.0, 0.0, 1.0, eye=(0.0, 0.0, 10.0))
    with pytest.raises(ValueError, match="before the eye"):
        here.seen(np.array([[0.0, 0.0, height]]))


def test_directions_lie_evenly_above() -> None:
    found = directions(60)
    assert np.allclose(np.linalg.norm(found, axis=1), 1.0)
    assert (found[:, 2] > 0.0).all()
    near = found @ found.T
    np.fill_diagonal(near, -1.0)
    # A half sphere has room for 60 caps of some 10 degrees about each.
    assert np.degrees(np.arccos(near.max(axis=1))).min() > 12.0
