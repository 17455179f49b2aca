from __future__ import annotations

import numpy as np
import pytest

from app.scene.noise import noise


def made(seed: int, *shape: int) -> np.ndarray[tuple[int, ...], np.dtype[np.float32]]:
    return noise(np.random.default_rng(seed), *shape)


@pytest.mark.parametrize("cells", [(4, 4), (3, 64), (32, 5), (128, 128), (12, 1)])
def test_noise_has_mean_nought_and_variance_one(cells: tuple[int, int]) -> None:
    found = made(1, 128, *cells)
    assert found.shape == (128, 128)
    assert found.mean() == pytest.approx(0, abs=1e-5)
    assert found.std() == pytest.approx(1, abs=1e-4)


def test_noise_goes_on_over_its_rims() -> None:
    found = made(2, 256, 8, 16)
    for axis in (0, 1):
        steps = np.abs(np.diff(found, axis=axis, append=found.take([0], axis=axis)))
        assert steps.take(-1, axis=axis).max() <= 1.05 * steps.max()
        assert steps.max() < 0.3, "and is smooth everywhere"


def test_more_cells_make_finer_noise() -> None:
    coarse, fine = made(3, 256, 4, 64), made(3, 256, 64, 4)
    assert np.abs(np.diff(coarse, axis=1)).mean() > 5 * np.abs(np.diff(coarse, axis=0)).mean()
    assert np.abs(np.diff(fine, axis=0)).mean() > 5 * np.abs(np.diff(fine, axis=1)).mean()


def test_the_same_seed_makes_the_same_noise() -> None:
    assert np.array_equal(made(4, 64, 8, 8), made(4, 64, 8, 8))
    assert not np.array_equal(made(4, 64, 8, 8), made(5, 64, 8, 8))
