import gc
import json
import re
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.errors import DocumentError, DocumentTooLarge, Fault, InvalidDocument, UnreadableDocument
from app.program.digest import canonical
from app.program.reading import read_program
from app.settings import Settings

SETTINGS = Settings()


def faults(document: Any, error: type[DocumentError] = InvalidDocument) -> tuple[Fault, ...]:
    data = document if isinstance(document, bytes) else json.dumps(document).encode()
    with pytest.raises(error) as raised:
        read_program(data, SETTINGS)
    return raised.value.faults


def item(**more: Any) -> dict[str, Any]:
    return {"items": [{"id": "a", **more}]}


@pytest.mark.parametrize(
    ("document", "place", "phrase"),
    [
        ({}, "/items", "missing"),
        ({"items": [], "hyperedge": []}, "/hyperedge", 'Did you mean "hyperedges"?'),
        (item(labl="x"), "/items/0/labl", 'Did you mean "label"?'),
        (item(id=7), "/items/0/id", "string, not 7"),
        (item(id=""), "/items/0/id", "empty"),
        (item(position=[0, 0]), "/items/0/position/2", "missing"),
        (item(position=[0, 0, 0, 0]), "/items/0/position", "at most 3"),
        (item(position=["0", 0, 0]), "/items/0/position/0", "number"),
        (item(position=[True, 0, 0]), "/items/0/position/0", "number, not true"),
        (item(position=[0, 1e308, 0]), "/items/0/position/1", "at most 1e+06"),
        (item(shape={"type": "cube"}), "/items/0/shape/type", "'box'"),
        (item(shape={"type": ["box"]}), "/items/0/shape/type", "not a list"),
        (item(shape={}), "/items/0/shape", '"type"'),
        (item(shape={"type": "sphere", "radius": 0}), "/items/0/shape/radius", "at least 0.001"),
        (
            item(shape={"type": "box", "size": [1, 1, -1]}),
            "/items/0/shape/size/2",
            "at least 0.001",
        ),
        (item(shape={"type": "box", "sizes": 1}), "/items/0/shape/sizes", 'mean "size"?'),
        (item(attachments=[]), "/items/0/attachments", 'Did you mean "attachment_points"?'),
        ({"items": [], "view": {"from_": [0, 0, 1]}}, "/view/from_", 'Did you mean "from"?'),
        (item(position=[10**400, 0, 0]), "/items/0/position/0", "64 bits"),
        (item(rotation=["90", 0, 0]), "/items/0/rotation/0", 'a number, not "90"'),
        (item(**{"a/b~": 1}), "/items/0/a~1b~0", "Unknown key."),
        (
            {"items": [], "style": {"background": "red"}},
            "/style/background",
            "colour such as #rrggbb or 'transparent', not \"red\"",
        ),
        ({"items": [], "style": {"labels": 1}}, "/style/labels", "true or false, not 1"),
        ([], "", "an object, not a list"),
        (None, "", "an object, not null"),
        ({"items": {}}, "/items", "a list, not an object"),
        (item(label="x" * 1_000_000), "/items/0/label", "at most 500"),
        (item(color="x" * 1_000_000), "/items/0/color", "x…"),
        (item(color="red"), "/items/0/color", "#rrggbb"),
        (item(material="cheese"), "/items/0/material", "'glass'"),
        (item(label="x" * 501), "/items/0/label", "at most 500"),
        ({"items": [], "view": {"field_of_view": 0}}, "/view/field_of_view", "at least 1"),
        (
            {"items": [], "hyperedges": [{"id": "e", "attachments": [{"item": "a"}]}]},
            "/hyperedges/0/attachments",
            "at least 2",
        ),
    ],
)
def test_a_fault_names_its_place_and_what_would_be_right(
    document: Any, place: str, phrase: str
) -> None:
    found = faults(document)
    assert [fault.pointer for fault in found] == [place]
    assert phrase in found[0].detail


def test_a_key_of_another_part_is_not_what_was_meant() -> None:
    assert faults(item(shape={"type": "box", "radius": 1})) == (
        Fault("/items/0/shape/radius", "Unknown key."),
    )


def test_the_place_is_right_where_a_key_is_called_like_a_type() -> None:
    shape = {"type": "box", "box": {"size": 1}, "size": [1, 1, -1]}
    assert {fault.pointer for fault in faults(item(shape=shape))} == {
        "/items/0/shape/box",
        "/items/0/shape/size/2",
    }


def test_a_list_is_not_called_too_short_because_its_entries_are_wrong() -> None:
    ends = [{"item": ""}, {"item": "a", "point": ""}]
    found = faults({"items": [{"id": "a"}], "hyperedges": [{"id": "e", "attachments": ends}]})
    assert {fault.pointer for fault in found} == {
        "/hyperedges/0/attachments/0/item",
        "/hyperedges/0/attachments/1/point",
    }


def test_all_faults_come_at_once() -> None:
    found = faults({"items": [{"id": "a", "color": "red", "labl": 1}, {}], "extra": 1})
    assert {fault.pointer for fault in found} == {
        "/items/0/color", "/items/0/labl", "/items/1/id", "/extra",
    }  # fmt: skip


def test_of_very_many_faults_the_first_hundred_are_told() -> None:
    found = faults({"items": [{"id": "a", f"k{n}": 1} for n in range(500)]})
    assert len(found) == 101
    assert "400 more" in found[-1].detail


