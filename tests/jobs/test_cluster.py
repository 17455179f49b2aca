"""Jobs on a Dask cluster, with PostgreSQL; whatever is killed, each job ends once."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest

from tests.api.job_calls import (
    LONG,
    PERIODS,
    PICTURE,
    at_work,
    caught,
    over,
    program,
    start,
    watched,
)
from tests.cluster import Cluster, running_cluster
from tests.postgres import Postgres, running_postgres
from tests.service import Service, cpu_seconds, running_service, spent_until_gone, until


@dataclass(frozen=True)
class Site:
    """All that there is."""

    service: Service
    cluster: Cluster
    postgres: Postgres


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Site]:
    """A service over PostgreSQL, with a cluster of two workers."""
    folder = tmp_path_factory.mktemp("site")
    with (
        running_postgres() as postgres,
        running_cluster(folder / "cluster") as cluster,
        running_service(
            folder, workers=1, database=postgres.url, dask_scheduler=cluster.address
        ) as service,
    ):
        yield Site(service, cluster, postgres)


def test_a_cluster_makes_what_the_service_makes_and_tells_how_it_goes_on(site: Site) -> None:
    with site.service.client() as client:
        long = start(client, LONG, program("watched on a cluster"))
        assert at_work(client, long)["stage"] == "drawing"
        client.delete(long)
        document = program("on a cluster")
        job = start(client, PICTURE, document)
        found = over(client, job)
        assert (found["state"], found["attempts"]) == ("done", 1)
        plain = client.post(f"/v1/render?{PICTURE}", json=document)
        assert plain.headers["tubeloom-stopped-by"] == "samples"
        assert client.get(f"{job}/result").content == plain.content
        failed = over(client, start(client, "format=glb", b'{"items": 1}'))
        assert failed["problem"]["errors"][0]["pointer"] == "/items"


def test_who_cancels_a_job_frees_a_processor_of_the_cluster_within_a_second(site: Site) -> None:
    with site.service.client() as client:
        job = start(client, LONG, program("cancelled on a cluster"))
        at_work(client, job)
        spent = {child.pid: cpu_seconds(child) for child in site.cluster.children()}
        busy = until(
            lambda: next(
                (
                    child
                    for child in site.cluster.children()
                    if cpu_seconds(child) - spent.get(child.pid, 0.0) > 0.2
                ),
                None,
            )
        )
        client.delete(job)
        assert spent_until_gone(busy) < 1.0


def test_jobs_end_once_whatever_is_killed(site: Site) -> None:
    documents = [program(f"among the dying {number}") for number in range(3)]
    with site.service.client() as client:
        query = watched(PERIODS[0])
        jobs = [start(client, query, document) for document in (*documents, documents[0])]
        caught(client, jobs[0])
        # One is there in any case when it comes to dying, however long the machine stops before.
        long = start(client, LONG, program("among the dying, and not over by then"))
        site.cluster.kill_worker(0)
        site.cluster.kill_worker(1)
        caught(client, jobs[1], 0.1)
        site.cluster.kill_scheduler()
        until(lambda: "cluster lost a work" in site.service.log.read_text())
        site.postgres.kill()
        assert client.get("/healthz").status_code == 200
        refused = client.get(jobs[0])
        assert refused.status_code == 503
        assert refused.json()["type"] == "urn:tubeloom:problem:store-unavailable"
        site.postgres.start()
        until(lambda: client.delete(long).status_code == 204)
        found = [over(client, job) for job in jobs]
        assert [each["state"] for each in found] == ["done"] * len(jobs), found
        made = [client.get(f"{job}/result").content for job in jobs]
        assert made[0] == made[-1]
    assert site.service.process.poll() is None


def test_a_service_whose_cluster_is_not_there_lives_and_says_so(tmp_path: Path) -> None:
    nowhere = running_service(
        tmp_path, workers=1, dask_scheduler="tcp://127.0.0.1:9", job_deadline_seconds=1
    )
    with nowhere as service, service.client() as client:
        assert client.post("/v1/render?format=glb", json=program("here")).status_code == 200
        found = over(client, start(client, "format=glb", program("nowhere")))
        assert found["problem"]["type"] == "urn:tubeloom:problem:deadline-exceeded"
