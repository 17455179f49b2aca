"""Floats as whole numbers: how far they are off."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from meshopt import decode_gltf_buffer, encode_gltf_buffer

from app.arrays import Singles
from app.output.gltf_numbers import (
    MOST_STEPS,
    MOVED,
    fits,
    folded_normals,
    on_grid,
    rounded,
    small_normals,
    spacing,
    starts_of,
)

meshes = arrays(
    np.float32,
    st.tuples(st.integers(1, 20), st.just(3)),
    elements=st.floats(-1e6, 1e6, width=32),
)
units = arrays(
    np.float32, st.tuples(st.integers(1, 20), st.just(3)), elements=st.floats(-1, 1, width=32)
).filter(lambda rows: bool((np.linalg.norm(rows, axis=1) > 0.1).all()))


def unit(rows: Singles) -> Singles:
    return np.asarray(rows / np.linalg.norm(rows, axis=1, keepdims=True), dtype=np.float32)


@given(st.lists(meshes, min_size=1, max_size=4), st.floats(1e-6, 10))
def test_rounded_positions_are_off_by_less_than_the_step(found: list[Singles], step: float) -> None:
    starts = starts_of([len(mesh) for mesh in found])
    positions = np.concatenate(found)
    kept, _ = rounded(positions, starts, step)
    for mesh, first, last in zip(found, starts[:-1], starts[1:], strict=True):
        largest = float(np.abs(mesh).max())
        moved = np.abs(kept[first:last].astype(np.float64) - mesh).max()
        # 23 bits are what there is, however fine the step.
        assert moved <= max(min(step, largest / 2**14) / 2, largest / 2**22, 1e-30)


@given(meshes, st.floats(1e-6, 10))
def test_the_rows_of_rounded_positions_are_read_as_these(mesh: Singles, step: float) -> None:
    kept, rows = rounded(mesh, starts_of([len(mesh)]), step)
    coded = encode_gltf_buffer(rows, "ATTRIBUTES")
    read = decode_gltf_buffer(coded, len(rows), 12, "ATTRIBUTES", "EXPONENTIAL")
    assert np.array_equal(read.view(np.float32).reshape(-1, 3), kept)


@given(meshes, st.floats(1e-3, 1e3))
def test_numbered_positions_are_off_by_less_than_a_fiftieth_of_the_radius(
    mesh: Singles, radius: float
) -> None:
    step = spacing(radius)
    if fits(float(np.abs(mesh).max()), step):
        rows = on_grid(mesh, starts_of([len(mesh)]), np.array([step]))
        assert np.abs(rows[:, :3]).max() <= MOST_STEPS
        assert (rows[:, 3] == 0).all()
        moved = np.linalg.norm(rows[:, :3] * step - mesh, axis=1).max()
        assert moved <= MOVED * radius * (1 + 1e-9)


def test_the_largest_that_fits_is_numbered_without_an_overflow() -> None:
    ends = np.array([[32767.4, -32767.4, 0.0]], dtype=np.float32)
    rows = on_grid(ends, starts_of([1]), np.array([1.0]))
    assert rows.tolist() == [[32767, -32767, 0, 0]]


@given(units)
def test_small_normals_are_unit_vectors_nearly(rows: Singles) -> None:
    normals = unit(rows)
    read = small_normals(normals)[:, :3] / 127.0
    assert np.abs(np.linalg.norm(read, axis=1) - 1).max() < 0.01
    assert np.abs(read - normals).max() <= 0.5 / 127 + 1e-6


@given(units)
def test_folded_normals_are_read_as_they_were_nearly(rows: Singles) -> None:
    normals = unit(rows)
    coded = encode_gltf_buffer(folded_normals(normals), "ATTRIBUTES")
    read = decode_gltf_buffer(coded, len(normals), 4, "ATTRIBUTES", "OCTAHEDRAL")
    read = read.reshape(-1).view(np.int8).reshape(-1, 4)[:, :3] / 127.0
    assert np.abs(np.linalg.norm(read, axis=1) - 1).max() < 0.02
    assert np.einsum("ij,ij->i", unit(read.astype(np.float32)), normals).min() > np.cos(0.025)


@pytest.mark.parametrize("count", [0, 3])
def test_starts_begin_at_nothing(count: int) -> None:
    assert starts_of([2] * count).tolist() == list(range(0, 2 * count + 1, 2))
