import os

from tests.hostile import KINDS, all_hostile, hostile
from tests.hostile_run import attack
from tests.service import Service

DOCUMENTS = int(os.environ.get("HOSTILE_DOCUMENTS", "120"))

GROWTH_BYTES = 100 * 2**20
"""That service and workers together may have grown by since a third of the attack."""


def test_the_same_seed_makes_the_same_requests() -> None:
    numbers = range(2 * len(KINDS))
    made = [hostile(number) for number in numbers]
    assert [hostile(number) for number in numbers] == made
    assert [hostile(number, 2) for number in numbers] != made
    assert {each.kind for each in made} == set(KINDS)


def test_hostile_requests_are_refused_and_leave_no_trace(service: Service) -> None:
    workers = {worker.pid for worker in service.workers()}
    report = attack(service, all_hostile(DOCUMENTS))
    assert report.faults == []
    assert sum(report.statuses.values()) >= DOCUMENTS
    assert {worker.pid for worker in service.workers()} == workers
    settled = report.memory[len(report.memory) // 3]
    assert report.memory[-1] < settled + GROWTH_BYTES, report.memory
