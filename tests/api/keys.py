"""Keys for tests, made as people make them: on the command line."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path


def tubeloom(*arguments: str, data_folder: Path) -> subprocess.CompletedProcess[str]:
    """Run the command line on the data that a service there has."""
    return subprocess.run(
        [sys.executable, "-m", "app", *arguments],
        env={**os.environ, "TUBELOOM_DATA_FOLDER": str(data_folder)},
        capture_output=True,
        text=True,
        check=False,
    )


def make_key(data_folder: Path, *scopes: str, name: str = "test") -> str:
    """The secret of a new key."""
    options = [part for scope in scopes for part in ("--scope", scope)]
    done = tubeloom("keys", "create", name, *options, data_folder=data_folder)
    assert done.returncode == 0, done.stderr
    return done.stdout.strip()


def bearer(secret: str) -> dict[str, str]:
    """The headers that show a key."""
    return {"Authorization": f"Bearer {secret}"}
