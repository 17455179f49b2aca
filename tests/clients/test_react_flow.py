"""The adapter for React Flow: what can do without a browser, against the real service."""

from __future__ import annotations

import os
from contextlib import ExitStack
from pathlib import Path

import pytest

from tests.children import Child, run_node_tests
from tests.clients.ports import free_port
from tests.clients.typescript_package import installed
from tests.service import Service, running_service

ADAPTER = Path(__file__).parents[2] / "clients" / "react-flow" / "src"
DRIVERS = Path(__file__).with_name("react_flow")

WITHOUT_REACT = ("graph", "places", "program-of", "flow-of", "edits-between", "link", "waiting")

ROUNDS = int(os.environ.get("TUBELOOM_TEST_ROUNDS", "25"))


@pytest.fixture(scope="module")
def adapted(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder where the adapter and our scripts lie compiled."""
    folder = tmp_path_factory.mktemp("drivers")
    sources = [ADAPTER / f"{name}.ts" for name in WITHOUT_REACT]
    installed(folder, {path.name: path.read_text() for path in (*sources, *DRIVERS.glob("*.ts"))})
    return folder


@pytest.mark.parametrize("script", ["adapter", "linking"])
def test_by_the_test_runner_of_node(script: str, adapted: Path, usual_service: Service) -> None:
    further = {"TUBELOOM_URL": usual_service.url, "ROUNDS": str(ROUNDS)}
    run_node_tests(f"{script}.js", {**os.environ, **further}, cwd=adapted)


def test_what_is_drawn_while_the_service_is_away_is_sent_when_it_is_back(
    adapted: Path, tmp_path: Path
) -> None:
    port = free_port()
    with ExitStack() as stack:
        with running_service(tmp_path, port=port) as service:
            command = ["node", "offline.js", service.url]
            editor = stack.enter_context(Child(command, cwd=adapted))
            told = [editor.hear() for _ in range(2)]
            assert told[-1] == "saved"
            service.kill()
        assert [editor.hear() for _ in range(2)] == ["sending", "offline"]
        with running_service(tmp_path, port=port) as service:
            assert editor.rest() == ["sending", "saved"]
            with service.client() as client:
                document = client.get("/v1/programs/away").json()
    assert document["items"][0]["position"] == [3.0, 0.0, 0.25]
