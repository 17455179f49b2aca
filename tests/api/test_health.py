import asyncio

import httpx
import pytest

from app.jobs.executor import WorkerPool
from app.main import create_app
from app.settings import Settings
from tests.service import until


def test_the_service_lives(client: httpx.Client) -> None:
    assert client.get("/healthz").json() == {"status": "ok"}


def test_the_service_is_ready_and_can_draw(client: httpx.Client) -> None:
    # After the first worker it is ready; whoever asks early sees one of two.
    until(lambda: client.get("/readyz").json()["workers"]["warm"] == 2)
    response = client.get("/readyz")
    assert response.status_code == 200
    assert response.json() == {
        "status": "ready",
        "workers": {"wanted": 2, "warm": 2},
        "draft": {"available": True, "problem": None},
    }


@pytest.mark.parametrize(
    ("warm", "problem", "status", "word"),
    [
        (0, "No worker has started yet.", 503, "starting"),
        (1, None, 200, "ready"),
        (1, "Install libosmesa6.", 200, "degraded"),
    ],
)
def test_readiness_says_what_is_missing(
    warm: int, problem: str | None, status: int, word: str
) -> None:
    app = create_app(Settings(workers=3))
    app.state.pool = WorkerPool(Settings(workers=3))
    app.state.pool.warm, app.state.pool.draft_problem = warm, problem

    async def ask() -> httpx.Response:
        transport = httpx.ASGITransport(app)
        async with httpx.AsyncClient(transport=transport, base_url="http://here") as client:
            return await client.get("/readyz")

    response = asyncio.run(ask())
    assert (response.status_code, response.json()["status"]) == (status, word)
    assert response.json()["workers"] == {"wanted": 3, "warm": warm}
    assert response.json()["draft"] == {"available": problem is None, "problem": problem}
