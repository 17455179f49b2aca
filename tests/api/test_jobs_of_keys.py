"""Jobs are seen by whoever started them."""

from __future__ import annotations

from pathlib import Path

from tests.api.job_calls import over, program, start
from tests.api.keys import bearer, make_key
from tests.service import Service


def test_jobs_of_one_key_are_not_there_for_another_unless_it_may_do_everything(
    guarded: Service, guarded_folder: Path
) -> None:
    data = guarded_folder / "data"
    mine, yours, admin, render, metrics = (
        bearer(make_key(data, *scopes))
        for scopes in (("jobs", "render"), ("jobs",), ("admin",), ("render",), ("metrics",))
    )
    with guarded.client() as client:
        client.headers.update(mine)
        job = start(client, "format=glb", program("mine"))
        assert over(client, job)["state"] == "done"
        assert [each["links"]["self"] for each in client.get("/v1/jobs").json()["jobs"]] == [job]
        for path in ("", "/events", "/result"):
            assert client.get(job + path, headers=yours).status_code == 404
        assert client.delete(job, headers=yours).status_code == 404
        assert client.get("/v1/jobs", headers=yours).json()["jobs"] == []
        assert client.get(job, headers=admin).status_code == 200
        seen = client.get("/v1/jobs", headers=admin).json()["jobs"]
        assert job in {each["links"]["self"] for each in seen}
        assert client.get(job, headers=metrics).status_code == 403
        prefer = {"prefer": "respond-async, wait=0"}
        asked = "/v1/render?format=glb"
        plain = client.post(asked, json=program("mine"), headers={**render, **prefer})
        assert plain.status_code == 200
        later = client.post(asked, json=program("mine"), headers=prefer)
        assert later.status_code == 202
        stored = client.post("/v1/jobs?program=any")
        assert stored.status_code == 403
