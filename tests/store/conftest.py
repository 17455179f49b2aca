"""One PostgreSQL for all tests of what is stored."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from tests.postgres import Postgres, running_postgres


@pytest.fixture(scope="session")
def postgres() -> Iterator[Postgres]:
    """A server; each file of tests has tables of its own in it, which it empties."""
    with running_postgres() as server:
        yield server
