"""What every room's tests share."""

from __future__ import annotations

import ast
import os
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import settings

from tests import parsing
from tests.service import Service, running_service

# How long an example takes says more about what else the machine does than about the code.
settings.register_profile("untimed", deadline=None)
settings.load_profile("untimed")

# Python may keep what it compiles, whatever is usual on this machine: else each process that runs
# tests rewrites all their assertions anew, which takes a dozen seconds.
sys.dont_write_bytecode = False
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)

# Where the machine's Node.js is too old, the virtual environment has one.
os.environ["PATH"] = os.pathsep.join([str(Path(sys.executable).parent), os.environ["PATH"]])

if parsing.IS_AFFECTED:
    ast.parse = parsing.parse_without_collecting

LONG = (
    *("cluster", "editor", "shelf", "jobs_survive", "examples", "jobs", "stored_under_stress"),
    *("react_flow", "playground", "under_load", "survival", "typescript_client", "viewer", "pages"),
    *("executor", "health", "load", "python_client", "films", "draft", "answering", "offline"),
)
"""Tests of these take the longest together. They begin first, so that at the end no processor is
left alone with one of them."""


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Order files of tests; within a file all stays as it is."""
    places = {f"test_{name}.py": place for place, name in enumerate(LONG)}
    items.sort(key=lambda item: places.get(item.path.name, len(LONG)))


@pytest.fixture(scope="session")
def usual_service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Service]:
    """The service as it is by default, for all who need no other."""
    with running_service(tmp_path_factory.mktemp("service"), workers=2) as running:
        yield running


def require(condition: object, reason: str) -> None:
    """Skip the test where this machine lacks something; where CI is true, fail it instead."""
    if condition:
        return
    if os.environ.get("CI", "").lower() == "true":
        pytest.fail(f"CI has everything, but: {reason}")
    pytest.skip(reason)
