"""Films, read back by Pillow and played in Chromium."""

from __future__ import annotations

import base64
import io
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

from app.errors import PictureTooLarge
from app.output.animation import write_mp4, write_webp
from tests.output.browser import page_of

WRITERS = (write_webp, write_mp4)


def frames(count: int, size: tuple[int, int] = (96, 64), mode: str = "RGB") -> list[Image.Image]:
    """A bright square goes from left to right, over a floor that changes its colour."""
    made = []
    for number in range(count):
        share = number / max(count - 1, 1)
        picture = Image.new(mode, size, (30, int(200 * share), 90, 0)[: len(mode)])
        left = int(share * (size[0] - 16))
        picture.paste((250, 220, 40, 255)[: len(mode)], (left, 10, left + 16, 26))
        made.append(picture)
    return made


def pixels(picture: Image.Image) -> NDArray[np.float64]:
    return np.asarray(picture.convert("RGB"), dtype=np.float64)


def test_a_webp_has_every_frame_for_its_time() -> None:
    given = frames(7)
    film: Any = Image.open(io.BytesIO(write_webp(given, 7, 2.5)))
    assert (film.format, film.n_frames, film.size, film.info["loop"]) == ("WEBP", 7, (96, 64), 0)
    shown = 0
    for number, frame in enumerate(given):
        film.seek(number)
        film.load()
        shown += film.info["duration"]
        assert np.abs(pixels(film) - pixels(frame)).mean() < 4
    assert shown == 2500


def test_a_transparent_webp_leaves_nothing_of_the_frame_before() -> None:
    film: Any = Image.open(io.BytesIO(write_webp(frames(3, mode="RGBA"), 3, 1.0)))
    film.seek(2)
    alpha = np.asarray(film.convert("RGBA"))[..., 3]
    assert alpha[18, 90] == 255
    assert alpha[18, 5] == 0
    assert alpha[50, 50] == 0


@pytest.mark.parametrize("write", WRITERS)
def test_the_same_frames_are_the_same_bytes(write: Any) -> None:
    assert write(frames(30), 30, 1.0) == write(iter(frames(30)), 30, 1.0)


@pytest.mark.parametrize("write", WRITERS)
def test_frames_are_told_as_they_come_and_the_end_is_told(write: Any) -> None:
    told: list[tuple[int, float]] = []
    drawn = 0

    def drawing() -> Iterator[Image.Image]:
        nonlocal drawn
        for frame in frames(5):
            drawn += 1
            yield frame

    write(drawing(), 5, 1.0, lambda _stage, share: told.append((drawn, share)))
    assert told == [(number, number / 5) for number in range(1, 6)]


@pytest.mark.parametrize("write", WRITERS)
def test_progress_can_end_the_work(write: Any) -> None:
    def impatient(_stage: str, share: float) -> None:
        if share > 0.3:
            raise TimeoutError

    left = iter(frames(10))
    with pytest.raises(TimeoutError):
        write(left, 10, 1.0, impatient)
    assert len(list(left)) >= 5


@pytest.mark.parametrize("write", WRITERS)
def test_a_single_frame_is_a_film_too(write: Any) -> None:
    assert len(write(frames(1), 1, 1.0)) > 100


def test_a_side_too_long_for_webp_is_refused() -> None:
    with pytest.raises(PictureTooLarge, match="16383"):
        write_webp(frames(2, size=(16384, 4)), 2, 1.0)


PAGE = """<!doctype html><video muted src="data:video/mp4;base64,{film}"></video>
<script>
const video = document.querySelector("video");
const ready = new Promise((resolve, reject) => {{
  video.addEventListener("loadeddata", resolve);
  video.addEventListener("error", () => reject(video.error.message));
}});
async function at(seconds) {{
  await ready;
  // A browser that is busy says that it has sought the place before the frame is there.
  const presented = new Promise(resolve => video.requestVideoFrameCallback(resolve));
  const sought = new Promise(resolve => video.addEventListener("seeked", resolve, {{once: true}}));
  video.currentTime = seconds;
  await Promise.all([sought, presented]);
  const canvas = document.createElement("canvas");
  [canvas.width, canvas.height] = [video.videoWidth, video.videoHeight];
  canvas.getContext("2d").drawImage(video, 0, 0);
  return canvas.toDataURL("image/png");
}}
async function play() {{
  await ready;
  const ended = new Promise(resolve => video.addEventListener("ended", resolve));
  video.currentTime = 0;
  video.playbackRate = 8;
  await video.play();
  await ended;
  return video.currentTime;
}}
</script>"""


def test_an_mp4_plays_in_chromium_and_every_place_shows_its_frame(tmp_path: Path) -> None:
    given = frames(30, size=(97, 65))
    film = base64.b64encode(write_mp4(given, 30, 3.0)).decode()
    with page_of(PAGE.format(film=film), tmp_path) as page:
        # Forward and back, before and behind a key frame, an odd size padded to an even one.
        for number in (2, 27, 12, 29, 0):
            url = page.evaluate(f"at({(number + 0.5) / 10})")
            picture = Image.open(io.BytesIO(base64.b64decode(url.partition(",")[2])))
            assert picture.size == (98, 66)
            error = np.abs(pixels(picture)[:65, :97] - pixels(given[number])).mean()
            assert error < 5, number
            assert np.abs(pixels(picture)[:65, :97] - pixels(given[number - 5])).mean() > 10
        assert page.evaluate("play()") == pytest.approx(3.0, abs=0.01)


def test_transparent_frames_lie_on_paper_in_an_mp4(tmp_path: Path) -> None:
    film = base64.b64encode(write_mp4(frames(2, mode="RGBA"), 2, 1.0)).decode()
    with page_of(PAGE.format(film=film), tmp_path) as page:
        url = page.evaluate("at(0.25)")
    picture = Image.open(io.BytesIO(base64.b64decode(url.partition(",")[2])))
    assert np.abs(pixels(picture)[50, 50] - 255).max() < 6
