from __future__ import annotations

import io
import zipfile
from dataclasses import replace
from xml.etree import ElementTree as ET

import numpy as np
import trimesh

from app.arrays import Floats, Indices
from app.output.shells import shells
from app.output.threemf import write_3mf
from app.scene.scene import Scene
from tests.output.scenes import box, matte, node, scene
from tests.output.test_shells import BOXES, printed_scene

CORE = "{http://schemas.microsoft.com/3dmanufacturing/core/2015/02}"


def model_of(data: bytes) -> ET.Element:
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        assert archive.testzip() is None
        assert archive.namelist()[0] == "[Content_Types].xml"
        return ET.fromstring(archive.read("3D/3dmodel.model"))


def named_objects(model: ET.Element) -> dict[str | None, ET.Element]:
    return {found.get("name"): found for found in model.iter(f"{CORE}object")}


def arrays(found: ET.Element) -> tuple[Floats, Indices]:
    vertices = [[float(v.attrib[axis]) for axis in "xyz"] for v in found.iter(f"{CORE}vertex")]
    faces = [[int(t.attrib[f"v{k}"]) for k in (1, 2, 3)] for t in found.iter(f"{CORE}triangle")]
    return np.array(vertices), np.array(faces)


def colors(model: ET.Element) -> list[str | None]:
    return [base.get("displaycolor") for base in model.iter(f"{CORE}base")]


def color_of(model: ET.Element, name: str) -> str | None:
    return colors(model)[int(named_objects(model)[name].attrib["pindex"])]


def test_parts_carry_the_ids_and_colours_of_what_they_show() -> None:
    document = {
        "items": [{"id": "x", "color": "#ff8000", "material": "matte"}, {"id": "y"}],
        "hyperedges": [
            {
                "id": "e",
                "color": "#2563eb",
                "material": "glass",
                "attachments": [{"item": "x"}, {"item": "y"}],
            }
        ],
    }
    model = model_of(write_3mf(printed_scene(document)))
    assert {"x", "y", "e"} < set(named_objects(model))
    assert color_of(model, "x") == "#FF8000FF"
    assert color_of(model, "e") == "#2563EB59"


def test_all_parts_are_components_of_one_object() -> None:
    model = model_of(write_3mf(BOXES))
    (item,) = model.iter(f"{CORE}item")
    whole = next(o for o in model.iter(f"{CORE}object") if o.get("id") == item.get("objectid"))
    assert whole.get("name") == BOXES.name
    parts = [found.get("objectid") for found in whole.iter(f"{CORE}component")]
    objects = named_objects(model)
    assert parts == [objects["a"].get("id"), objects["b"].get("id")]
    assert model.get("unit") == "millimeter"


def test_triangles_are_those_of_the_shells_to_the_bit() -> None:
    objects = named_objects(model_of(write_3mf(BOXES, scale=3.3)))
    for shell in shells(BOXES, "all", 3.3):
        vertices, faces = arrays(objects[shell.name])
        np.testing.assert_array_equal(vertices.astype(np.float32), shell.vertices)
        np.testing.assert_array_equal(faces, shell.faces)
        assert trimesh.Trimesh(vertices, faces).is_watertight


def odd_names() -> Scene:
    found = scene([node('<"&\x00\ud800>', box(1, 1, 1), 0)], [matte("#000000")])
    return replace(found, name="<b>\x01")


def test_any_name_is_written() -> None:
    model = model_of(write_3mf(odd_names()))
    assert '<"&\ufffd\ufffd>' in named_objects(model)
    (title,) = model.iter(f"{CORE}metadata")
    assert title.text == "<b>\ufffd"


def test_nothing_is_a_model_without_objects() -> None:
    model = model_of(write_3mf(scene([], [matte("#000000")], ground=False)))
    assert not list(model.iter(f"{CORE}object"))
    assert len(list(model.iter(f"{CORE}build"))) == 1


def test_the_same_scene_has_the_same_bytes() -> None:
    assert write_3mf(BOXES) == write_3mf(BOXES)
