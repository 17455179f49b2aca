"""A viewer whose service goes away says so, keeps its picture, and comes back by itself."""

from __future__ import annotations

import subprocess
from pathlib import Path

from tests.browser.conftest import SCRIPTS, environment
from tests.clients.ports import free_port
from tests.service import SMALL, running_service


class Watched:
    """The script that looks at the viewers."""

    def __init__(self, url: str) -> None:
        self.process = subprocess.Popen(
            ["node", str(SCRIPTS / "offline.mjs")],
            env=environment(url),
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )

    def hear(self) -> str:
        """What it says next."""
        assert self.process.stdout
        return self.process.stdout.readline().strip()

    def ask(self, step: str) -> None:
        """Have it look; it says so once it has seen what it should."""
        assert self.process.stdin
        self.process.stdin.write(f"{step}\n")
        self.process.stdin.flush()
        assert self.hear() == step


def test_a_viewer_outlives_its_service(tmp_path: Path) -> None:
    port = free_port()
    with running_service(tmp_path, port=port) as service:
        with service.client() as client:
            assert client.put("/v1/programs/kept", json=SMALL).status_code == 201
        watched = Watched(service.url)
        try:
            assert watched.hear() == "shown"
            service.process.kill()
            service.process.wait()
            watched.ask("away")
        except BaseException:
            watched.process.kill()
            raise
    with running_service(tmp_path, port=port) as service, service.client() as client:
        watched.ask("back")
        edit = {"type": "add_item", "item": {"id": "more"}}
        assert client.post("/v1/programs/kept/edits", json={"edits": [edit]}).status_code == 200
        watched.ask("edited")
        watched.process.communicate(timeout=60)
        assert watched.process.returncode == 0
