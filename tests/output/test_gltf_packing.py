"""Scenes merged and compressed: what comes back is what was there, only smaller."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from itertools import product
from pathlib import Path
from typing import Any, get_args

import numpy as np
import pytest

from app.output.gltf import write_glb, write_gltf
from app.output.gltf_chunks import MOST_SHORT
from app.output.gltf_numbers import MOVED
from app.output.gltf_packing import MANY, Packing
from app.output.media import Compression
from app.scene.scene import Node, Primitive, Scene
from app.solids.mesh import Mesh
from app.staging import make_crowd, make_scene
from tests.output.gltf_reader import Asset
from tests.output.node_tools import load, run_module, validate
from tests.output.woven_scenes import (
    corners_of,
    grid_scene,
    hyperedges_of,
    program_in_a_grid,
    scaled,
    tubes_read_back,
)
from tests.scene.hand_built import node_named, program_of, scene_of, three_items

COMPRESSIONS: tuple[Compression, ...] = get_args(Compression)
PACKINGS = [Packing(*both) for both in product(COMPRESSIONS, (False, True))]
SMALLER = ("quantize", "meshopt")
PAGE = Path(__file__).parents[2] / "docs" / "large-scenes.md"

every_way = pytest.mark.parametrize("packing", PACKINGS, ids=str)
merged_and_smaller = pytest.mark.parametrize("compress", SMALLER)


@pytest.fixture(scope="module")
def scene() -> Scene:
    """A dozen hyperedges of three materials and two radii."""
    return grid_scene()


def asset_of(scene: Scene, packing: Packing) -> Asset:
    return Asset.from_glb(write_glb(scene, packing))


def chunk_nodes(asset: Asset) -> list[dict[str, Any]]:
    found = [node for node in asset.json["nodes"] if "extras" in node]
    return [node for node in found if node["extras"]["shows"] == "hyperedges"]


def primitive_of(asset: Asset, node: dict[str, Any]) -> dict[str, Any]:
    (primitive,) = asset.json["meshes"][node["mesh"]]["primitives"]
    return dict(primitive)


def component(asset: Asset, node: dict[str, Any], attribute: str = "POSITION") -> int:
    number = primitive_of(asset, node)["attributes"][attribute]
    return int(asset.json["accessors"][number]["componentType"])


@every_way
def test_no_vertex_moves_by_more_than_a_fiftieth_of_its_tubes_radius(
    scene: Scene, packing: Packing
) -> None:
    tubes = tubes_read_back(asset_of(scene, packing))
    assert set(tubes) == set(hyperedges_of(scene))
    for name, node in hyperedges_of(scene).items():
        assert node.radius is not None
        read, expected = tubes[name][0], corners_of(node)
        # The codec for triangles may begin with another corner.
        turns = np.stack([np.roll(read, turn, axis=1) for turn in range(3)])
        moved = np.linalg.norm(turns - expected, axis=3).max(axis=2).min(axis=0)
        most = 1e-6 if packing.compress == "none" else MOVED * node.radius
        assert moved.max() <= most + 1e-6


@every_way
def test_vertices_that_were_equal_stay_equal(scene: Scene, packing: Packing) -> None:
    tubes = tubes_read_back(asset_of(scene, packing))
    for name, node in hyperedges_of(scene).items():
        expected = corners_of(node)
        read = tubes[name][0]
        turns = np.stack([np.roll(read, turn, axis=1) for turn in range(3)])
        best = np.linalg.norm(turns - expected, axis=3).max(axis=2).argmin(axis=0)
        straight = turns[best, np.arange(len(best))].reshape(-1, 3)
        _, places, groups = np.unique(
            expected.reshape(-1, 3), axis=0, return_index=True, return_inverse=True
        )
        assert len(places) < len(groups), "tubes share the rings of their joins"
        assert np.array_equal(straight, straight[places][groups.reshape(-1)])


@every_way
def test_normals_are_off_by_hardly_more_than_a_degree(scene: Scene, packing: Packing) -> None:
    tubes = tubes_read_back(asset_of(scene, packing))
    for name, node in hyperedges_of(scene).items():
        mesh = node.primitives[0].mesh
        expected, read = mesh.normals[mesh.faces].astype(np.float64), tubes[name][1]
        lengths = np.linalg.norm(read, axis=2)
        assert np.abs(lengths - 1).max() < 0.02
        turns = np.stack([np.roll(read / lengths[..., None], turn, axis=1) for turn in range(3)])
        off = np.linalg.norm(turns - expected, axis=3).max(axis=2).min(axis=0)
        assert np.degrees(off.max()) < 1.2


@every_way
def test_colors_are_the_hyperedges_own(scene: Scene, packing: Packing) -> None:
    tubes = tubes_read_back(asset_of(scene, packing))
    for name, node in hyperedges_of(scene).items():
        expected = scene.materials[node.primitives[0].material].base_color
        assert np.abs(tubes[name][2] - expected).max() <= 0.5 / 255 + 1e-9


@every_way
def test_items_stay_nodes_of_their_own(scene: Scene, packing: Packing) -> None:
    asset = asset_of(scene, packing)
    for node in scene.nodes:
        if node.shows == "hyperedge":
            continue
        found = asset.node(node.name)
        assert found["extras"] == node.extras
        assert found.get("translation", [0, 0, 0]) == list(node.translation)
        assert "scale" not in found
        for part, primitive in zip(node.primitives, asset.primitives(node.name), strict=True):
            positions = asset.numbers(primitive["attributes"]["POSITION"])
            size = np.abs(part.mesh.vertices).max()
            assert np.abs(positions - part.mesh.vertices).max() <= size / 2**14


@pytest.mark.parametrize("compress", COMPRESSIONS)
def test_what_hyperedges_say_of_themselves_is_kept(scene: Scene, compress: Compression) -> None:
    chunks = chunk_nodes(asset_of(scene, Packing(compress, merge=True)))
    said = [each for chunk in chunks for each in chunk["extras"]["hyperedges"]]
    own = [json.loads(json.dumps(node.extras)) for node in hyperedges_of(scene).values()]
    assert sorted(said, key=lambda each: each["id"]) == sorted(own, key=lambda each: each["id"])


def test_one_chunk_for_each_kind_of_surface(scene: Scene) -> None:
    asset = asset_of(scene, Packing(merge=True))
    chunks = chunk_nodes(asset)
    names = [
        asset.json["materials"][primitive_of(asset, chunk)["material"]]["name"] for chunk in chunks
    ]
    assert sorted(names) == ["metal", "plastic"]
    assert [chunk["name"] for chunk in chunks] == ["hyperedges 0", "hyperedges 1"]


def test_features_are_told_as_ext_mesh_features_says(scene: Scene) -> None:
    asset = asset_of(scene, Packing(merge=True))
    assert "EXT_mesh_features" in asset.json["extensionsUsed"]
    assert "extensionsRequired" not in asset.json
    for chunk in chunk_nodes(asset):
        primitive = primitive_of(asset, chunk)
        count = len(chunk["extras"]["hyperedges"])
        expected = {"featureCount": count, "attribute": 0, "label": "hyperedge"}
        assert primitive["extensions"] == {"EXT_mesh_features": {"featureIds": [expected]}}
        features = asset.values(primitive["attributes"]["_FEATURE_ID_0"])
        assert np.array_equal(np.unique(features), np.arange(count))


@pytest.mark.parametrize(
    ("compress", "required"),
    [
        ("none", None),
        ("quantize", ["KHR_mesh_quantization"]),
        ("meshopt", ["KHR_mesh_quantization", "EXT_meshopt_compression"]),
    ],
)
def test_readers_are_told_what_they_must_know(
    scene: Scene, compress: Compression, required: list[str] | None
) -> None:
    asset = asset_of(scene, Packing(compress))
    assert asset.json.get("extensionsRequired") == required
    assert set(required or []) <= set(asset.json["extensionsUsed"])


def test_each_step_is_smaller(scene: Scene) -> None:
    sizes = [len(write_glb(scene, Packing(compress, merge=True))) for compress in COMPRESSIONS]
    assert sizes[1] < 0.85 * sizes[0]
    assert sizes[2] < 0.5 * sizes[0]


@pytest.mark.parametrize(("count", "chunks"), [(MANY, 0), (MANY + 1, 1)])
def test_many_hyperedges_are_merged_unless_asked_otherwise(count: int, chunks: int) -> None:
    scene = scene_of(program_of(items=[{"id": "x"}]))
    triangle = Mesh(
        np.eye(3, dtype=np.float32), np.eye(3, dtype=np.float32), np.array([[0, 1, 2]], np.uint32)
    )
    nodes = [hyperedge(f"e{number}", triangle) for number in range(count)]
    scene = replace(scene, nodes=(*scene.nodes, *nodes))
    assert len(chunk_nodes(asset_of(scene, Packing()))) == chunks
    assert not chunk_nodes(asset_of(scene, Packing(merge=False)))


@every_way
def test_a_crowd_is_written_as_nodes_that_are_merged(packing: Packing) -> None:
    program = program_in_a_grid(40)
    crowded = make_scene(program, 4 / 3, sweeping=make_crowd)
    assert not hyperedges_of(crowded)
    usual = make_scene(program, 4 / 3)
    one = tubes_read_back(asset_of(crowded, packing))
    other = tubes_read_back(asset_of(usual, replace(packing, merge=True)))
    assert set(one) == set(other)
    assert all(np.array_equal(one[name][k], other[name][k]) for name in one for k in (1, 2)), (
        "normals and colours"
    )
    for name, node in hyperedges_of(usual).items():
        assert np.abs(one[name][0] - other[name][0]).max() <= 2 * MOVED * (node.radius or 0) + 1e-6
    camera, expected = crowded.camera, usual.camera
    assert camera.position == pytest.approx(expected.position, rel=1e-3)
    assert crowded.bounds == pytest.approx(usual.bounds, abs=0.01)


def test_what_crowds_say_of_themselves_is_what_nodes_would() -> None:
    program = program_in_a_grid(9)
    crowded = make_scene(program, 4 / 3, sweeping=make_crowd)
    said = [
        each
        for chunk in chunk_nodes(asset_of(crowded, Packing()))
        for each in chunk["extras"]["hyperedges"]
    ]
    own = [node.extras for node in hyperedges_of(make_scene(program, 4 / 3)).values()]
    assert sorted(map(json.dumps, said)) == sorted(map(json.dumps, own))


@merged_and_smaller
def test_large_hyperedges_are_merged_with_each_other(compress: Compression) -> None:
    base = scene_of(program_of(items=[{"id": "x"}]))
    long = strip(9)
    long = replace(long, vertices=long.vertices * np.array([1000, 1, 1], dtype=np.float32))
    nodes = [hyperedge(f"long {y}", long, (0.0, y, 0.0)) for y in (1.0, 2.0, 3.0)]
    nodes += [hyperedge("short", strip(5)), hyperedge("other", strip(5), (3.0, 0.0, 0.0))]
    asset = asset_of(replace(base, nodes=tuple(nodes)), Packing(compress, merge=True))
    chunks = {len(chunk["extras"]["hyperedges"]): chunk for chunk in chunk_nodes(asset)}
    assert component(asset, chunks[3]) == 5126
    assert component(asset, chunks[2]) == 5122


def hyperedge(name: str, mesh: Mesh, place: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> Node:
    upright = (0.0, 0.0, 0.0, 1.0)
    extras = {"shows": "hyperedge", "id": name}
    return Node(name, "hyperedge", (Primitive(mesh, 0),), place, upright, extras, 0.1)


def strip(count: int) -> Mesh:
    """A strip of ``count`` vertices, a unit long."""
    along = np.linspace(-0.5, 0.5, count, dtype=np.float32)
    vertices = np.stack([along, 0.1 * (np.arange(count) % 2), np.zeros(count)], axis=1)
    first = np.arange(count - 2)
    faces = np.stack([first, first + 1, first + 2], axis=1).astype(np.uint32)
    normals = np.tile(np.array([0, 0, 1], dtype=np.float32), (count, 1))
    return Mesh(vertices.astype(np.float32), normals, faces)


@pytest.mark.parametrize("compress", COMPRESSIONS)
def test_chunks_are_small_and_compact(compress: Compression) -> None:
    base = scene_of(program_of(items=[{"id": "x"}]))
    nodes = [
        hyperedge(f"e{x},{y}", strip(20_000), (10.0 * x, 10.0 * y, 0.0))
        for x in range(4)
        for y in range(3)
    ]
    asset = asset_of(replace(base, nodes=tuple(nodes)), Packing(compress, merge=True))
    chunks = chunk_nodes(asset)
    assert len(chunks) == 4, "as few as hold 65,535 vertices each"
    for chunk in chunks:
        primitive = primitive_of(asset, chunk)
        entry = asset.json["accessors"][primitive["attributes"]["POSITION"]]
        assert entry["count"] <= MOST_SHORT
        assert asset.json["accessors"][primitive["indices"]]["componentType"] == 5123
        scale = chunk.get("scale", [1.0])[0] / (32767 if compress != "none" else 1)
        extent = (np.array(entry["max"]) - entry["min"]) * scale
        assert extent.max() < 25, "neighbours are together"


@pytest.mark.parametrize("compress", COMPRESSIONS)
def test_one_hyperedge_is_never_divided(compress: Compression) -> None:
    base = scene_of(program_of(items=[{"id": "x"}]))
    nodes = (hyperedge("large", strip(MOST_SHORT + 1)), hyperedge("small", strip(5)))
    asset = asset_of(replace(base, nodes=nodes), Packing(compress, merge=True))
    large, small = chunk_nodes(asset)
    assert asset.json["accessors"][primitive_of(asset, large)["indices"]]["componentType"] == 5125
    assert asset.json["accessors"][primitive_of(asset, small)["indices"]]["componentType"] == 5123


@merged_and_smaller
def test_what_is_too_far_apart_for_16_bits_is_divided(compress: Compression) -> None:
    base = scene_of(program_of(items=[{"id": "x"}]))
    nodes = (hyperedge("here", strip(5)), hyperedge("there", strip(5), (1000.0, 0.0, 0.0)))
    asset = asset_of(replace(base, nodes=nodes), Packing(compress, merge=True))
    assert [component(asset, chunk) for chunk in chunk_nodes(asset)] == [5122, 5122]


@merged_and_smaller
@pytest.mark.parametrize("merge", [False, True])
def test_a_hyperedge_too_large_for_16_bits_keeps_floats(
    compress: Compression, merge: bool, scene: Scene
) -> None:
    far = scaled(scene, 1000.0)
    asset = asset_of(far, Packing(compress, merge))
    shown = [node for node in asset.json["nodes"] if "mesh" in node and "extras" in node]
    tubes = [node for node in shown if node["extras"]["shows"].startswith("hyperedge")]
    assert {component(asset, node) for node in tubes} == {5126}
    assert not any("scale" in node for node in tubes)
    read = tubes_read_back(asset)
    for name, node in hyperedges_of(far).items():
        low, high = corners_of(node).min(axis=(0, 1)), corners_of(node).max(axis=(0, 1))
        # Single precision is what there is, of numbers of some thousands.
        assert read[name][0].min(axis=(0, 1)) == pytest.approx(low, abs=2e-3)
        assert read[name][0].max(axis=(0, 1)) == pytest.approx(high, abs=2e-3)


@every_way
def test_both_formats_hold_the_same(scene: Scene, packing: Packing) -> None:
    binary = asset_of(scene, packing)
    text = Asset.from_gltf(write_gltf(scene, packing))
    assert binary.buffer == text.buffer
    text.json["buffers"][0].pop("uri")
    assert binary.json == text.json


@every_way
def test_the_same_scene_gives_the_same_bytes(scene: Scene, packing: Packing) -> None:
    assert write_glb(scene, packing) == write_glb(scene, packing)


@every_way
def test_scenes_without_tubes_are_packed_too(packing: Packing) -> None:
    empty = asset_of(scene_of(program_of(items=[])), packing)
    assert empty.buffer == b""
    assert "extensionsRequired" not in empty.json
    shapes = asset_of(scene_of(program_of(items=[{"id": "x", "label": "X"}])), packing)
    assert len(shapes.primitives("x")) == 2


@every_way
def test_tubes_of_unknown_radius_keep_floats(packing: Packing) -> None:
    scene = scene_of(three_items())
    nodes = tuple(replace(node, radius=None) for node in scene.nodes)
    asset = asset_of(replace(scene, nodes=nodes), packing)
    assert set(tubes_read_back(asset)) == {"e", "f"}
    assert not any("scale" in node for node in asset.json["nodes"])


@merged_and_smaller
def test_a_mesh_that_an_item_shows_too_keeps_floats(compress: Compression) -> None:
    scene = scene_of(three_items())
    shared = node_named(scene, "e").primitives[0]
    item = replace(node_named(scene, "x"), primitives=(shared,))
    nodes = tuple(item if node.name == "x" else node for node in scene.nodes)
    asset = asset_of(replace(scene, nodes=nodes), Packing(compress, merge=False))
    assert "scale" not in asset.node("e")
    assert "scale" in asset.node("f")


def written(scenes: list[Scene], folder: Path) -> list[Path]:
    files = []
    for number, (scene, packing) in enumerate(product(scenes, PACKINGS)):
        files.append(folder / f"{number}.glb")
        files[-1].write_bytes(write_glb(scene, packing))
        files.append(folder / f"{number}.gltf")
        files[-1].write_bytes(write_gltf(scene, packing))
    return files


def many_scenes(scene: Scene) -> list[Scene]:
    return [
        scene,
        scaled(scene, 1000.0),
        scene_of(three_items(name="Three things")),
        scene_of(program_of(items=[])),
    ]


def test_khronos_validator_finds_no_fault(scene: Scene, tmp_path: Path) -> None:
    files = written(many_scenes(scene), tmp_path)
    for file, report in zip(files, validate(files), strict=True):
        # It does not look into extensions of others, nor see what only they use.
        known = {"UNSUPPORTED_EXTENSION", "UNUSED_OBJECT", "NODE_EMPTY"}
        told = [one for one in report["issues"]["messages"] if one["code"] not in known]
        assert told == [], file
        assert report["issues"]["numErrors"] == report["issues"]["numWarnings"] == 0


def test_three_reads_every_way_alike_and_without_a_warning(scene: Scene, tmp_path: Path) -> None:
    scenes = many_scenes(scene)
    found = load(written(scenes, tmp_path))
    each = 2 * len(PACKINGS)
    for number, one_scene in enumerate(scenes):
        first, *others = found[number * each : (number + 1) * each]
        known = {one["name"]: one for one in first["objects"] if one["data"].get("shows")}
        whole = first["objects"][0]
        assert first["warnings"] == []
        for other in others:
            assert other["warnings"] == []
            again = other["objects"][0]
            assert again["triangles"] == whole["triangles"]
            if whole["triangles"]:
                size = max(1.0, np.abs(whole["high"]).max())
                assert again["low"] == pytest.approx(whole["low"], abs=2e-3 * size)
                assert again["high"] == pytest.approx(whole["high"], abs=2e-3 * size)
            for one in other["objects"]:
                if one["data"].get("shows") == "hyperedges":
                    assert one["attributes"] == ["_feature_id_0", "color", "normal", "position"]
                elif one["data"].get("shows") and one["triangles"]:
                    assert one["triangles"] == known[one["name"]]["triangles"]
        assert len(known) == len(one_scene.nodes)


PROBE = """
import { readFile } from 'node:fs/promises';
import { Color, Raycaster, Triangle, Vector3 } from 'three';

