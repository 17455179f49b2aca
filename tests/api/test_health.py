import asyncio
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import httpx
import pytest

from app.api.health import Examiner
from app.jobs.executor import NOT_DRAWN, WorkerPool
from app.main import create_app
from app.settings import Settings
from app.store.database import Database
from tests.conftest import require
from tests.service import SMALL, Service, running_service, until


def test_the_service_lives(client: httpx.Client) -> None:
    assert client.get("/healthz").json() == {"status": "ok"}


def test_the_service_is_ready_and_can_draw(client: httpx.Client) -> None:
    # After the first worker it is ready, whoever asks early sees one of two; and on a machine that
    # has much else to do the first pixel takes longer than whoever asks has patience for.
    until(lambda: both_have_drawn(client))
    assert client.get("/readyz").json() == {
        "status": "ready",
        "workers": {"wanted": 2, "warm": 2, "problem": None},
        "draft": {"available": True, "problem": None},
        "database": {"available": True, "problem": None},
    }


def both_have_drawn(client: httpx.Client) -> bool:
    response = client.get("/readyz")
    return response.status_code == 200 and bool(response.json()["workers"]["warm"] == 2)


def figure(client: httpx.Client, name: str) -> float:
    lines = client.get("/metrics").text.splitlines()
    return float(next(line for line in lines if line.startswith(name)).split()[1])


def works(client: httpx.Client) -> float:
    return figure(client, "tubeloom_work_seconds_count")


def test_readiness_is_tried_out_by_a_worker_but_not_for_everyone_who_asks(
    service: Service, client: httpx.Client
) -> None:
    service.spent()  # nobody's work goes on any more
    before = works(client)
    until(lambda: client.get("/readyz").status_code == 200 and works(client) > before)
    after, began = works(client), time.monotonic()
    for _ in range(20):
        assert client.get("/readyz").status_code == 200
    periods = (time.monotonic() - began) / Settings().examine_seconds
    assert works(client) <= after + 1 + periods


@pytest.fixture(scope="module")
def examined(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[Service, Path]]:
    """A service that is examined again after each second, and the folder of its data."""
    folder = tmp_path_factory.mktemp("examined")
    with running_service(folder, deadline_seconds=3, examine_seconds=1) as service:
        yield service, folder / "data"


WORKS = {"ready", "degraded"}


def readiness(service: Service, shows: Callable[[dict[str, Any]], bool]) -> dict[str, Any]:
    """What it says of itself as soon as that shows what it should."""
    with service.client() as client:

        def ask() -> dict[str, Any] | None:
            response = client.get("/readyz")
            found: dict[str, Any] = response.json()
            assert response.status_code == (200 if found["status"] in WORKS else 503)
            return found if shows(found) else None

        return until(ask)


def is_ready(found: dict[str, Any]) -> bool:
    return bool(found["status"] == "ready")


def test_a_worker_that_hangs_is_noticed_counted_and_replaced(
    examined: tuple[Service, Path],
) -> None:
    service, _ = examined
    (worker,) = service.workers()
    worker.suspend()
    found = readiness(service, lambda found: bool(found["workers"]["problem"]))
    assert found["status"] == "broken"
    assert "pixel" in str(found["workers"]["problem"])
    assert readiness(service, is_ready)["workers"]["problem"] is None
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


def test_what_does_not_draw_is_not_called_available(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    vendors = Path("/usr/share/glvnd/egl_vendor.d")
    require(vendors.is_dir(), "EGL's vendors are not where they usually are.")
    drivers = tmp_path / "drivers"
    monkeypatch.setenv("__EGL_VENDOR_LIBRARY_DIRS", str(drivers))
    with running_service(tmp_path, gl_platform="egl", examine_seconds=1) as service:

        def found_by_a_new_worker(status: str) -> dict[str, Any]:
            for worker in service.workers():
                worker.kill()
            found = readiness(
                service,
                lambda found: found["status"] == status and found["draft"]["problem"] != NOT_DRAWN,
            )
            assert isinstance(found["draft"], dict)
            return found["draft"]

        # EGL is there, but has nothing to draw with.
        broken = found_by_a_new_worker("degraded")
        assert broken["available"] is False
        assert "OpenGL was found (egl) but does not start" in broken["problem"]
        with service.client() as client:
            assert client.post("/v1/render", json=SMALL).status_code == 200
            refused = client.post("/v1/render?format=png", json=SMALL)
            assert (refused.status_code, refused.json()["detail"]) == (503, broken["problem"])
        drivers.symlink_to(vendors)
        assert found_by_a_new_worker("ready") == {"available": True, "problem": None}
        drivers.unlink()
        assert found_by_a_new_worker("degraded") == broken


# Nothing can be done with that service afterwards.
def test_a_database_that_cannot_be_read_is_noticed(examined: tuple[Service, Path]) -> None:
    service, data = examined
    assert readiness(service, is_ready)["database"] == {"available": True, "problem": None}
    for file in data.glob("tubeloom.db*"):
        file.write_bytes(b"not a database" * 1000)
    found = readiness(service, lambda found: not found["database"]["available"])
    assert found["status"] == "broken"
    assert found["database"]["problem"]


@pytest.mark.parametrize(
    ("warm", "problem", "status", "word"),
    [
        (0, NOT_DRAWN, 503, "starting"),
        (1, None, 200, "ready"),
        (1, NOT_DRAWN, 200, "degraded"),
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
