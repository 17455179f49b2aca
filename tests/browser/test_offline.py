"""A viewer whose service goes away says so, keeps its picture, and comes back by itself."""

from __future__ import annotations

from contextlib import ExitStack
from pathlib import Path

from tests.browser.conftest import SCRIPTS, environment
from tests.children import Child
from tests.clients.ports import free_port
from tests.service import SMALL, running_service


def ask(watched: Child, step: str) -> None:
    """Have the script look at the viewers; it says so once it has seen what it should."""
    watched.say(step)
    assert watched.hear() == step


def test_a_viewer_outlives_its_service(tmp_path: Path) -> None:
    port = free_port()
    command = ["node", str(SCRIPTS / "offline.mjs")]
    with ExitStack() as stack:
        with running_service(tmp_path, port=port) as service:
            with service.client() as client:
                assert client.put("/v1/programs/kept", json=SMALL).status_code == 201
            watched = stack.enter_context(Child(command, env=environment(service.url)))
            assert watched.hear() == "shown"
            service.kill()
            ask(watched, "away")
        with running_service(tmp_path, port=port) as service, service.client() as client:
            ask(watched, "back")
            edit = {"type": "add_item", "item": {"id": "more"}}
            assert client.post("/v1/programs/kept/edits", json={"edits": [edit]}).status_code == 200
            ask(watched, "edited")
            assert not watched.rest()
