"""Every example, from its document to glTF and into other people's readers."""

from __future__ import annotations

from pathlib import Path

import pytest

from app.formats import registry
from app.output.gltf import write_glb, write_gltf
from app.settings import Settings
from app.staging import make_scene
from tests.output.node_tools import load, validate

EXAMPLES = Path(__file__).parents[2] / "examples"
DOCUMENTS = sorted(EXAMPLES.rglob("*.json"))


def test_there_are_examples() -> None:
    assert len(DOCUMENTS) >= 5


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: str(path.relative_to(EXAMPLES)))
def test_an_example_opens_everywhere(document: Path, tmp_path: Path) -> None:
    folder = document.parent.name
    source = folder if folder in registry.FORMATS else "tubeloom"
    program = registry.read(source, document.read_bytes(), Settings())
    scene = make_scene(program, aspect=4 / 3)
    files = [tmp_path / "scene.glb", tmp_path / "scene.gltf"]
    files[0].write_bytes(write_glb(scene))
    files[1].write_bytes(write_gltf(scene))

    for report in validate(files):
        messages = [one for one in report["issues"]["messages"] if one["code"] != "NODE_EMPTY"]
        assert messages == []

    items = [("item", item.id) for item in program.items]
    hyperedges = [("hyperedge", hyperedge.id) for hyperedge in program.hyperedges]
    for found in load(files):
        named = [
            (one["data"]["shows"], one["name"]) for one in found["objects"] if "id" in one["data"]
        ]
        assert sorted(named) == sorted(items + hyperedges)
        assert all(one["triangles"] for one in found["objects"] if "id" in one["data"])
