"""Stored programs where writers race, the service is killed, and many watch; small here.

``python -m benchmarks.writers`` and ``python -m benchmarks.viewers`` do the same at length.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest

from benchmarks.viewers import measure
from benchmarks.writers import Race, race, survive
from tests.postgres import Postgres, running_postgres
from tests.service import Service


@pytest.fixture(scope="module")
def postgres() -> Iterator[Postgres]:
    with running_postgres() as server:
        yield server


@pytest.mark.parametrize("kind", ["sqlite", "postgresql"])
def test_no_change_of_two_writers_gets_lost_nor_one_before_the_service_is_killed(
    kind: str, request: pytest.FixtureRequest
) -> None:
    url = request.getfixturevalue("postgres").url if kind == "postgresql" else None
    races: list[Race] = []
    outcome = survive(24, 1, url, before=lambda service: races.append(race(service, 40)))
    assert [(each.count, each.revisions) for each in races] == [(40, 41)]
    # All but one that it was killed over, and three of a program that this was to make, at worst.
    assert outcome.acknowledged >= 24 - 4
    assert (outcome.lost, outcome.broken) == (0, 0)


def test_every_viewer_hears_of_every_revision(service: Service) -> None:
    outcome = measure(service, viewers=60, seconds=3.0, rate=8.0)
    assert outcome.incomplete == 0
    assert outcome.returned == 1
    assert np.isfinite(outcome.since_sent).all()
