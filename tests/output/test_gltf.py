from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from itertools import chain
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from app import __version__
from app.output.gltf import write_glb, write_gltf
from app.output.gltf_chunks import MOST_SHORT
from app.scene.scene import Node, Primitive, Scene
from app.solids.mesh import Mesh
from tests.output.gltf_reader import Asset
from tests.output.node_tools import load, validate
from tests.scene.hand_built import (
    axes_of,
    balls,
    node_named,
    placed,
    program_of,
    scene_of,
    three_items,
)

WAYS: tuple[tuple[Callable[[Scene], bytes], Callable[[bytes], Asset]], ...] = (
    (write_glb, Asset.from_glb),
    (write_gltf, Asset.from_gltf),
)
UPRIGHT = (0.0, 0.0, 0.0, 1.0)


def asset_of(scene: Scene) -> Asset:
    return Asset.from_glb(write_glb(scene))


def grid(rows: int, columns: int) -> Mesh:
    """A flat sheet of ``rows`` times ``columns`` vertices."""
    x, y = np.meshgrid(np.arange(columns), np.arange(rows))
    vertices = np.stack([x, y, np.zeros_like(x)], axis=-1).reshape(-1, 3).astype(np.float32)
    low = (np.arange(rows - 1)[:, None] * columns + np.arange(columns - 1)).ravel()
    quads = np.stack([low, low + 1, low + columns + 1, low, low + columns + 1, low + columns])
    normals = np.tile(np.array([0, 0, 1], dtype=np.float32), (len(vertices), 1))
    return Mesh(vertices, normals, quads.T.reshape(-1, 3).astype(np.uint32))


def with_meshes(*meshes: Mesh) -> Scene:
    """A scene of one node for each mesh."""
    scene = scene_of(program_of(items=[{"id": "x"}], style={"ground": False}))
    nodes = tuple(
        Node(f"m{number}", "item", (Primitive(mesh, 0),), (0.0, 0.0, 0.0), UPRIGHT, {})
        for number, mesh in enumerate(meshes)
    )
    return replace(scene, nodes=nodes)


def awkward_scenes() -> list[Scene]:
    """What a writer may trip over."""
    turned = program_of(items=[{"id": "x", "material": "glass", "label": "X"}])
    placement = placed(turned)
    placement.rotations[0] = [0.5, 0.5, 0.5, 0.5]
    names = ['"quoted"', "back\\slash", "line\nbreak", "[a].b:c/d", "Größe→∞", "ground", "camera"]
    data = {"huge": 1e300, "tiny": 5e-324, "nested": [[{}], None, True, -0.0], "": "\x7f"}
    return [
        scene_of(three_items(name="Three things")),
        scene_of(three_items(style={"background": "transparent", "ground": False})),
        scene_of(three_items(view={"projection": "orthographic", "from": [0, 0, 1]})),
        scene_of(program_of(items=[])),
        scene_of(program_of(items=[{"id": "blank", "label": " "}], name="")),
        scene_of(turned, placement=placement),
        scene_of(program_of(items=[{"id": name, "label": name, "data": data} for name in names])),
        scene_of(three_items(), tubes=balls(np.array([[1e6, -1e6, 9e5], [0.001, 0, 0]]))),
        with_meshes(grid(257, 256), grid(2, 2)),
        replace(scene_of(three_items()), lights=()),
    ]


def written(scenes: list[Scene], folder: Path) -> list[Path]:
    """Files of all scenes, in both formats."""
    files = []
    for number, scene in enumerate(scenes):
        for ending, content in (("glb", write_glb(scene)), ("gltf", write_gltf(scene))):
            files.append(folder / f"{number}.{ending}")
            files[-1].write_bytes(content)
    return files


def test_khronos_validator_has_nothing_to_say(tmp_path: Path) -> None:
    files = written(awkward_scenes(), tmp_path)
    for file, report in zip(files, validate(files), strict=True):
        issues = report["issues"]
        # Items with nothing to draw are nodes all the same: an empty node is worth an "info".
        messages = [one for one in issues["messages"] if one["code"] != "NODE_EMPTY"]
        assert messages == [], file


