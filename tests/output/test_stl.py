from __future__ import annotations

import io

import numpy as np
import trimesh

from app.output.stl import RECORD, write_stl
from tests.output.scenes import box, matte, node, scene
from tests.output.test_shells import BOXES, printed_scene

RELATION = {
    "items": [{"id": "x", "label": "X"}, {"id": "y"}, {"id": "z"}],
    "hyperedges": [{"id": "e", "attachments": [{"item": "x"}, {"item": "y"}, {"item": "z"}]}],
}


def test_it_is_binary_stl() -> None:
    data = write_stl(BOXES)
    assert not data.startswith(b"solid")
    assert len(data) == 84 + 50 * 24
    assert int.from_bytes(data[80:84], "little") == 24


def test_normals_are_those_of_the_triangles() -> None:
    records = np.frombuffer(write_stl(BOXES), dtype=RECORD, offset=84)
    a, b, c = np.moveaxis(records["corners"].astype(np.float64), 1, 0)
    crossed = np.cross(b - a, c - a)
    lengths = np.linalg.norm(crossed, axis=1, keepdims=True)
    np.testing.assert_allclose(records["normal"], crossed / lengths, atol=1e-5)


def test_a_reader_finds_what_was_written() -> None:
    read = trimesh.load_mesh(io.BytesIO(write_stl(BOXES, scale=2.0)), file_type="stl")
    assert read.is_watertight
    assert read.body_count == 2
    assert abs(read.volume - 8 * (2 + 3)) < 1e-3


def test_a_program_is_closed_as_a_whole() -> None:
    read = trimesh.load_mesh(io.BytesIO(write_stl(printed_scene(RELATION))), file_type="stl")
    assert read.is_watertight
    assert read.is_winding_consistent
    assert all(part.volume > 0 for part in read.split())


def test_hyperedges_alone_are_one_body_each() -> None:
    data = write_stl(printed_scene(RELATION), "hyperedges")
    read = trimesh.load_mesh(io.BytesIO(data), file_type="stl")
    assert read.is_watertight
    assert read.body_count == 1
    np.testing.assert_allclose(read.bounds[0], 0, atol=1e-6)


def test_nothing_is_a_file_without_triangles() -> None:
    assert len(write_stl(scene([], [matte("#000000")], ground=False))) == 84


def test_the_same_scene_has_the_same_bytes() -> None:
    nodes = [node("a", box(1, 2, 3), 0)]
    assert write_stl(scene(nodes, [matte("#123456")])) == write_stl(
        scene(nodes, [matte("#123456")])
    )
