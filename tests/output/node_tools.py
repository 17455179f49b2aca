"""Other people's readers of glTF, in Node: Khronos' validator, and three.js."""

from __future__ import annotations

import fcntl
import json
import shutil
import subprocess
from collections.abc import Sequence
from functools import lru_cache
from pathlib import Path
from typing import Any

from tests.children import SCRIPT_SECONDS, run
from tests.conftest import require

FOLDER = Path(__file__).parents[1] / "node"


def validate(files: Sequence[Path]) -> list[dict[str, Any]]:
    """What Khronos' validator says of each file."""
    return _run("validate.mjs", files)


def load(files: Sequence[Path]) -> list[dict[str, Any]]:
    """What three.js finds in each file."""
    return _run("load.mjs", files)


def run_module(code: str, files: Sequence[Path]) -> list[dict[str, Any]]:
    """What a module prints as JSON; it finds the files' names in ``process.argv``, from 2 on."""
    return _run("-", files, code)


def _run(script: str, files: Sequence[Path], code: str = "") -> list[dict[str, Any]]:
    _install()
    done = subprocess.run(
        ["node", "--input-type=module", script, *map(str, files)]
        if code
        else ["node", script, *map(str, files)],
        cwd=FOLDER,
        input=code.encode(),
        capture_output=True,
        check=False,
        timeout=SCRIPT_SECONDS,
    )
    assert done.returncode == 0, done.stderr.decode()
    found: list[dict[str, Any]] = json.loads(done.stdout)
    return found


@lru_cache(maxsize=1)
def _install() -> None:
    """Install what `tests/node/package-lock.json` names, once, unless `make setup-dev` has."""
    require(shutil.which("node"), "Node.js is not installed: apt-get install nodejs npm")
    with (FOLDER / "package-lock.json").open() as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)  # several test processes may arrive here at once
        if _installed():
            return
        require(shutil.which("npm"), "npm is not installed: apt-get install npm")
        done = run(["npm", "ci"], cwd=FOLDER)
        require(done.returncode == 0, f"npm ci failed: {done.stderr}")


def _installed() -> bool:
    wanted = json.loads((FOLDER / "package-lock.json").read_text())["packages"]
    for folder, package in wanted.items():
        manifest = FOLDER / folder / "package.json"
        if folder and not (
            manifest.exists() and json.loads(manifest.read_text())["version"] == package["version"]
        ):
            return False
    return True
