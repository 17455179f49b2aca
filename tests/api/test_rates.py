import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from pydantic import ValidationError

from app.settings import Settings
from tests.api.keys import bearer, make_key
from tests.service import SMALL, Service, large_program, running_service


@pytest.fixture(scope="module")
def rated(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[Service, Path]]:
    folder = tmp_path_factory.mktemp("rated")
    # What was counted fades: by the hour that changes nothing while a test runs. Of work so little
    # is allowed that a large program costs many times that, be it on the quickest machine.
    with running_service(
        folder, workers=1, auth="required", rate_per_key="5/hour;100/day", budget_seconds=0.02
    ) as service:
        yield service, folder / "data"


def test_too_many_requests_are_refused_and_told_when_to_come_again(
    rated: tuple[Service, Path],
) -> None:
    service, data = rated
    first, second = make_key(data, "render", "metrics"), make_key(data, "metrics")
    with service.client() as client:
        left = []
        for _ in range(5):
            answer = client.get("/metrics", headers=bearer(first))
            assert answer.status_code == 200
            assert '"requests-3600s";q=5;w=3600' in answer.headers["ratelimit-policy"]
            assert '"requests-86400s";q=100;w=86400' in answer.headers["ratelimit-policy"]
            found = re.match(r'"requests-3600s";r=(\d);t=(\d+)', answer.headers["ratelimit"])
            assert found
            left.append(int(found[1]))
            assert 0 < int(found[2]) <= 3600
        assert left == [4, 3, 2, 1, 0]
        refused = client.get("/metrics", headers=bearer(first))
        assert refused.status_code == 429
        assert refused.json()["type"] == "urn:tubeloom:problem:too-many-requests"
        assert 1 <= int(refused.headers["retry-after"]) <= 7200
        assert '"requests-3600s";r=0' in refused.headers["ratelimit"]
        assert client.get("/metrics", headers=bearer(second)).status_code == 200
        assert client.get("/healthz").status_code == 200


def test_a_budget_of_work_is_kept(rated: tuple[Service, Path]) -> None:
    service, data = rated
    spender, other = make_key(data, "render"), make_key(data, "render")
    with service.client() as client:
        costly = client.post("/v1/render", content=large_program(1000), headers=bearer(spender))
        assert costly.status_code == 200
        refused = client.post("/v1/render", json=SMALL, headers=bearer(spender))
        assert refused.status_code == 429
        assert "0.02 seconds of work" in refused.json()["detail"]
        assert '"work-ms";q=20;w=60' in refused.headers["ratelimit-policy"]
        assert int(refused.headers["retry-after"]) >= 1
        assert client.post("/v1/render", json=SMALL, headers=bearer(other)).status_code == 200


def test_guessing_keys_is_slowed_down_but_known_keys_work(rated: tuple[Service, Path]) -> None:
    service, data = rated
    known = make_key(data, "metrics")
    with service.client() as client:
        assert client.get("/metrics", headers=bearer(known)).status_code == 200
        statuses = [
            client.get("/metrics", headers=bearer(f"tl_{number:043}")).status_code
            for number in range(80)
        ]
        assert statuses[:30] == [401] * 30
        assert statuses[-1] == 429
        refused = client.get("/metrics", headers=bearer("tl_another"))
        assert int(refused.headers["retry-after"]) >= 1
        assert client.get("/metrics", headers=bearer(known)).status_code == 200


def test_without_keys_addresses_are_counted(tmp_path: Path) -> None:
    with (
        running_service(tmp_path, warm=False, rate_per_address="3/hour") as service,
        service.client() as client,
    ):
        statuses = [client.get("/v1/programs").status_code for _ in range(5)]
        assert statuses == [200, 200, 200, 429, 429]
        # Nobody asked to be believed about where requests come from.
        strange = client.get("/v1/programs", headers={"X-Forwarded-For": "203.0.113.7"})
        assert strange.status_code == 429
        assert client.get("/v1/palettes").status_code == 200
    trusting = tmp_path / "trusting"
    trusting.mkdir()
    with (
        running_service(
            trusting, warm=False, rate_per_address="1/hour", trusted_proxies="127.0.0.1"
        ) as service,
        service.client() as client,
    ):
        for number, status in ((1, 200), (1, 429), (2, 200)):
            headers = {"X-Forwarded-For": f"203.0.113.{number}"}
            assert client.get("/v1/programs", headers=headers).status_code == status


@pytest.mark.parametrize("rate", ["often", "5", "0/minute;x", "-1/second", "5/fortnight"])
def test_rates_that_are_none_are_refused_at_the_start(rate: str, tmp_path: Path) -> None:
    with pytest.raises(ValidationError, match="rate_per_key"):
        Settings(data_folder=tmp_path, rate_per_key=rate)
