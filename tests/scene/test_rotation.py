from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from app.placement.turning import matrices
from app.scene.rotation import quaternion

quaternions = (
    st.tuples(*[st.floats(-1, 1)] * 4)
    .filter(lambda q: float(np.linalg.norm(q)) > 0.1)
    .map(lambda q: np.array(q) / np.linalg.norm(q))
)


@given(st.lists(quaternions, min_size=1, max_size=5))
def test_matrices_are_scipys(many: list[np.ndarray]) -> None:
    stacked = np.array(many)
    assert matrices(stacked) == pytest.approx(Rotation.from_quat(stacked).as_matrix(), abs=1e-14)


@given(quaternions)
def test_a_quaternion_survives_as_a_matrix(q: np.ndarray) -> None:
    found = np.array(quaternion(matrices(q)))
    assert found[3] >= 0
    assert min(np.abs(found - q).max(), np.abs(found + q).max()) < 1e-14


@pytest.mark.parametrize("axis", range(3))
def test_half_turns_have_quaternions_too(axis: int) -> None:
    matrix = -np.eye(3)
    matrix[axis, axis] = 1.0
    assert quaternion(matrix) == pytest.approx(tuple(np.eye(4)[axis]))
