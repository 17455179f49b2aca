"""Keys for tests, made as people make them: by the commands of the command line."""

from __future__ import annotations

from pathlib import Path

from click.testing import CliRunner, Result

from app.cli import main


def tubeloom(*arguments: str, data_folder: Path) -> Result:
    """Run a command on the data that a service there has.

    It runs in this process: to start another one takes longer than what the command does.
    """
    environment = {"TUBELOOM_DATA_FOLDER": str(data_folder)}
    return CliRunner().invoke(main, arguments, env=environment)


def make_key(data_folder: Path, *scopes: str, name: str = "test") -> str:
    """The secret of a new key."""
    options = [part for scope in scopes for part in ("--scope", scope)]
    done = tubeloom("keys", "create", name, *options, data_folder=data_folder)
    assert done.exit_code == 0, done.output
    return done.stdout.strip()


def bearer(secret: str) -> dict[str, str]:
    """The headers that show a key."""
    return {"Authorization": f"Bearer {secret}"}
