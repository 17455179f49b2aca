from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any, get_args

import numpy as np
import pytest

from app.output.gltf import write_glb, write_gltf
from app.output.gltf_materials import Depth, chord_of, extensions_of, material_text
from app.output.gltf_packing import Packing
from app.output.gltf_textures import texture_file
from app.output.media import Compression
from app.program.model import MaterialName, Program
from app.scene.materials import Look, make_material
from app.scene.scene import Scene
from app.scene.textures import MEAN
from app.solids.mesh import Mesh
from app.solids.meshing import mesh_of
from app.solids.solid import Box, Cylinder, Sphere, Tray
from app.staging import make_scene
from tests.output.gltf_reader import Asset
from tests.output.node_tools import load, validate

MATERIALS: tuple[MaterialName, ...] = get_args(MaterialName)
WAYS: tuple[Compression, ...] = get_args(Compression)
SHAPES: tuple[dict[str, Any], ...] = (
    {"type": "box", "size": [1, 1, 1]},
    {"type": "tray", "size": [1.4, 1.2, 0.4]},
    {"type": "sphere", "radius": 0.5},
    {"type": "cylinder", "radius": 0.5, "height": 1},
    {"type": "cone", "radius": 0.5, "height": 1},
    {"type": "arrow", "length": 1.2, "radius": 0.3},
    {"type": "text", "height": 0.5, "depth": 0.2},
)


def scene_in(*materials: MaterialName, **style: Any) -> Scene:
    """Every shape in each of these materials, and a hyperedge in each."""
    items = [
        {
            "id": f"{material} {shape['type']}",
            "label": "Rg",
            "shape": shape,
            "material": material,
            "position": [2 * column, 3 * row, 0],
        }
        for row, material in enumerate(materials)
        for column, shape in enumerate(SHAPES)
    ]
    hyperedges = [
        {
            "id": f"{material} tube",
            "material": material,
            "color": "#c8603c",
            "attachments": [{"item": f"{material} {kind}"} for kind in ("box", "sphere", "cone")],
        }
        for material in materials
    ]
    program = {"items": items, "hyperedges": hyperedges, "style": style}
    return make_scene(Program.model_validate(program), 4 / 3)


def written(material: MaterialName | Look, depth: Depth | None = None) -> dict[str, Any]:
    text = material_text(make_material(material, "#4488cc"), depth, {"wood": 0, "stone": 1})
    found: dict[str, Any] = json.loads(text)
    return found


@pytest.fixture(scope="module")
def everything() -> Scene:
    return scene_in(*MATERIALS)


@pytest.mark.parametrize("compress", WAYS)
def test_every_material_on_every_shape_opens_everywhere(
    everything: Scene, compress: Compression, tmp_path: Path
) -> None:
    files = []
    for merge in (False, True):
        for write, ending in ((write_glb, "glb"), (write_gltf, "gltf")):
            files.append(tmp_path / f"{merge}.{ending}")
            files[-1].write_bytes(write(everything, Packing(compress=compress, merge=merge)))
    # The validator does not look inside meshopt's compression, nor at whose vertices are whose.
    unheard_of = {"UNSUPPORTED_EXTENSION", "UNUSED_OBJECT"}
    for report in validate(files):
        issues = report["issues"]
        assert [one for one in issues["messages"] if one["code"] not in unheard_of] == []
        assert (issues["numErrors"], issues["numWarnings"]) == (0, 0)
    for found in load(files):
        assert found["warnings"] == []
        shown = [one["material"] for one in found["objects"] if one["material"] is not None]
        assert {one["texture"] for one in shown} == {None, 0, 1}
        assert {one["transmission"] for one in shown} == {0, 1}
        assert "MeshBasicMaterial" in {one["type"] for one in shown}
        assert {one["clearcoat"] for one in shown if one["texture"] == 0} == {0.3}


