"""Every example, from its document to glTF and into other people's readers."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest

from app.formats import registry
from app.output.gltf import write_glb, write_gltf
from app.program.model import Program
from app.settings import Settings
from app.staging import make_scene
from tests.output.node_tools import load, validate

EXAMPLES = Path(__file__).parents[2] / "examples"
DOCUMENTS = sorted(EXAMPLES.rglob("*.json"))


def test_there_are_examples() -> None:
    assert len(DOCUMENTS) >= 5


@dataclass(frozen=True)
class Opened:
    """An example, and what others found in it, as GLB and as glTF."""

    program: Program
    reports: list[dict[str, Any]]
    scenes: list[dict[str, Any]]


@pytest.fixture(scope="module")
def opened(tmp_path_factory: pytest.TempPathFactory) -> dict[Path, Opened]:
    """Every example; each reader starts only once, for all of them."""
    folder = tmp_path_factory.mktemp("scenes")
    programs: list[Program] = []
    files: list[Path] = []
    for number, document in enumerate(DOCUMENTS):
        source = document.parent.name if document.parent.name in registry.FORMATS else "tubeloom"
        programs.append(registry.read(source, document.read_bytes(), Settings()))
        scene = make_scene(programs[-1], aspect=4 / 3)
        files += [folder / f"{number}.glb", folder / f"{number}.gltf"]
        files[-2].write_bytes(write_glb(scene))
        files[-1].write_bytes(write_gltf(scene))
    reports, scenes = validate(files), load(files)
    return {
        document: Opened(program, reports[2 * k : 2 * k + 2], scenes[2 * k : 2 * k + 2])
        for k, (document, program) in enumerate(zip(DOCUMENTS, programs, strict=True))
    }


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: str(path.relative_to(EXAMPLES)))
def test_an_example_opens_everywhere(document: Path, opened: dict[Path, Opened]) -> None:
    example = opened[document]
    assert len(example.reports) == len(example.scenes) == 2
    for report in example.reports:
        messages = [one for one in report["issues"]["messages"] if one["code"] != "NODE_EMPTY"]
        assert messages == []

    items = [("item", item.id) for item in example.program.items]
    hyperedges = [("hyperedge", hyperedge.id) for hyperedge in example.program.hyperedges]
    for found in example.scenes:
        named = [
            (one["data"]["shows"], one["name"]) for one in found["objects"] if "id" in one["data"]
        ]
        assert sorted(named) == sorted(items + hyperedges)
        assert all(one["triangles"] for one in found["objects"] if "id" in one["data"])
