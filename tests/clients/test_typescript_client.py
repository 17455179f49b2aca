"""The client for TypeScript, compiled strictly, against the real service."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests import children
from tests.clients.documented import blocks, meant_for
from tests.clients.ports import free_port
from tests.clients.typescript_package import PACKAGE, run, tool
from tests.service import Service


def test_the_calls_that_everyone_needs(drivers: Path, service: Service) -> None:
    posted, stored, jobs = json.loads(run("node", "calls.js", service.url, folder=drivers))
    assert posted["items"] == ["x", "y", "z"]
    assert len(posted["segments"]) == 1
    assert (posted["picture"], posted["scene"]) == ("PNG", "glTF")
    assert posted["bad"] == [422, "inconsistent-document", ["/items/1/id"]]
    assert stored == {
        "missing": 404,
        "again": 412,
        "late": 412,
        "added": ["w"],
        "digests": [True, True],
        "name": ["Typed", "Typed"],
        "items": ["x", "y", "z"],
        "revisions": [5, 4, 3, 2, 1],
        "delta": "glTF",
        "happenings": [*(["revision", number] for number in range(2, 6)), ["deleted", 6]],
    }
    assert jobs == {
        "made": "PNG",
        "same": True,
        "end": ["done", 1],
        "failed": "inconsistent-document",
        "stopped": ["Error: enough", "cancelled"],
    }


@pytest.mark.parametrize("number", range(len(blocks("ts"))))
def test_what_the_page_on_clients_shows_is_run_as_it_stands_there(
    number: int, drivers: Path, service: Service
) -> None:
    script = drivers / f"meant{number}.js"
    script.write_text(meant_for(service, (drivers / f"block{number}.js").read_text()))
    said = children.run(["node", script.name], cwd=drivers)
    assert said.returncode == 0, said.stderr
    assert said.stdout


def test_a_wrong_key_is_a_problem_and_silence_an_error(
    drivers: Path, guarded: tuple[Service, str]
) -> None:
    nobody = f"http://127.0.0.1:{free_port()}"
    said = run("node", "keys.js", guarded[0].url, nobody, folder=drivers)
    assert json.loads(said) == ["401", "TypeError"]


def test_its_types_are_those_of_the_interface(
    drivers: Path, service: Service, tmp_path: Path
) -> None:
    assert drivers
    with service.client() as client:
        (tmp_path / "openapi.json").write_bytes(client.get("/openapi.json").content)
    made = tmp_path / "schema.ts"
    options = json.loads((PACKAGE / "package.json").read_text())["scripts"]["generate"].split()
    words = [word for word in options[1:] if word.startswith("--") and word != "--output"]
    run(tool(options[0]), str(tmp_path / "openapi.json"), *words, "--output", str(made))
    kept = (PACKAGE / "src" / "schema.ts").read_text()
    assert made.read_text() == kept, "make openapi"


def test_it_needs_nothing_at_run_time() -> None:
    package = json.loads((PACKAGE / "package.json").read_text())
    assert "dependencies" not in package