def test_of_a_hundred_thousand_faults_the_last_are_not_looked_for() -> None:
    ends = [{"item": 0}] * 100_000
    found = faults({"items": [], "hyperedges": [{"id": "e", "attachments": ends}]})
    assert len(found) == 101
    assert found[-1].detail == "And at least 900 more faults."


def test_one_object_with_thousands_of_keys_is_one_fault() -> None:
    found = faults({"items": [], "style": {str(number): 1 for number in range(5_000)}})
    assert [fault.pointer for fault in found] == ["/style"]


@pytest.mark.parametrize(
    ("document", "place"),
    [
        (b'{"items":[' + b"0," * 2_500_000 + b"0]}", ""),
        (b'{"items":[' + b"0," * 20_000 + b"0]}", "/items"),
        (b'{"items":[],"hyperedges":[' + b"0," * 100_000 + b"0]}", "/hyperedges"),
        (
            b'{"items":[],"hyperedges":[{"id":"e","attachments":[' + b"0," * 400_000 + b"0]}]}",
            "/hyperedges",
        ),
    ],
    ids=["values", "items", "hyperedges", "attachments"],
)
def test_what_is_too_much_is_refused_before_it_is_looked_at(document: bytes, place: str) -> None:
    found = faults(document, DocumentTooLarge)
    assert [fault.pointer for fault in found] == [place]
    assert "limit" in found[0].detail


@pytest.mark.parametrize(
    "data",
    [b"", b"{", b'{"items": [}', b"\xff\xfe", b"[" * 10_000 + b"]" * 10_000, b'{"items": [] x}'],
    ids=["empty", "open", "syntax", "not UTF-8", "deep", "trailing"],
)
def test_what_is_not_json_is_unreadable(data: bytes) -> None:
    assert re.search(r"at line \d+ column \d+", faults(data, UnreadableDocument)[0].detail)


def test_a_syntax_error_is_named_by_line_and_column() -> None:
    found = faults(b'{"items": [\n  {"id": "a"},\n]}', UnreadableDocument)
    assert found == (Fault("", "Not JSON: trailing comma at line 3 column 1."),)


@pytest.mark.parametrize("number", [b"NaN", b"Infinity", b"-Infinity"])
@pytest.mark.parametrize("place", [b'"items": [], "name"', b'"x"', b'"items": [], "data"'])
def test_what_is_not_a_number_is_not_json(number: bytes, place: bytes) -> None:
    assert faults(b"{%s: %s}" % (place, number), UnreadableDocument)


def test_a_number_beyond_floats_is_refused_where_a_float_goes_out() -> None:
    found = faults(b'{"items": [{"id": "a", "position": [0, 1e400, 0]}], "data": {"x": [1e400]}}')
    assert {fault.pointer for fault in found} == {"/items/0/position/1", "/data"}


def test_keys_that_repeat_are_all_named() -> None:
    data = (
        b'{"items": [{"id": "a", "id": "b", "data": {"x": [0, {"y": 1, "y": 1}]}}],'
        b' "name": 1, "name": 2, "name": 3}'
    )
    found = faults(data, UnreadableDocument)
    assert [fault.pointer for fault in found] == ["/name", "/items/0/id", "/items/0/data/x/1/y"]
    assert "more than once" in found[0].detail


def test_a_repeated_key_is_found_beside_escaped_colons() -> None:
    data = rb'{"items": [], "name": "a", "name": "\u003a", "data": {"\u003a": 1}}'
    assert [fault.pointer for fault in faults(data, UnreadableDocument)] == ["/name"]
    assert read_program(rb'{"items": [], "name": "a:\u003a\\u003"}', SETTINGS).name == "a::\\u003"


def test_a_byte_order_mark_is_passed_over() -> None:
    assert read_program(b'\xef\xbb\xbf{"items": []}', SETTINGS).items == ()


def test_free_data_may_be_deep_and_its_whole_numbers_large() -> None:
    deep: Any = 10**400
    for _ in range(95):
        deep = {"x": [deep]}
    document = item(data={"big": 10**4000, "deep": deep})
    program = read_program(json.dumps(document).encode(), SETTINGS)
    assert json.loads(canonical(program)) == document


def test_a_whole_number_of_more_digits_than_anybody_reads_is_refused() -> None:
    assert "out of range" in faults(b'{"items": [], "data": {"x": %s}}' % (b"1" * 5_000),
                                    UnreadableDocument)[0].detail  # fmt: skip


def test_reading_leaves_the_collector_as_it_was() -> None:
    faults([])
    assert gc.isenabled()
    gc.disable()
    try:
        read_program(b'{"items": []}', SETTINGS)
        assert not gc.isenabled()
    finally:
        gc.enable()


json_values = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(),
    lambda inner: st.lists(inner) | st.dictionaries(st.text(), inner),
    max_leaves=20,
)


@given(json_values | st.fixed_dictionaries({"items": json_values, "hyperedges": json_values}))
def test_any_json_value_is_a_program_or_a_document_error(value: Any) -> None:
    try:
        program = read_program(json.dumps(value).encode(), SETTINGS)
    except DocumentError:
        return
    assert canonical(program)


@given(st.binary(max_size=60))
def test_any_bytes_are_a_program_or_a_document_error(data: bytes) -> None:
    with pytest.raises(DocumentError):
        read_program(data, SETTINGS)