def test_three_finds_one_named_object_for_each_item_and_hyperedge(tmp_path: Path) -> None:
    scenes = awkward_scenes()
    files = written(scenes, tmp_path)
    for scene, found in zip(chain(*zip(scenes, scenes, strict=True)), load(files), strict=True):
        objects = {(one["name"], one["data"].get("shows")): one for one in found["objects"]}
        for node in scene.nodes:
            shown = objects[node.name, node.extras.get("shows")]
            data = {key: value for key, value in shown["data"].items() if key != "name"}
            assert data == json.loads(json.dumps(node.extras))
            triangles = sum(len(part.mesh.faces) for part in node.primitives)
            assert shown["triangles"] == triangles
        assert found["cameras"] == 1


def test_three_shows_z_up_as_y_up(tmp_path: Path) -> None:
    scene = scene_of(three_items(style={"labels": False}))
    (found, _) = load(written([scene], tmp_path))
    shown = {one["name"]: one for one in found["objects"]}
    for node in scene.nodes:
        low, high = np.array([part.mesh.bounds for part in node.primitives])[0] + node.translation
        assert shown[node.name]["low"] == pytest.approx([low[0], low[2], -high[1]], abs=1e-5)
        assert shown[node.name]["high"] == pytest.approx([high[0], high[2], -low[1]], abs=1e-5)


@pytest.mark.parametrize("projection", ["perspective", "orthographic"])
def test_threes_camera_sees_what_ours_does(projection: str, tmp_path: Path) -> None:
    view = {"projection": projection, "from": [1, -2, 1.5], "margin": 0.1}
    scene = scene_of(three_items(view=view, style={"labels": False}), aspect=1.7)
    (found, _) = load(written([scene], tmp_path))
    look = np.array(found["projection"]).reshape(4, 4).T @ np.array(found["view"]).reshape(4, 4).T
    vertices = np.concatenate(
        [
            part.mesh.vertices + np.array(node.translation)
            for node in scene.nodes
            if node.shows != "ground"
            for part in node.primitives
        ]
    )
    x, y, z = vertices.T
    clipped = look @ np.stack([x, z, -y, np.ones_like(x)])
    seen = np.abs(clipped[:3] / clipped[3])
    assert seen[:2].max() == pytest.approx(0.8, abs=1e-5)
    assert seen[2].max() < 1, "near and far enclose the scene"


@pytest.mark.parametrize(("write", "read"), WAYS)
def test_everything_reads_back_as_it_was(
    write: Callable[[Scene], bytes], read: Callable[[bytes], Asset]
) -> None:
    scene = scene_of(three_items(name="Three things"))
    asset = read(write(scene))
    assert asset.json["asset"] == {"version": "2.0", "generator": f"Tubeloom {__version__}"}
    assert asset.json["scenes"] == [{"name": "Three things", "nodes": [0]}]
    for node in scene.nodes:
        found = asset.node(node.name)
        assert found.get("translation", [0, 0, 0]) == list(node.translation)
        assert found["extras"] == node.extras
        for part, primitive in zip(node.primitives, asset.primitives(node.name), strict=True):
            positions = asset.values(primitive["attributes"]["POSITION"])
            assert np.array_equal(positions, part.mesh.vertices)
            normals = asset.values(primitive["attributes"]["NORMAL"])
            assert np.array_equal(normals, part.mesh.normals)
            assert np.array_equal(
                asset.values(primitive["indices"]).reshape(-1, 3), part.mesh.faces
            )
            bounds = asset.json["accessors"][primitive["attributes"]["POSITION"]]
            assert [bounds["min"], bounds["max"]] == part.mesh.bounds.tolist()
            material = scene.materials[part.material]
            shown = asset.json["materials"][primitive["material"]]
            assert shown["name"] == material.name
            surface = shown["pbrMetallicRoughness"]
            assert tuple(surface["baseColorFactor"]) == material.base_color
            assert surface["roughnessFactor"] == material.roughness
            assert "doubleSided" not in shown


def test_the_root_alone_turns_z_to_y() -> None:
    asset = asset_of(scene_of(three_items()))
    root = asset.json["nodes"][0]
    turn = Rotation.from_quat(root["rotation"])
    assert turn.apply([[1, 0, 0], [0, 1, 0], [0, 0, 1]]) == pytest.approx(
        np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]]), abs=1e-15
    )
    assert root["children"] == list(range(1, len(asset.json["nodes"])))


