"""A real browser: Debian's Chromium without a window, asked by its own protocol."""

from __future__ import annotations

import itertools
import json
import shutil
import subprocess
import urllib.request
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from websockets.sync.client import ClientConnection, connect

from tests.conftest import require
from tests.service import PATIENCE_SECONDS, end, until

FLAGS = (
    "--headless=new",
    "--no-sandbox",
    "--use-gl=angle",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--ignore-gpu-blocklist",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--no-first-run",
    "--remote-debugging-port=0",
)


@dataclass
class Page:
    """An open page."""

    socket: ClientConnection
    numbers: Iterator[int] = field(default_factory=itertools.count)

    def evaluate(self, code: str) -> Any:
        """The value of an expression, or what its promise comes to."""
        wish = {"expression": code, "awaitPromise": True, "returnByValue": True}
        answer = self._ask("Runtime.evaluate", wish)
        assert "exceptionDetails" not in answer, answer["exceptionDetails"]
        return answer["result"].get("value")

    def _ask(self, method: str, parameters: dict[str, Any]) -> dict[str, Any]:
        number = next(self.numbers)
        message = {"id": number, "method": method, "params": parameters}
        self.socket.send(json.dumps(message))
        while True:
            heard = json.loads(self.socket.recv(PATIENCE_SECONDS))
            if heard.get("id") == number:
                assert "result" in heard, heard
                result: dict[str, Any] = heard["result"]
                return result


@contextmanager
def page_of(html: str, folder: Path) -> Iterator[Page]:
    """The page in a browser, loaded from a file in ``folder``."""
    program = shutil.which("chromium")
    require(program, "Chromium is not installed: apt-get install chromium")
    file, profile = folder / "page.html", folder / "profile"
    file.write_text(html)
    browser = subprocess.Popen(
        [str(program), *FLAGS, f"--user-data-dir={profile}", file.as_uri()],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    try:
        with connect(_address(profile), max_size=None) as socket:
            page = Page(socket)
            loaded = f"location.href === {json.dumps(file.as_uri())} && document.readyState"
            until(lambda: page.evaluate(loaded) == "complete")
            yield page
    finally:
        end(browser)


def _address(profile: Path) -> str:
    """Where the page listens, once there is one."""
    note = profile / "DevToolsActivePort"

    def find() -> str | None:
        if note.exists() and (lines := note.read_text().splitlines()):
            listed = f"http://127.0.0.1:{lines[0]}/json/list"
            with urllib.request.urlopen(listed, timeout=PATIENCE_SECONDS) as response:
                for target in json.load(response):
                    if target["type"] == "page":
                        return str(target["webSocketDebuggerUrl"])
        return None

    return until(find)
