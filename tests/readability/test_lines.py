"""Polylines along curves."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from app.readability.lines import FLATNESS, lines_along, points_at

coordinates = st.floats(-5.0, 5.0, allow_subnormal=False)


@given(st.lists(coordinates, min_size=12, max_size=12), st.sampled_from([0.02, 0.1, 1.0]))
@settings(deadline=None)
def test_they_stay_beside_their_curves(numbers: list[float], radius: float) -> None:
    cubic = np.array(numbers).reshape(1, 4, 3)
    lines = lines_along(cubic, np.array([5]), np.array([radius]))
    assert np.array_equal(lines.begins[0], cubic[0, 0])
    assert np.allclose(lines.ends[-1], cubic[0, 3])
    assert np.allclose(lines.begins[1:], lines.ends[:-1])
    assert (lines.owners == 5).all()
    assert (lines.radii == radius).all()
    pieces = len(lines.begins)
    middles = points_at(np.repeat(cubic, pieces, axis=0), (np.arange(pieces) + 0.5) / pieces)
    off = np.linalg.norm(middles - 0.5 * (lines.begins + lines.ends), axis=1)
    assert (off <= FLATNESS * radius * (1 + 1e-9)).all()