def test_lights_shine_along_their_direction() -> None:
    scene = scene_of(three_items())
    asset = asset_of(scene)
    lights = asset.json["extensions"]["KHR_lights_punctual"]["lights"]
    for number, light in enumerate(scene.lights):
        node = asset.node(f"{light.name} light")
        assert node["extensions"] == {"KHR_lights_punctual": {"light": number}}
        shines = Rotation.from_quat(node["rotation"]).apply([0, 0, -1])
        assert shines == pytest.approx(light.direction, abs=1e-12)
        assert lights[number]["type"] == "directional"
        assert lights[number]["intensity"] == light.illuminance


def test_the_camera_is_where_it_should_be_and_upright() -> None:
    scene = scene_of(three_items(view={"from": [3, -1, 0.5]}))
    node = asset_of(scene).node("camera")
    axes = axes_of(scene.camera)
    turn = Rotation.from_quat(node["rotation"]).as_matrix()
    expected = np.stack([axes.right, axes.up, axes.back], axis=1)
    assert turn == pytest.approx(expected, abs=1e-12)
    assert node["translation"] == list(scene.camera.position)


def test_equal_items_share_their_mesh_and_their_triangles() -> None:
    asset = asset_of(scene_of(program_of(items=[{"id": str(number)} for number in range(50)])))
    assert {asset.node(str(number))["mesh"] for number in range(50)} == {0}
    assert len(asset.json["meshes"]) == 2, "one cube and the ground"


def test_equal_triangles_of_different_tubes_are_stored_once() -> None:
    asset = asset_of(scene_of(three_items(style={"labels": False})))
    e, f = asset.primitives("e")[0], asset.primitives("f")[0]
    assert e["indices"] == f["indices"]
    assert e["attributes"] != f["attributes"]


@pytest.mark.parametrize(
    ("rows", "component"), [(MOST_SHORT // 3, 5123), (MOST_SHORT // 3 + 1, 5125)]
)
def test_few_vertices_have_short_indices_and_many_have_long_ones(rows: int, component: int) -> None:
    mesh = grid(rows, 3)
    asset = asset_of(with_meshes(mesh, grid(2, 2)))
    (primitive,) = asset.primitives("m0")
    assert asset.json["accessors"][primitive["indices"]]["componentType"] == component
    assert np.array_equal(asset.values(primitive["indices"]).reshape(-1, 3), mesh.faces)
    small = asset.primitives("m1")[0]["indices"]
    assert asset.json["accessors"][small]["componentType"] == 5123


def test_only_what_is_translucent_is_blended() -> None:
    items = [{"id": "clear", "material": "glass"}, {"id": "solid", "material": "metal"}]
    asset = asset_of(scene_of(program_of(items=items)))

    def material(name: str) -> dict[str, Any]:
        return dict(asset.json["materials"][asset.primitives(name)[0]["material"]])

    assert material("clear")["alphaMode"] == "BLEND"
    assert "alphaMode" not in material("solid")


def test_an_empty_scene_has_no_empty_lists_and_no_buffer() -> None:
    asset = asset_of(scene_of(program_of(items=[])))
    assert asset.buffer == b""
    assert not {"meshes", "materials", "accessors", "bufferViews", "buffers"} & set(asset.json)


def test_numbers_that_json_lacks_become_null() -> None:
    scene = scene_of(three_items())
    odd = replace(node_named(scene, "x"), extras={"data": [float("nan"), float("inf")]})
    asset = asset_of(replace(scene, nodes=(odd,)))
    assert asset.node("x")["extras"] == {"data": [None, None]}


def test_large_numbers_of_the_editors_own_keep_every_digit() -> None:
    data = {"serial": 10**40 + 1}
    scene = scene_of(program_of(items=[{"id": "x", "data": data}]))
    assert asset_of(scene).node("x")["extras"]["data"] == data


def test_both_formats_hold_the_same() -> None:
    scene = scene_of(three_items())
    binary, text = (read(write(scene)) for write, read in WAYS)
    assert binary.buffer == text.buffer
    text.json["buffers"][0].pop("uri")
    assert binary.json == text.json


def test_the_same_program_gives_the_same_bytes() -> None:
    assert write_glb(scene_of(three_items())) == write_glb(scene_of(three_items()))
