from __future__ import annotations

import json

import pytest

from app.errors import InvalidSweep
from app.program.model import Program
from app.program.reading import read_program
from app.program.sweep import parse_axis, vary
from app.settings import Settings

DOCUMENT = {
    "items": [{"id": "a"}, {"id": "b"}],
    "hyperedges": [{"id": "e", "attachments": [{"item": "a"}, {"item": "b"}]}],
}


def program() -> Program:
    return read_program(json.dumps(DOCUMENT).encode(), Settings())


def test_rows_are_the_second_axis_and_columns_the_first() -> None:
    axes = [parse_axis("/style/halo=0,0.5,1"), parse_axis("/view/from=[0,-1,1],[1,0,1]")]
    rows = vary(program(), axes, Settings())
    assert [[cell.style.halo for cell in row] for row in rows] == [[0, 0.5, 1]] * 2
    assert [row[0].view.from_ for row in rows] == [(0, -1, 1), (1, 0, 1)]


def test_a_star_stands_for_every_member() -> None:
    axis = parse_axis("/hyperedges/*/radius=0.1")
    ((cell,),) = vary(program(), [axis], Settings())
    assert [hyperedge.radius for hyperedge in cell.hyperedges] == [0.1]


def test_a_word_without_quotes_is_a_string_and_captions_say_it() -> None:
    axis = parse_axis("/style/palette=glasbey,okabe-ito")
    assert axis.captions == ["palette: glasbey", "palette: okabe-ito"]


@pytest.mark.parametrize(
    "text", ["", "halo", "style/halo=1", "/style/halo=", "/style/halo=1,2,3,4,5,6,7"]
)
def test_what_is_no_sweep_is_refused(text: str) -> None:
    with pytest.raises(InvalidSweep):
        parse_axis(text)


@pytest.mark.parametrize(
    "text",
    [
        "/style/halo=-1",
        "/style/hallo=1",
        "/items/7/label=a",
        "/items/x/label=a",
        "/items/0/id/x=a",
        "/items=1",
        "/items/0/parent=nobody",
    ],
)
def test_a_value_that_is_wrong_there_is_refused_with_its_place(text: str) -> None:
    with pytest.raises(InvalidSweep) as caught:
        vary(program(), [parse_axis(text)], Settings())
    assert caught.value.faults[0].pointer
