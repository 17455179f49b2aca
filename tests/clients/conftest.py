"""Services and compiled scripts that all tests of clients share."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.api.keys import make_key
from tests.clients.documented import blocks
from tests.clients.typescript_package import DRIVERS, installed
from tests.service import Service, running_service


@pytest.fixture(scope="session")
def service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Service]:
    """A service that soon forgets revisions."""
    with running_service(tmp_path_factory.mktemp("service"), kept_revisions=5) as running:
        yield running


@pytest.fixture(scope="session")
def guarded(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[Service, str]]:
    """A service that wants keys and is soon asked too often; a key that is good for rendering."""
    folder = tmp_path_factory.mktemp("guarded")
    with running_service(folder, warm=False, auth="required", rate_per_key="3/2second") as running:
        yield running, make_key(folder / "data", "render")


@pytest.fixture(scope="session")
def drivers(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder where our scripts and those of the page lie compiled, beside the package."""
    folder = tmp_path_factory.mktemp("drivers")
    scripts = {path.name: path.read_text() for path in DRIVERS.glob("*.ts")}
    shown = {f"block{number}.ts": text for number, text in enumerate(blocks("ts"))}
    installed(folder, scripts | shown)
    return folder