def test_extensions_are_named_where_they_are_used_and_nowhere_else(everything: Scene) -> None:
    names = {
        "plastic": set(),
        "metal": set(),
        "matte": set(),
        "stone": set(),
        "glass": {"KHR_materials_transmission", "KHR_materials_volume"},
        "wood": {"KHR_materials_clearcoat"},
        "plain": {"KHR_materials_unlit"},
    }
    assert set(names) == set(MATERIALS)
    for material in MATERIALS:
        asset = Asset.from_glb(write_glb(scene_in(material)))
        used = set(asset.json["extensionsUsed"]) - {"KHR_lights_punctual"}
        assert used == names[material]
        assert "extensionsRequired" not in asset.json, "whoever does not know them sees something"
        assert ("images" in asset.json) == (material in {"wood", "stone"})
    used = Asset.from_glb(write_glb(everything)).json["extensionsUsed"]
    assert set(used) == {"KHR_lights_punctual"}.union(*names.values())
    assert len(used) == len(set(used))


@pytest.mark.parametrize("compress", WAYS)
def test_a_texture_is_stored_once_and_found_by_its_coordinates(
    everything: Scene, compress: Compression
) -> None:
    asset = Asset.from_glb(write_glb(everything, Packing(compress=compress)))
    assert [image["name"] for image in asset.json["images"]] == ["wood", "stone"]
    for image in asset.json["images"]:
        view = asset.json["bufferViews"][image["bufferView"]]
        start = view.get("byteOffset", 0)
        content = bytes(asset.buffer[start : start + view["byteLength"]])
        assert content == texture_file(image["name"])
    for node in everything.nodes:
        primitives = asset.primitives(node.name)
        for part, primitive in zip(node.primitives, primitives, strict=True):
            material = asset.json["materials"][primitive["material"]]
            texture = everything.materials[part.material].texture
            shown = material["pbrMetallicRoughness"].get("baseColorTexture")
            assert ("TEXCOORD_0" in primitive["attributes"]) == (texture is not None)
            if texture is None:
                assert shown is None
                continue
            assert asset.json["images"][shown["index"]]["name"] == texture
            found = asset.values(primitive["attributes"]["TEXCOORD_0"])
            assert part.mesh.coordinates is not None
            assert np.array_equal(found, part.mesh.coordinates)


def test_merged_hyperedges_keep_their_grain_as_nodes_of_their_own(everything: Scene) -> None:
    asset = Asset.from_glb(write_glb(everything, Packing(merge=True)))
    names = {node["name"] for node in asset.json["nodes"]}
    assert {"wood tube", "stone tube"} <= names
    assert not {"plastic tube", "glass tube", "plain tube"} & names


def test_a_textured_material_on_a_mesh_without_coordinates_goes_bare(tmp_path: Path) -> None:
    scene = scene_in("wood", labels=False, ground=False)
    nodes = [
        replace(
            node,
            primitives=tuple(
                replace(part, mesh=replace(part.mesh, coordinates=None)) for part in node.primitives
            ),
        )
        for node in scene.nodes
    ]
    file = tmp_path / "bare.glb"
    file.write_bytes(write_glb(replace(scene, nodes=tuple(nodes))))
    (report,) = validate([file])
    assert report["issues"]["messages"] == []
    asset = Asset.from_glb(file.read_bytes())
    assert "images" not in asset.json
    assert len(asset.json["materials"]) == 2, "of the solids, and of the tube"


def test_the_tint_of_textures_makes_up_for_their_mean() -> None:
    plain, wood = (written(name)["pbrMetallicRoughness"] for name in ("matte", "wood"))
    assert plain["baseColorFactor"][:3] == pytest.approx(
        np.multiply(wood["baseColorFactor"][:3], MEAN)
    )
    assert wood["baseColorTexture"] == {"index": 0}


