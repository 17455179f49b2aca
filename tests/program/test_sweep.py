from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import JsonValue

from app.errors import ImpossibleSweep
from app.program.model import Program
from app.program.reading import read_program
from app.program.shapes import Sphere
from app.program.sweep import MOST_VALUES, Axis, parse_axis, vary
from app.settings import Settings

DOCUMENT = b"""{"items": [{"id": "a"}, {"id": "b", "shape": {"type": "sphere"}}, {"id": "c"}],
  "hyperedges": [{"id": "e", "attachments": [{"item": "a"}, {"item": "b"}]},
                 {"id": "f", "attachments": [{"item": "a"}, {"item": "c"}]}],
  "view": {"margin": 0.2}}"""


@pytest.fixture
def program() -> Program:
    return read_program(DOCUMENT, Settings())


def fault_of(program: Program, *axes: str) -> str:
    with pytest.raises(ImpossibleSweep) as caught:
        varied(program, *axes)
    first = caught.value.faults[0]
    return f"{first.pointer}: {first.detail}"


def varied(program: Program, *axes: str) -> tuple[tuple[Program, ...], ...]:
    return vary(program, [parse_axis(axis) for axis in axes], Settings())


def test_one_axis_goes_across(program: Program) -> None:
    (row,) = varied(program, "/style/halo=0,0.3,0.6")
    assert [one.style.halo for one in row] == [0, 0.3, 0.6]


@pytest.mark.parametrize(("count", "lengths"), [(1, [1]), (4, [2, 2]), (5, [3, 2]), (6, [3, 3])])
def test_many_values_of_one_axis_make_two_rows(
    program: Program, count: int, lengths: list[int]
) -> None:
    values = [number / 10 for number in range(count)]
    rows = vary(program, [Axis("/style/halo", tuple(values))], Settings())
    assert [len(row) for row in rows] == lengths
    assert [one.style.halo for row in rows for one in row] == values


def test_two_axes_make_rows(program: Program) -> None:
    rows = varied(program, "/view/margin=0,0.1", "/view/from=[0,-1,0.5],[0,0,1]")
    assert [[(one.view.margin, one.view.from_) for one in row] for row in rows] == [
        [(0, (0, -1, 0.5)), (0.1, (0, -1, 0.5))],
        [(0, (0, 0, 1)), (0.1, (0, 0, 1))],
    ]


def test_an_axis_has_captions() -> None:
    assert parse_axis("/view/margin=0,0.1").captions == ("margin = 0", "margin = 0.1")
    assert parse_axis("/view/from=[0,-1,0.5]").captions == ("from = [0, -1, 0.5]",)
    assert parse_axis("/items/0/label=" + "x" * 99).captions[0].endswith("x…")


def test_a_star_stands_for_every_member(program: Program) -> None:
    (row,) = varied(program, "/hyperedges/*/radius=0.05,0.1")
    assert [[hyperedge.radius for hyperedge in one.hyperedges] for one in row] == [
        [0.05, 0.05],
        [0.1, 0.1],
    ]


def test_a_number_is_a_place_in_a_list(program: Program) -> None:
    (row,) = varied(program, "/items/1/shape/radius=1,2")
    shapes = [one.items[1].shape for one in row]
    assert [shape.radius for shape in shapes if isinstance(shape, Sphere)] == [1, 2]


def test_all_else_stays_as_it_was(program: Program) -> None:
    assert varied(program, "/view/margin=0.2") == ((program,),)


def test_values_are_json_and_words_need_no_quotes() -> None:
    assert parse_axis("/items/*/material=glass, wood").values == ("glass", "wood")
    assert parse_axis('/style/background="#fff","a,b"').values == ("#fff", "a,b")
    assert parse_axis('/a={"b":[1,2]},null,true,-1e3').values == ({"b": [1, 2]}, None, True, -1e3)
    assert parse_axis(r'/a="\"],",2').values == ('"],', 2)
    assert parse_axis("/a=x=y").values == ("x=y",)


def test_names_are_unescaped() -> None:
    assert Axis("/data/a~1b~0c", (1,)).captions == ("a/b~c = 1",)


@pytest.mark.parametrize("text", ["nonsense", "", "=1", "style/halo=1", "/style/halo="])
def test_what_is_no_axis_is_refused(text: str) -> None:
    with pytest.raises(ImpossibleSweep):
        parse_axis(text)


def test_too_many_values_are_refused() -> None:
    values = ",".join(map(str, range(MOST_VALUES + 1)))
    with pytest.raises(ImpossibleSweep, match="7 values"):
        parse_axis(f"/style/halo={values}")


def test_a_pointer_to_nothing_is_refused_with_the_place_where_it_ends(program: Program) -> None:
    assert fault_of(program, "/no/such=1,2").startswith("/no: There is nothing")
    assert fault_of(program, "/items/7/label=x").startswith("/items/7:")
    assert fault_of(program, "/items/0/shape/radius=1").startswith("/items/0/shape/radius:")
    assert fault_of(program, "/items/*/attachment_points/*/id=x").endswith("varied.")


def test_an_unknown_key_and_a_wrong_value_are_refused_as_in_any_document(program: Program) -> None:
    assert "/style/hallo" in fault_of(program, "/style/hallo=1")
    wrong = fault_of(program, "/style/halo=0.1,-1")
    assert wrong.startswith("/style/halo:")
    assert wrong.endswith("(With halo = -1.)")


def test_a_variation_that_contradicts_itself_is_refused(program: Program) -> None:
    assert "no item" in fault_of(program, "/hyperedges/0/attachments/0/item=c,nobody")


def test_limits_hold_for_variations_too(program: Program) -> None:
    many: JsonValue = [{"id": str(number)} for number in range(9)]
    with pytest.raises(ImpossibleSweep):
        vary(program, [Axis("/items", (many,))], Settings(max_items=5))


def test_axes_that_vary_the_same_place_are_refused(program: Program) -> None:
    assert "varied" in fault_of(program, "/view=1", "/view/margin=0.1")
    assert "varied" in fault_of(program, "/items/*/label=a", "/items/0/label=b")


@pytest.mark.parametrize("count", [0, 3])
def test_one_or_two_axes_are_swept(program: Program, count: int) -> None:
    with pytest.raises(ImpossibleSweep, match="one or two"):
        vary(program, [Axis("/style/halo", (1,))] * count, Settings())


@given(st.text(max_size=40))
def test_any_text_is_an_axis_or_is_refused(text: str) -> None:
    try:
        axis = parse_axis("/" + text)
    except ImpossibleSweep:
        return
    assert axis.values
    assert len(axis.captions) == len(axis.values)


def test_values_nested_too_deeply_are_words() -> None:
    deep = "[" * 5000 + "]" * 5000
    assert parse_axis(f"/a={deep}").values == (deep,)
