from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from app.placement.stress.shelves import shelved

sizes = st.lists(st.tuples(st.floats(0.1, 9.0), st.floats(0.1, 9.0)), min_size=1, max_size=40)


@given(sizes, st.floats(0.0, 2.0))
def test_rectangles_on_shelves_are_a_gap_apart(
    rectangles: list[tuple[float, float]], gap: float
) -> None:
    halves = np.array(rectangles) / 2
    middles = shelved(np.array(rectangles), gap)
    lows, highs = middles - halves, middles + halves
    assert lows[:, 0].min() >= -1e-9
    assert highs[:, 1].max() <= 1e-9
    for one in range(len(rectangles)):
        for other in range(one):
            between = np.maximum(lows[one] - highs[other], lows[other] - highs[one])
            assert between.max() >= gap - 1e-9
