"""Stereo, films, sheets and error cards, looked at as files."""

from __future__ import annotations

import io
from xml.etree import ElementTree as ET

import av
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from PIL import Image

from app.output.animation import write_mp4, write_webp
from app.output.error_picture import error_picture
from app.output.sheet import Sheet
from app.output.stereo import anaglyph, side_by_side

COLORS = ["#d02020", "#20a040", "#2050d0", "#e0b020"]


def frames(size: tuple[int, int] = (64, 48)) -> list[Image.Image]:
    return [Image.new("RGB", size, color) for color in COLORS]


def test_a_webp_moves_for_as_long_as_it_should() -> None:
    found = Image.open(io.BytesIO(write_webp(frames(), 4, 2.0)))
    assert getattr(found, "n_frames", 1) == 4
    durations = []
    for number in range(4):
        found.seek(number)
        found.load()
        durations.append(found.info["duration"])
        shown = np.asarray(found.convert("RGB"), dtype=float).mean(axis=(0, 1))
        expected = np.asarray(frames()[number], dtype=float).mean(axis=(0, 1))
        assert np.abs(shown - expected).max() < 12
    assert sum(durations) == 2000


@pytest.mark.parametrize("size", [(64, 48), (63, 47)])
def test_an_mp4_holds_every_frame_in_its_colours(size: tuple[int, int]) -> None:
    data = write_mp4(iter(frames(size)), 4, 2.0)
    with av.open(io.BytesIO(data)) as film:
        stream = film.streams.video[0]
        assert stream.codec_context.name == "vp9"
        shown = [frame.to_ndarray(format="rgb24") for frame in film.decode(stream)]
        assert float((stream.duration or 0) * (stream.time_base or 0)) == pytest.approx(2.0)
    assert len(shown) == 4
    for found, expected in zip(shown, frames(size), strict=True):
        middle = np.asarray(expected, dtype=float)[5, 5]
        assert np.abs(found[5, 5].astype(float) - middle).max() < 16


def test_the_same_frames_make_the_same_files() -> None:
    assert write_mp4(frames(), 4, 1.0) == write_mp4(frames(), 4, 1.0)
    assert write_webp(frames(), 4, 1.0) == write_webp(frames(), 4, 1.0)


def test_what_is_transparent_stays_so_in_webp_and_turns_white_in_mp4() -> None:
    clear = [Image.new("RGBA", (32, 32), (0, 0, 0, 0))] * 2
    webp = Image.open(io.BytesIO(write_webp(clear, 2, 1.0)))
    assert np.asarray(webp.convert("RGBA"))[..., 3].max() == 0
    with av.open(io.BytesIO(write_mp4(clear, 2, 1.0))) as film:
        assert next(film.decode(video=0)).to_ndarray(format="rgb24").min() > 250


def test_both_eyes_stand_beside_each_other() -> None:
    red, green = frames()[:2]
    both = side_by_side(red, green)
    assert both.size == (128, 48)
    assert both.getpixel((10, 10)) == red.getpixel((10, 10))
    assert both.getpixel((100, 10)) == green.getpixel((10, 10))


def test_an_anaglyph_keeps_grey_and_shows_red_to_both_eyes() -> None:
    grey = Image.new("RGB", (4, 4), "#808080")
    assert np.abs(np.asarray(anaglyph(grey, grey), dtype=int) - 128).max() <= 8
    red = Image.new("RGB", (4, 4), "#e02020")
    seen = np.asarray(anaglyph(red, red), dtype=int)[0, 0]
    assert seen[0] > 120
    assert seen[1] > 60


@settings(max_examples=40, deadline=None)
@given(
    st.integers(60, 900), st.integers(60, 900), st.integers(1, 6), st.integers(1, 6), st.booleans()
)
def test_cells_fit_their_sheet(
    width: int, height: int, rows: int, columns: int, named: bool
) -> None:
    page = Sheet(width, height, rows, columns, "#ffffff", named)
    cells = [Image.new("RGB", page.cell, "#2050d0")] * (rows * columns)
    found = page.of(cells, ["caption"] * len(cells), ["row"] * rows if named else ())
    assert found.size == (width, height)
    blue = (np.asarray(found) == (0x20, 0x50, 0xD0)).all(axis=2)
    if page.cell[0] > 8 and page.cell[1] > 8:
        assert blue.sum() == pytest.approx(page.cell[0] * page.cell[1] * len(cells), rel=0.02)


@settings(max_examples=30, deadline=None)
@given(
    st.text(max_size=300),
    st.lists(st.text(max_size=400), max_size=20),
    st.integers(100, 1200),
    st.integers(100, 900),
)
def test_error_cards_hold_whatever_is_said(
    title: str, lines: list[str], width: int, height: int
) -> None:
    card = Image.open(io.BytesIO(error_picture(title, lines, width, height, as_svg=False)))
    assert card.size == (width, height)
    drawn = ET.fromstring(error_picture(title, lines, width, height, as_svg=True))
    assert drawn.get("width") == str(width)


def test_a_card_counts_what_does_not_fit() -> None:
    svg = error_picture("Title", [f"/items/{n}: wrong" for n in range(40)], 300, 200, as_svg=True)
    assert b"more" in svg
    assert b"/items/0: wrong" in svg
