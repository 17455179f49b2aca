import json
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.errors import DocumentError, Fault, InvalidDocument, UnreadableDocument
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
        (item(shape={"type": "cube"}), "/items/0/shape", "'box'"),
        (item(shape={}), "/items/0/shape", '"type"'),
        (item(shape={"type": "sphere", "radius": 0}), "/items/0/shape/radius", "at least 0.001"),
        (
            item(shape={"type": "box", "size": [1, 1, -1]}),
            "/items/0/shape/size/2",
            "at least 0.001",
        ),
        (item(shape={"type": "box", "radius": 1}), "/items/0/shape/radius", "Unknown key"),
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


def test_all_faults_come_at_once() -> None:
    found = faults({"items": [{"id": "a", "color": "red", "labl": 1}, {}], "extra": 1})
    assert {fault.pointer for fault in found} == {
        "/items/0/color", "/items/0/labl", "/items/1/id", "/extra",
    }  # fmt: skip


def test_of_very_many_faults_the_first_hundred_are_told() -> None:
    found = faults({"items": [{"id": "a", f"k{n}": 1} for n in range(500)]})
    assert len(found) == 101
    assert "400 more" in found[-1].detail


@pytest.mark.parametrize(
    "data",
    [b"", b"{", b'{"items": [}', b"\xff\xfe", b"[" * 10_000 + b"]" * 10_000, b'{"items": [] x}'],
    ids=["empty", "open", "syntax", "not UTF-8", "deep", "trailing"],
)
def test_what_is_not_json_is_unreadable(data: bytes) -> None:
    assert faults(data, UnreadableDocument)[0].detail


@pytest.mark.parametrize("number", [b"NaN", b"Infinity", b"-Infinity", b"1e400"])
def test_numbers_that_are_not_finite_are_refused(number: bytes) -> None:
    with pytest.raises(DocumentError):
        read_program(b'{"items": [{"id": "a", "position": [0, %s, 0]}]}' % number, SETTINGS)


def test_numbers_that_are_not_finite_are_refused_in_free_data_too() -> None:
    with pytest.raises(DocumentError):
        read_program(b'{"items": [{"id": "a", "data": {"x": [NaN]}}]}', SETTINGS)


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
