from __future__ import annotations

from math import radians

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from app.solids.extents import size_of
from app.solids.lettering import extent
from app.solids.mesh import Mesh
from app.solids.meshing import mesh_of
from app.solids.solid import Text
from tests.solids.surfaces import assert_closed, assert_sound, encloses, largest_deviation, welded

WORDS = ["Tree", "argument", "Жяλ", "∀x∈S: x≤∞", "a→b⇒c", "Ångström", "\U0010fffd", "8%@&§"]


@pytest.mark.parametrize("word", WORDS)
def test_letters_are_closed_and_sound(word: str) -> None:
    mesh = mesh_of(Text(word, 1.0, 0.2))
    assert_sound(mesh)
    assert_closed(mesh)


@pytest.mark.parametrize("word", WORDS)
def test_walls_shade_smoothly_round_curves_and_break_at_corners(word: str) -> None:
    assert largest_deviation(mesh_of(Text(word, 1.0, 0.2))) < radians(40)


@given(st.text("AVgλЖ∀→ é8", min_size=1, max_size=12), st.floats(1e-3, 1e5), st.floats(1e-3, 1e5))
def test_the_box_of_the_letters_is_centred_and_as_large_as_told(
    word: str, height: float, depth: float
) -> None:
    assume(word.strip())
    text = Text(word, height, depth)
    room, half = extent(word, height), np.array(size_of(text)) / 2
    assert size_of(text) == (room.width, room.top - room.bottom, depth)
    np.testing.assert_allclose(mesh_of(text).bounds, [-half, half], rtol=1e-6)


def test_letters_read_along_x_with_their_tops_towards_y() -> None:
    mesh = mesh_of(Text("L", 1.0, 0.2))
    in_upper_half = mesh.vertices[mesh.vertices[:, 1] > 0]
    assert in_upper_half[:, 0].max() < 0


def test_a_letter_has_the_volume_of_its_ink() -> None:
    box = welded(mesh_of(Text("-", 1.0, 0.5)))
    x, y, z = size_of(Text("-", 1.0, 0.5))
    assert box.volume == pytest.approx(x * y * z, rel=1e-6)


def test_counters_are_holes() -> None:
    ring = mesh_of(Text("O", 1.0, 0.2))
    assert welded(ring).euler_number == 0
    assert not encloses(ring, (0.0, 0.0, 0.0))


@pytest.mark.parametrize("text", ["", "  \n", "\x00"])
def test_blank_text_has_no_triangles_and_no_size(text: str) -> None:
    mesh = mesh_of(Text(text, 1.0, 0.2))
    assert len(mesh.faces) == 0
    assert size_of(Text(text, 1.0, 0.2)) == (0.0, 0.0, 0.0)
    np.testing.assert_array_equal(mesh.bounds, np.zeros((2, 3)))


def test_a_long_text_is_made_alike_each_time_without_being_kept() -> None:
    text = Text("argument " * 60, 1.0, 0.2)
    first, second = mesh_of(text), mesh_of(text)
    assert first is not second
    assert _bytes(first) == _bytes(second)


def _bytes(mesh: Mesh) -> bytes:
    return mesh.vertices.tobytes() + mesh.normals.tobytes() + mesh.faces.tobytes()
