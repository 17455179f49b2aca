import asyncio
from pathlib import Path
from typing import Any

import httpx
import pytest

from app.api.health import Examiner
from app.jobs.executor import WorkerPool
from app.main import create_app
from app.settings import Settings
from app.store.database import Database
from tests.service import SMALL, Service, running_service, until


def test_the_service_lives(client: httpx.Client) -> None:
    assert client.get("/healthz").json() == {"status": "ok"}


def test_the_service_is_ready_and_can_draw(client: httpx.Client) -> None:
    # After the first worker it is ready; whoever asks early sees one of two.
    until(lambda: client.get("/readyz").json()["workers"]["warm"] == 2)
    response = client.get("/readyz")
    assert response.status_code == 200
    assert response.json() == {
        "status": "ready",
        "workers": {"wanted": 2, "warm": 2, "problem": None},
        "draft": {"available": True, "problem": None},
        "database": {"available": True, "problem": None},
    }


def figure(client: httpx.Client, name: str) -> float:
    lines = client.get("/metrics").text.splitlines()
    return float(next(line for line in lines if line.startswith(name)).split()[1])


def works(client: httpx.Client) -> float:
    return figure(client, "tubeloom_work_seconds_count")


def test_readiness_is_tried_out_by_a_worker_but_not_for_everyone_who_asks(
    client: httpx.Client,
) -> None:
    before = works(client)
    until(lambda: (client.get("/readyz"), works(client) > before)[1], 20)
    after = works(client)
    for _ in range(20):
        assert client.get("/readyz").status_code == 200
    assert works(client) <= after + 1


def readiness(service: Service, status: int) -> dict[str, Any]:
    with service.client() as client:

        def ask() -> httpx.Response | None:
            response = client.get("/readyz")
            return response if response.status_code == status else None

        found: dict[str, Any] = until(ask, 60).json()
    return found


def test_a_worker_that_hangs_is_noticed_counted_and_replaced(tmp_path: Path) -> None:
    with running_service(tmp_path, deadline_seconds=3, examine_seconds=1) as service:
        (worker,) = service.workers()
        worker.suspend()
        found = readiness(service, 503)
        assert found["status"] == "broken"
        assert "pixel" in str(found["workers"]["problem"])
        assert readiness(service, 200)["workers"]["problem"] is None
        (another,) = service.workers()
        assert another != worker
        another.suspend()
        with service.client() as client:
            lost = lost_workers(client)
            assert lost >= 1
            assert client.post("/v1/render", json=SMALL).status_code == 504
            assert lost_workers(client) > lost


def lost_workers(client: httpx.Client) -> float:
    return figure(client, "tubeloom_workers_lost_total")


def test_a_database_that_cannot_be_read_is_noticed(tmp_path: Path) -> None:
    with running_service(tmp_path, warm=False, examine_seconds=1) as service:
        assert readiness(service, 200)["database"] == {"available": True, "problem": None}
        for file in (tmp_path / "data").glob("tubeloom.db*"):
            file.write_bytes(b"not a database" * 1000)
        found = readiness(service, 503)
        assert found["status"] == "broken"
        assert found["database"]["available"] is False
        assert found["database"]["problem"]


@pytest.mark.parametrize(
    ("warm", "problem", "status", "word"),
    [
        (0, "No worker has started yet.", 503, "starting"),
        (1, None, 200, "ready"),
        (1, "Install libosmesa6.", 200, "degraded"),
    ],
)
def test_readiness_says_what_is_missing(
    warm: int, problem: str | None, status: int, word: str, tmp_path: Path
) -> None:
    app = create_app(Settings(workers=3))
    database = Database(f"sqlite:///{tmp_path / 'tubeloom.db'}")
    database.migrate()
    app.state.pool = WorkerPool(Settings(workers=3))
    app.state.examiner = Examiner(app.state.pool, database, 5.0)
    app.state.pool.warm, app.state.pool.draft_problem = warm, problem

    async def ask() -> httpx.Response:
        transport = httpx.ASGITransport(app)
        async with httpx.AsyncClient(transport=transport, base_url="http://localhost") as client:
            return await client.get("/readyz")

    response = asyncio.run(ask())
    database.close()
    assert (response.status_code, response.json()["status"]) == (status, word)
    assert response.json()["workers"] == {"wanted": 3, "warm": warm, "problem": None}
    assert response.json()["draft"] == {"available": problem is None, "problem": problem}
