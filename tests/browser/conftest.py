"""One real service for all that browsers do, and node to drive them."""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.children import run_node_tests
from tests.conftest import require
from tests.service import Service, running_service

SCRIPTS = Path(__file__).parents[1] / "node" / "browser"


@pytest.fixture(scope="session")
def service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Service]:
    """A service with its pages."""
    with running_service(tmp_path_factory.mktemp("service")) as running:
        yield running


def environment(url: str) -> dict[str, str]:
    """What the scripts go by: which browser, and which service. Skips where there is none."""
    chromium = shutil.which("chromium")
    require(chromium, "Chromium is not installed: apt-get install chromium")
    require(shutil.which("node"), "node is not installed: apt-get install nodejs npm")
    return {**os.environ, "TUBELOOM_URL": url, "CHROMIUM": str(chromium)}


def run_script(name: str | Path, url: str, **further: str) -> None:
    """Run a script of tests by node's own test runner, with ``further`` in its environment."""
    run_node_tests(SCRIPTS / name, {**environment(url), **further})
