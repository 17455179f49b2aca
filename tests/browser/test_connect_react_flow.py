"""What the page on connecting an editor shows for React Flow, compiled and driven."""

from __future__ import annotations

import json
from pathlib import Path

from tests.browser.conftest import run_script
from tests.browser.test_connect_your_editor import block, served
from tests.clients.ports import free_port
from tests.clients.typescript_package import require_node, run
from tests.service import running_service

PAGES = Path(__file__).parents[2] / "app" / "web"
AROUND = Path(__file__).with_name("react_flow")
"""A page around the block, how it is built, and what is done on it."""


def laid_out(folder: Path, service: str) -> None:
    """Lay out the block and the page around it, as a project of its own, checked and built."""
    around = {path.name: path.read_text() for path in AROUND.iterdir()}
    for name, text in {**around, "editor.tsx": block("tsx")}.items():
        meant = text.replace("http://127.0.0.1:8000", service).replace("PAGES", str(PAGES))
        (folder / name).write_text(meant)
    (folder / "node_modules").symlink_to(PAGES / "node_modules")
    options = {"types": ["vite/client"]}  # as in any project of Vite's
    checked = {"extends": str(PAGES / "tsconfig.json"), "include": ["*.tsx"]}
    (folder / "tsconfig.json").write_text(json.dumps({**checked, "compilerOptions": options}))
    tools = PAGES / "node_modules" / ".bin"
    run(str(tools / "tsc"), folder=folder)
    run(str(tools / "vite"), "build", "--logLevel", "warn", folder=folder)


def test_the_editor_of_react_flow_works_as_it_is_written(tmp_path: Path) -> None:
    require_node()
    port = free_port()
    with running_service(tmp_path, cors_origins=f"http://127.0.0.1:{port}") as service:
        folder = tmp_path / "editor"
        folder.mkdir()
        laid_out(folder, service.url)
        with served(folder / "built", port) as url:
            run_script(AROUND / "drive.mjs", service.url, EDITOR_URL=url)
