"""The page on connecting an editor, followed to the letter."""

from __future__ import annotations

import re
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from tests.browser.conftest import run_script
from tests.clients.ports import free_port
from tests.service import end, running_service

PAGE = Path(__file__).parents[2] / "docs" / "connect-your-editor.md"


def block(language: str) -> str:
    """The first fenced block of a language on the page."""
    found = re.search(rf"^```{language}\n(.*?)^```", PAGE.read_text(), re.MULTILINE | re.DOTALL)
    assert found
    return found[1]


@contextmanager
def served(folder: Path, port: int) -> Iterator[str]:
    """The folder, by the server that the page names."""
    command = [sys.executable, "-m", "http.server", str(port), "--bind", "127.0.0.1"]
    server = subprocess.Popen(command, cwd=folder, stderr=subprocess.DEVNULL)
    try:
        yield f"http://127.0.0.1:{port}"
    finally:
        end(server)


def test_the_page_of_an_editor_works_as_it_is_written(tmp_path: Path) -> None:
    assert "TUBELOOM_CORS_ORIGINS=http://127.0.0.1:9000" in block("sh")
    port = free_port()
    origin = f"http://127.0.0.1:{port}"
    (tmp_path / "editor").mkdir()
    with running_service(tmp_path, cors_origins=origin) as service:
        page = block("html").replace("http://127.0.0.1:8000", service.url)
        (tmp_path / "editor" / "index.html").write_text(page)
        with served(tmp_path / "editor", port) as url:
            run_script("connect.mjs", service.url, EDITOR_URL=url)
