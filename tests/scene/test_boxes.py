from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from app.scene.boxes import boxes


@given(st.lists(st.integers(0, 5), max_size=8), st.integers(0, 2**32 - 1))
def test_boxes_hold_each_group_tightly(counts: list[int], seed: int) -> None:
    vertices = np.random.default_rng(seed).normal(size=(sum(counts), 3)).astype(np.float32)
    starts = np.cumsum([0, *counts])
    found = boxes(vertices, starts)
    assert found.shape == (len(counts), 2, 3)
    for box, begin, end in zip(found, starts[:-1], starts[1:], strict=True):
        group = vertices[begin:end]
        expected = np.zeros((2, 3)) if begin == end else [group.min(axis=0), group.max(axis=0)]
        assert np.array_equal(box, expected)