globalThis.ProgressEvent ??= class extends Event {};

const found = [];
for (const path of process.argv.slice(2)) {
  const { buffer, byteOffset, byteLength } = await readFile(path);
  const { scene } = await loader.parseAsync(buffer.slice(byteOffset, byteOffset + byteLength), '');
  scene.updateMatrixWorld(true);
  const tubes = [];
  scene.traverse((part) => {
    if (part.isMesh && part.userData.shows?.startsWith('hyperedge')) tubes.push(part);
  });
  const hits = [];
  for (const tube of tubes) {
    const { index, attributes: { position } } = tube.geometry;
    const corners = [0, 1, 2].map(() => new Vector3());
    for (let face = 0; face < index.count; face += 3 * 307) {
      corners.forEach((corner, k) => {
        corner.fromBufferAttribute(position, index.getX(face + k));
        tube.localToWorld(corner);
      });
      const triangle = new Triangle(...corners);
      const normal = triangle.getNormal(new Vector3());
      const place = triangle.getMidpoint(new Vector3());
      const from = place.clone().addScaledVector(normal, 1e-3);
      const ray = new Raycaster(from, normal.clone().negate());
      const [hit] = ray.intersectObject(tube);
      if (hit) hits.push([hyperedgeAt(hit).id, ...place.toArray()]);
    }
  }
  const before = tubes.map((tube) => Array.from(tube.geometry.attributes.color?.array ?? []));
  paint(scene, 'e3', new Color(0.25, 0.5, 0.75));
  const painted = tubes.map(({ geometry, userData }, k) => {
    const { color, _feature_id_0: features } = geometry.attributes;
    const changed = new Set();
    for (let vertex = 0; features && vertex < features.count; vertex += 1) {
      const rows = [0, 1, 2].map((axis) => color.array[4 * vertex + axis]);
      if (rows.some((value, axis) => value !== before[k][4 * vertex + axis])) {
        changed.add([userData.hyperedges[features.getX(vertex)].id, ...rows].join(' '));
      }
    }
    return [...changed];
  });
  found.push({ hits, painted: painted.flat() });
}
process.stdout.write(JSON.stringify(found));
"""


def test_the_docs_snippet_picks_and_paints_in_three(scene: Scene, tmp_path: Path) -> None:
    (snippet,) = re.findall(r"^```js\n(.*?)^```", PAGE.read_text(), re.MULTILINE | re.DOTALL)
    files = []
    for number, packing in enumerate(PACKINGS):
        files.append(tmp_path / f"{number}.glb")
        files[-1].write_bytes(write_glb(scene, packing))
    boxes = {
        name: (corners_of(node).min(axis=(0, 1)), corners_of(node).max(axis=(0, 1)))
        for name, node in hyperedges_of(scene).items()
    }
    for packing, found in zip(PACKINGS, run_module(snippet + PROBE, files), strict=True):
        assert {hit[0] for hit in found["hits"]} == set(boxes), "all can be picked"
        for name, x, y, z in found["hits"]:
            low, high = boxes[name]
            place = np.array([x, -z, y])  # three.js has y up
            assert (place >= low - 0.01).all()
            assert (place <= high + 0.01).all()
        assert found["painted"] == (["e3 64 128 191"] if packing.merge else [])
