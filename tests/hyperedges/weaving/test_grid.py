from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from app.hyperedges.weaving.grid import collect, sort_into_cells


@given(st.integers(0, 2**32 - 1), st.floats(0.05, 5.0), st.floats(0.0, 3.0))
def test_all_places_near_a_line_are_found(seed: int, cell: float, reach: float) -> None:
    chance = np.random.default_rng(seed)
    places = chance.uniform(-5, 5, (60, 2)) * [1.0, chance.choice([0.0, 1.0, 100.0])]
    a, b = chance.uniform(-6, 6, (2, 2))
    room = np.empty(60, dtype=np.int64)
    found = room[
        : collect(sort_into_cells(places, cell), a[0], a[1], b[0], b[1], reach, room)
    ].tolist()
    run = b - a
    t = np.clip((places - a) @ run / (run @ run), 0, 1)
    near = np.linalg.norm(places - a - t[:, None] * run, axis=1) <= reach
    assert set(np.flatnonzero(near)) <= set(found)
    assert len(set(found)) == len(found)


def test_places_without_extent_have_a_cell() -> None:
    room = np.empty(3, dtype=np.int64)
    grid = sort_into_cells(np.ones((3, 2)), 1.0)
    assert collect(grid, 1.0, 1.0, 1.0, 1.0, 0.1, room) == 3
    nobody = sort_into_cells(np.zeros((0, 2)), 1.0)
    assert collect(nobody, 0.0, 0.0, 1.0, 1.0, 9.0, room) == 0
