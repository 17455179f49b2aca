"""Every document that we can read, ours and other people's, from beginning to end."""

import json
from pathlib import Path

import numpy as np
import pytest

from app.formats.registry import read
from app.program.model import Program
from app.settings import Settings
from app.staging import make_scene

ROOT = Path(__file__).parents[2]
DOCUMENTS = [
    *((path, "tubeloom") for path in sorted((ROOT / "examples").glob("*.json"))),
    *(
        (path, name)
        for name in ("yosys", "hif")
        for path in sorted((ROOT / "examples" / name).glob("*.json"))
    ),
]


@pytest.fixture(params=DOCUMENTS, ids=lambda param: param[0].stem)
def program(request: pytest.FixtureRequest) -> Program:
    path, name = request.param
    return read(name, path.read_bytes(), Settings())


def test_a_document_becomes_a_scene_that_shows_all_of_it(program: Program) -> None:
    scene = make_scene(program, aspect=4 / 3)
    shown = [node.extras["id"] for node in scene.nodes if node.shows != "ground"]
    assert sorted(shown) == sorted(
        part.id for parts in (program.items, program.hyperedges) for part in parts
    )
    for node in scene.nodes:
        for primitive in node.primitives:
            assert np.isfinite(primitive.mesh.vertices).all()
            assert np.isfinite(primitive.mesh.normals).all()


def test_the_second_clause_of_the_paper_has_9_hyperedges_and_21_segments() -> None:
    document = json.loads((ROOT / "examples" / "id3-clause-2.json").read_text())
    document["layout"] = {"fidelity": "paper"}
    program = read("tubeloom", json.dumps(document).encode(), Settings())
    assert len(program.hyperedges) == 9
    assert sum(2 * len(edge.attachments) - 3 for edge in program.hyperedges) == 21
