"""Films of final pictures are drawn side by side, in stretches."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from app.answers import RenderOptions
from app.jobs.films import stretches
from app.output.media import SceneFormat
from tests.api.job_calls import over, program, start
from tests.service import Service, running_service, until

FILM = "quality=final&width=32&height=24&samples=1&frames=4"

FINAL = RenderOptions(SceneFormat.MP4, quality="final")


@pytest.mark.parametrize(("frames", "width"), [(36, 2), (7, 2), (5, 4), (4, 2), (1000, 9)])
def test_stretches_have_every_frame_once_and_all_the_time_there_is(frames: int, width: int) -> None:
    options = RenderOptions(SceneFormat.WEBP, quality="final", frames=frames)
    parts = stretches(options, width)
    drawn = [number for part in parts for number in range(part.first, part.end)]
    assert drawn == list(range(frames))
    assert len(parts) <= 3 * width
    assert all(part.end - part.first >= 2 for part in parts)
    # Workers that take one part after the other take as long as one that draws the whole film.
    assert sum(part.share for part in parts) <= width + 1e-9


@pytest.mark.parametrize(
    ("options", "width"),
    [(FINAL, 1), (RenderOptions(SceneFormat.MP4), 2), (RenderOptions(SceneFormat.PNG), 2)],
)
def test_what_is_not_worth_it_is_done_in_one_piece(options: RenderOptions, width: int) -> None:
    assert not stretches(options, width)


@pytest.mark.parametrize("ending", ["webp", "mp4"])
def test_a_film_in_stretches_is_the_film_in_one_piece(two_workers: Service, ending: str) -> None:
    document, query = program(f"film as {ending}"), f"format={ending}&{FILM}"
    with two_workers.client() as client:
        job = start(client, query, document)
        assert over(client, job)["state"] == "done"
        made = client.get(f"{job}/result")
        plain = client.post(f"/v1/render?{query}", json=document)
    assert plain.headers["tubeloom-stopped-by"] == "samples"
    assert made.content == plain.content
    for name in ("content-type", "etag", "content-disposition", "tubeloom-samples"):
        assert made.headers[name] == plain.headers[name]


def test_a_stretch_whose_worker_dies_is_drawn_again(two_workers: Service) -> None:
    # Frames are drawn until the time is over, however quick the machine is.
    query = "format=webp&quality=final&width=32&height=24&samples=65536&time_limit=4&frames=4"

    def drawn_again() -> bool:
        """Whether a film is done though a worker died over it, and not just after its part."""
        spent = two_workers.spent()
        job = start(client, query, program("killed film"))
        until(lambda: two_workers.busy_worker(spent)).kill()
        found = over(client, job)
        assert found["state"] == "done"
        return bool(found["attempts"] == 2)

    with two_workers.client() as client:
        until(drawn_again)


@pytest.fixture(scope="module")
def two_workers(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Service]:
    """A service with two workers for jobs."""
    with running_service(tmp_path_factory.mktemp("films"), workers=1, job_workers=2) as running:
        yield running
