from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from PIL import Image

from app.output.sheet import Sheet

COLORS = [(200, 30, 30), (30, 160, 40), (40, 60, 200), (180, 160, 20), (150, 40, 160)]


def pixels(picture: Image.Image) -> NDArray[np.int64]:
    return np.asarray(picture.convert("RGB")).astype(np.int64)


def filled(plan: Sheet, count: int) -> list[Image.Image]:
    return [Image.new("RGB", plan.cell, color) for color in COLORS[:count]]


def place_of(picture: NDArray[np.int64], color: tuple[int, int, int]) -> tuple[int, int, int, int]:
    """Left, top, right and bottom of a colour."""
    rows, columns = np.nonzero((picture == color).all(axis=-1))
    return columns.min(), rows.min(), columns.max() + 1, rows.max() + 1


@settings(max_examples=40)
@given(
    st.integers(300, 1600), st.integers(300, 1200), st.integers(1, 5), st.integers(1, 5),
    st.booleans(), st.booleans(),
)  # fmt: skip
def test_pictures_stand_whole_and_apart_within_a_sheet_of_the_size_asked_for(
    width: int, height: int, columns: int, count: int, titled: bool, named: bool
) -> None:
    rows = -(-count // columns)
    title = "A title" if titled else None
    plan = Sheet(width, height, rows, columns, names_rows=named, title=title)
    made = plan.of(filled(plan, count), ["caption"] * count, ["name"] * rows)
    assert made.size == (width, height)
    shown = pixels(made)
    places = [place_of(shown, color) for color in COLORS[:count]]
    for left, top, right, bottom in places:
        assert (right - left, bottom - top) == plan.cell
        assert min(left, top, width - right, height - bottom) >= 10
    for one in range(count):
        for other in range(one):
            if one // columns == other // columns:
                assert places[one][0] > places[other][2]
            else:
                assert places[one][1] > places[other][3]


def test_captions_stand_under_their_pictures_and_rules_between_them() -> None:
    plan = Sheet(600, 400, 2, 2)
    shown = pixels(plan.of(filled(plan, 4), ["One", "Two", "Three", "Four"]))
    left, _, right, bottom = place_of(shown, COLORS[0])
    assert shown[bottom + 2 : bottom + 18, left : left + 40].min() < 140
    between = shown[50:150, right : place_of(shown, COLORS[1])[0]].min(axis=2)
    assert (between.min(axis=1) < 235).all(), "a rule from top to bottom"
    assert between.min() > 200, "and a faint one"


def test_names_stand_over_columns_and_beside_rows() -> None:
    plan = Sheet(600, 400, 2, 2, names_rows=True)
    captions = ["halo = 0", "halo = 1"] * 2
    shown = pixels(plan.of(filled(plan, 4), captions, ["margin = 0", "margin = 1"]))
    first, last = place_of(shown, COLORS[0]), place_of(shown, COLORS[3])
    assert shown[: first[1], first[0] : first[2]].min() < 140
    assert shown[last[1] : last[3], : first[0] - 10].min() < 140
    assert shown[last[3] :].min() > 140, "columns are named once"


def test_on_black_one_writes_in_white() -> None:
    plan = Sheet(400, 300, 1, 1, "#000", title="Title")
    shown = pixels(plan.of(filled(plan, 1), ["caption"]))
    assert shown[:40].max() > 200
    assert shown[0, 0].tolist() == [0, 0, 0]


def test_long_texts_are_shortened_to_their_place() -> None:
    plan = Sheet(400, 300, 1, 2, names_rows=True, title="t" * 500)
    shown = pixels(plan.of(filled(plan, 2), ["c" * 500] * 2, ["r" * 500]))
    assert (shown[:, 390:] == 255).all()
    left = place_of(shown, COLORS[0])[0]
    assert (shown[50:, left - 4 : left] > 140).all(), "names keep off the pictures"


def test_transparent_pictures_show_the_paper() -> None:
    plan = Sheet(200, 200, 1, 1, "#ffeedd")
    clear = Image.new("RGBA", plan.cell, (0, 0, 0, 0))
    assert (pixels(plan.of([clear], [])) == [0xFF, 0xEE, 0xDD]).all()


@pytest.mark.parametrize(("width", "height"), [(1, 1), (40, 30), (100, 2000)])
@pytest.mark.parametrize("named", [False, True])
def test_the_smallest_sheets_are_sheets(width: int, height: int, named: bool) -> None:
    plan = Sheet(width, height, 2, 3, names_rows=named, title="Title")
    assert plan.of(filled(plan, 5), ["c"] * 5, ["r"] * 2).size == (width, height)
