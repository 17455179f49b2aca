from __future__ import annotations

import io
from xml.etree import ElementTree as ET

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from PIL import Image

from app.output.error_picture import error_picture

TITLE = "The document does not follow its schema."
LINES = [
    "/items/3/shape/radius: Input should be greater than 0.",
    '/hyperedges/0/attachments/2/item: There is no item "node-17".',
    "Something without a place.",
]
SIZES = [(200, 100), (320, 240), (1024, 768), (2048, 2048), (2000, 100), (100, 1000)]


def texts(svg: bytes) -> list[str]:
    root = ET.fromstring(svg)
    return [node.text or "" for node in root.iter("{http://www.w3.org/2000/svg}text")]


@pytest.mark.parametrize(("width", "height"), SIZES)
def test_a_card_has_the_size_asked_for_and_legible_ink_within_its_frame(
    width: int, height: int
) -> None:
    picture = Image.open(io.BytesIO(error_picture(TITLE, LINES, width, height, as_svg=False)))
    assert (picture.format, picture.size) == ("PNG", (width, height))
    ink = np.asarray(picture.convert("L")) < 90
    rows, columns = np.nonzero(ink)
    assert len(rows) > 100
    assert columns.min() > 4
    assert columns.max() < width - 4
    assert rows.min() > 4
    assert rows.max() < height - 4


@pytest.mark.parametrize(("width", "height"), SIZES)
def test_drawn_lines_stand_under_each_other_within_the_picture(width: int, height: int) -> None:
    root = ET.fromstring(error_picture(TITLE, LINES * 20, width, height, as_svg=True))
    lines = list(root.iter("{http://www.w3.org/2000/svg}text"))
    places = [float(line.get("y", "nan")) for line in lines]
    assert places == sorted(set(places))
    assert places[-1] < height


def test_all_faults_are_told_where_there_is_room() -> None:
    told = texts(error_picture(TITLE, LINES, 1024, 768, as_svg=True))
    assert told[0] == TITLE
    assert "/items/3/shape/radius" in told
    assert "Input should be greater than 0." in told
    assert "Something without a place." in told
    assert not any("more" in line for line in told)


def test_faults_without_room_are_counted() -> None:
    told = texts(error_picture(TITLE, LINES * 30, 640, 480, as_svg=True))
    shown = sum("Something" in line or line.startswith("/") for line in told)
    assert told[-1] == f"and {90 - shown} more"
    told = texts(error_picture("Wrong", LINES, 200, 60, as_svg=True))
    assert told[-1] in {"3 faults", "and 2 more"}


def test_a_fault_too_long_for_the_picture_is_cut_with_an_ellipsis() -> None:
    told = texts(error_picture("Wrong", ["word " * 400], 300, 120, as_svg=True))
    assert told[-1].endswith("…")


@settings(max_examples=30)
@given(st.text(max_size=60), st.lists(st.text(max_size=120), max_size=4))
def test_any_text_makes_a_picture(title: str, lines: list[str]) -> None:
    ET.fromstring(error_picture(title, lines, 240, 160, as_svg=True))
    png = error_picture(title, lines, 240, 160, as_svg=False)
    assert Image.open(io.BytesIO(png)).size == (240, 160)


def test_markup_stays_text() -> None:
    hostile = '/a: </text><script>alert(1)</script><image href="http://example.org"/>&\x00\ud800'
    svg = error_picture(hostile, [hostile], 800, 600, as_svg=True)
    names = {node.tag.rpartition("}")[2] for node in ET.fromstring(svg).iter()}
    assert names == {"svg", "rect", "text"}


def test_the_same_faults_are_the_same_bytes() -> None:
    for as_svg in (True, False):
        one, other = (error_picture(TITLE, LINES, 400, 300, as_svg) for _ in range(2))
        assert one == other
