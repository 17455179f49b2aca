"""One real service for all tests of HTTP."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import httpx
import pytest

from tests.service import Service, running_service


@pytest.fixture(scope="session")
def service(usual_service: Service) -> Service:
    """The service as it is by default."""
    return usual_service


@pytest.fixture(scope="session")
def guarded_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Where the service that wants keys has its data."""
    return tmp_path_factory.mktemp("guarded")


@pytest.fixture(scope="session")
def guarded(guarded_folder: Path) -> Iterator[Service]:
    """A service that wants keys."""
    with running_service(
        guarded_folder,
        auth="required",
        cors_origins="https://a.example,https://b.example",
        key_seconds=1,
    ) as running:
        yield running


@pytest.fixture(scope="session")
def strict(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Service]:
    """A service whose limits are soon reached."""
    with running_service(
        tmp_path_factory.mktemp("strict"),
        hosts="127.0.0.1, tubes.example",
        cors_origins="https://pages.example",
        max_held_bytes=1_000_000,
        max_print_triangles=500,
        kept_revisions=3,
        max_watchers=4,
    ) as running:
        yield running


@pytest.fixture
def client(service: Service) -> Iterator[httpx.Client]:
    """A client of the service."""
    with service.client() as client:
        yield client
