from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image, ImageDraw

from app.output.lettering import Type, clean, write

WORDS = "Items that a hyperedge joins, /items/3/attachment_points/0/direction: straight up."


@given(st.text(max_size=120), st.floats(20, 300))
def test_wrapped_lines_have_room_and_lose_nothing(text: str, room: float) -> None:
    how, line = Type(12), clean(text, 200)
    wrapped = how.wrapped(line, room)
    assert all(how.width(part) <= room for part in wrapped)
    assert "".join(wrapped).replace(" ", "") == line.replace(" ", "")


def test_words_are_kept_whole_where_they_can_be() -> None:
    for line in Type(12).wrapped(WORDS, 200)[:-1]:
        assert line[-1] in ",:/_" or f"{line} " in WORDS


@given(st.text(max_size=80), st.floats(0, 200))
def test_what_is_fitted_fits(text: str, room: float) -> None:
    how = Type(14, weight=600)
    line = clean(text, 100)
    fitted = how.fitted(line, room)
    assert how.width(fitted) <= room
    assert fitted in {line, ""} or fitted.endswith("…")


@given(st.text(max_size=50))
def test_clean_text_is_one_printable_line(text: str) -> None:
    line = clean(text, 50)
    assert line.isprintable()
    assert line == line.strip()


def test_clean_text_neither_hides_nor_reorders() -> None:
    assert clean("abc\u202egnirts\u200b\ufeff", 99) == "abcgnirts"
    assert clean("a\x00\n\r\t\x1b[31mb\ud800", 99) == "a [31mb"
    assert clean("x" * 10**6, 20) == "x" * 20 + "…"


def test_a_semi_bold_line_is_wider_and_a_larger_one_too() -> None:
    assert Type(20, 600).width(WORDS) > Type(20, 400).width(WORDS)
    assert Type(40).width(WORDS) == pytest.approx(2 * Type(20).width(WORDS), rel=0.06)


@pytest.mark.parametrize("text", ["Größe", "Размер", "→ ∞ ≤", "中 😀"])
def test_every_character_leaves_ink(text: str) -> None:
    canvas = Image.new("RGB", (200, 40), (255, 255, 255))
    write(ImageDraw.Draw(canvas), (10, 30), text, Type(24), (0, 0, 0))
    ink = np.asarray(canvas.convert("L")) < 128
    columns = np.flatnonzero(ink.any(axis=0))
    assert columns[0] >= 8
    assert columns[-1] <= 12 + Type(24).width(text)
    assert len(columns) > 5 * len(text.replace(" ", ""))
