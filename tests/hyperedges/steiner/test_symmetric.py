from __future__ import annotations

import numpy as np
import pytest

from app.arrays import Floats
from app.hyperedges.steiner.symmetric import Symmetric, inverse, sandwich, times


def six(matrix: Floats) -> Symmetric:
    xx, xy, xz, _, yy, yz, _, _, zz = (float(entry) for entry in matrix.ravel())
    return xx, yy, zz, xy, xz, yz


def positive(chance: np.random.Generator) -> Floats:
    root = chance.normal(size=(3, 3))
    return np.asarray(root @ root.T + 0.1 * np.eye(3))


def test_products_and_inverses_are_those_of_numpy() -> None:
    chance = np.random.default_rng(0)
    for _ in range(20):
        one, other, vector = positive(chance), positive(chance), chance.normal(size=3)
        assert times(six(one), *vector) == pytest.approx(one @ vector)
        assert inverse(six(one)) == pytest.approx(
            six(np.asarray(np.linalg.inv(one), dtype=np.float64))
        )
        assert sandwich(six(one), six(other)) == pytest.approx(six(np.asarray(one @ other @ one)))


def test_a_singular_matrix_has_a_finite_inverse() -> None:
    assert np.isfinite(inverse((1.0, 1.0, 0.0, 1.0, 0.0, 0.0))).all()
    assert np.isfinite(inverse((0.0, 0.0, 0.0, 0.0, 0.0, 0.0))).all()
