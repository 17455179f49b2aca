"""Jobs that are cancelled at any moment leave their place to the next."""

from __future__ import annotations

import asyncio
import json
from pathlib import Path

from app.answers import RenderOptions
from app.jobs.crew import LocalCrew
from app.jobs.keeper import Keeper
from app.output.media import SceneFormat
from app.settings import Settings
from app.store import jobs
from app.store.database import Database
from app.store.results import Results
from tests.api.job_calls import program


def asked(name: str) -> jobs.NewJob:
    """A job that nobody else has asked for."""
    job, document = jobs.new_id(), json.dumps(program(name)).encode()
    return jobs.NewJob(job, job, None, document, None, RenderOptions(SceneFormat.GLB), 90.0)


def test_a_job_cancelled_before_its_work_takes_a_step_frees_its_place(tmp_path: Path) -> None:
    settings = Settings(data_folder=tmp_path, job_workers=1)
    database = Database(settings.database_url)
    database.migrate()

    async def state_of_next() -> str:
        results = Results(settings.results_place, database, settings.results_bytes)
        async with results, LocalCrew(settings) as crew:
            keeper = Keeper(settings, database, results, crew)  # it looks when it is told to
            first, second = asked("left at once"), asked("next in line")
            await database.write(lambda connection: jobs.create(connection, first, 2))
            await keeper._take_up()
            keeper.leave(first.id)  # the loop has not had a turn
            await database.write(lambda connection: jobs.create(connection, second, 2))
            await keeper._take_up()
            found = await database.read(lambda connection: jobs.find(connection, second.id))
            keeper.leave(second.id)
            assert found is not None
            return found.state

    try:
        assert asyncio.run(state_of_next()) == "running"
    finally:
        database.close()
