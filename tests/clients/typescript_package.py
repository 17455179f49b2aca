"""The package for TypeScript, and scripts that use it."""

from __future__ import annotations

import json
import shutil
from collections.abc import Mapping
from pathlib import Path

from tests import children
from tests.conftest import require

PACKAGE = Path(__file__).parents[2] / "clients" / "typescript"
COMPILER = PACKAGE.parents[1] / "app" / "web" / "node_modules" / ".bin" / "tsc"
"""The one that checks the pages; it takes a tenth of the time of the package's own."""

DRIVERS = Path(__file__).with_name("typescript")


def can_run() -> bool:
    """Whether there is what it takes."""
    return bool(shutil.which("node")) and (PACKAGE / "node_modules").exists() and COMPILER.exists()


def require_node() -> None:
    """Skip the test where there is not."""
    require(can_run(), "install node, and run `make setup-dev`")


def tool(name: str) -> str:
    """A program of the package's that it is made with."""
    return str(PACKAGE / "node_modules" / ".bin" / name)


def run(*command: str, folder: Path | None = None) -> str:
    """What a command writes; it must succeed."""
    done = children.run(command, cwd=folder)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def installed(folder: Path, scripts: Mapping[str, str]) -> None:
    """Install the package in ``folder`` as npm would, and compile scripts that use it."""
    require_node()
    package = folder / "node_modules" / "tubeloom-client"
    package.mkdir(parents=True)
    shutil.copy(PACKAGE / "package.json", package)
    run(str(COMPILER), "--project", str(PACKAGE), "--outDir", str(package / "dist"))
    for name, text in scripts.items():
        (folder / name).write_text(text)
    options = json.loads((PACKAGE / "tsconfig.json").read_text())["compilerOptions"]
    options |= {"rootDir": ".", "outDir": ".", "declaration": False}
    wanted = {"compilerOptions": options, "include": ["*.ts"], "exclude": []}
    (folder / "tsconfig.json").write_text(json.dumps(wanted))
    (folder / "package.json").write_text('{"type": "module"}')
    run(str(COMPILER), folder=folder)
