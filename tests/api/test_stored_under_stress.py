"""Stored programs where writers race, the service is killed, and many watch; small here.

``python -m benchmarks.writers`` and ``python -m benchmarks.viewers`` do the same at length.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from benchmarks.viewers import measure
from benchmarks.writers import race, survive
from tests.postgres import Postgres, running_postgres
from tests.service import running_service


@pytest.fixture(scope="module")
def postgres() -> Iterator[Postgres]:
    with running_postgres() as server:
        yield server


@pytest.mark.parametrize("kind", ["sqlite", "postgresql"])
def test_no_change_of_two_writers_gets_lost(
    kind: str, request: pytest.FixtureRequest, tmp_path: Path
) -> None:
    url = f"sqlite:///{tmp_path / 'race.db'}"
    if kind == "postgresql":
        url = request.getfixturevalue("postgres").url
    with running_service(tmp_path, workers=1, database=url) as service:
        outcome = race(service, 40)
    assert (outcome.count, outcome.revisions) == (40, 41)


@pytest.mark.parametrize("kind", ["sqlite", "postgresql"])
def test_what_was_acknowledged_outlives_the_service(
    kind: str, request: pytest.FixtureRequest
) -> None:
    url = request.getfixturevalue("postgres").url if kind == "postgresql" else None
    outcome = survive(24, 1, url)
    assert outcome.acknowledged > 8
    assert (outcome.lost, outcome.broken) == (0, 0)


def test_every_viewer_hears_of_every_revision() -> None:
    outcome = measure(viewers=60, seconds=3.0, rate=8.0)
    assert outcome.incomplete == 0
    assert outcome.returned == 1
    assert np.isfinite(outcome.since_sent).all()
