from pathlib import Path

import httpx

from tests.service import running_service


def test_the_service_lives(client: httpx.Client) -> None:
    assert client.get("/healthz").json() == {"status": "ok"}


def test_the_service_is_ready_and_can_draw(client: httpx.Client) -> None:
    response = client.get("/readyz")
    assert response.status_code == 200
    assert response.json() == {
        "status": "ready",
        "workers": {"wanted": 2, "warm": 2},
        "draft": {"available": True, "problem": None},
    }


def test_without_a_way_to_draw_all_but_pictures_works(
    tmp_path: Path, no_gl: dict[str, str]
) -> None:
    with running_service(tmp_path, workers=1, **no_gl) as service, service.client() as client:
        readiness = client.get("/readyz")
        assert (readiness.status_code, readiness.json()["status"]) == (200, "degraded")
        assert "install" in readiness.json()["draft"]["problem"]
        document = {"items": [{"id": "a"}]}
        assert client.post("/v1/render", json=document).status_code == 200
        refused = client.post("/v1/render?format=png", json=document)
        assert refused.status_code == 503
        assert refused.json()["type"] == "urn:tubeloom:problem:renderer-unavailable"