def test_glass_is_seen_through_by_all_and_bends_light_for_those_who_can() -> None:
    found = written("glass", Depth(0.5))
    assert found["alphaMode"] == "BLEND"
    assert found["pbrMetallicRoughness"]["baseColorFactor"][3] == pytest.approx(0.35**0.5)
    assert found["extensions"]["KHR_materials_transmission"] == {"transmissionFactor": 1.0}
    volume = found["extensions"]["KHR_materials_volume"]
    assert (volume["thicknessFactor"], volume["attenuationDistance"]) == (0.5, 0.5)
    tinted = np.multiply(
        found["pbrMetallicRoughness"]["baseColorFactor"][:3], volume["attenuationColor"]
    )
    assert tinted == pytest.approx(make_material("glass", "#4488cc").base_color[:3])


def test_glass_without_depth_is_a_film_of_its_whole_colour() -> None:
    found = written("glass")
    assert list(found["extensions"]) == ["KHR_materials_transmission"]
    color = found["pbrMetallicRoughness"]["baseColorFactor"][:3]
    assert color == pytest.approx(make_material("glass", "#4488cc").base_color[:3])


def test_glass_lets_through_what_is_asked_for() -> None:
    found = written(Look("glass", translucency=0.75), Depth(1.0))
    assert found["extensions"]["KHR_materials_transmission"] == {"transmissionFactor": 0.75}
    assert found["pbrMetallicRoughness"]["baseColorFactor"][3] == pytest.approx(0.5)


def test_another_ior_than_the_usual_one_is_said() -> None:
    water = replace(make_material("glass", "#fff"), ior=1.33)
    assert "KHR_materials_ior" in extensions_of(water, None)
    assert json.loads(material_text(water, None, {}))["extensions"]["KHR_materials_ior"] == {
        "ior": 1.33
    }


def test_plain_is_unlit_and_wood_is_coated() -> None:
    assert written("plain")["extensions"] == {"KHR_materials_unlit": {}}
    coat = written(Look("wood", "shiny"))["extensions"]["KHR_materials_clearcoat"]
    assert coat == {"clearcoatFactor": 0.3, "clearcoatRoughnessFactor": 0.03}
    assert "extensions" not in written("plastic")


@pytest.mark.parametrize(
    ("solid", "chord"),
    [
        (Sphere(0.75), 1.0),
        (Box((1.0, 1.0, 1.0), 0.0), 2 / 3),
        (Box((100.0, 100.0, 0.1), 0.0), 0.2),
        (Cylinder(0.1, 100.0, 0.0), 0.2),
    ],
)
def test_light_goes_through_a_solid_for_its_mean_chord(
    solid: Box | Sphere | Cylinder, chord: float
) -> None:
    assert chord_of(mesh_of(solid)) == pytest.approx(chord, rel=0.04)


def test_light_goes_through_the_walls_of_a_tray_not_through_its_hollow() -> None:
    assert chord_of(mesh_of(Tray((2.0, 2.0, 1.0), 0.1, 0.1))) < 0.3


def test_light_goes_nowhere_in_a_flat_mesh() -> None:
    point = np.zeros((3, 3), dtype=np.float32)
    assert chord_of(Mesh(point, point, np.array([[0, 1, 2]], dtype=np.uint32))) == 0


@pytest.mark.parametrize("compress", WAYS)
def test_the_thickness_of_glass_does_not_depend_on_how_it_is_stored(
    compress: Compression,
) -> None:
    """It is scaled with its node, which is how 16 bits number positions; the distance is not."""
    asset = Asset.from_glb(write_glb(scene_in("glass"), Packing(compress=compress)))
    (primitive,) = asset.primitives("glass tube")
    volume = asset.json["materials"][primitive["material"]]["extensions"]["KHR_materials_volume"]
    scale = asset.node("glass tube").get("scale", [1.0])[0]
    assert volume["thicknessFactor"] * scale == pytest.approx(volume["attenuationDistance"])
    assert (scale == 1.0) == (compress == "none")
    cube, ball = (
        asset.json["materials"][asset.primitives(f"glass {kind}")[0]["material"]]
        for kind in ("box", "sphere")
    )
    assert cube["name"] == ball["name"]
    assert cube != ball, "a cube is as deep as a cube, a ball as a ball"
