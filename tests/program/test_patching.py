from __future__ import annotations

import json
from typing import Any

import pytest
from pydantic import JsonValue

from app.errors import (
    DocumentError,
    DocumentTooLarge,
    Fault,
    InconsistentDocument,
    InvalidDocument,
    PatchConflict,
    UnreadableDocument,
)
from app.program.digest import canonical
from app.program.merging import merged
from app.program.model import Program
from app.program.patching import apply_json_patch, apply_merge_patch
from app.settings import Settings
from tests.cost import check_costs_less

SETTINGS = Settings()

Operations = list[dict[str, Any]]


def patched(data: dict[str, Any], operations: Operations) -> dict[str, JsonValue]:
    """What a patch makes of the ``data`` of a program, where any JSON may stand."""
    program = Program.model_validate({"items": [], "data": {"it": data}})
    moved = [
        {
            key: "/data/it" + value if key in {"path", "from"} else value
            for key, value in operation.items()
        }
        for operation in operations
    ]
    made = apply_json_patch(canonical(program), json.dumps(moved).encode(), SETTINGS)
    it = made.data["it"]
    assert isinstance(it, dict)
    return it


def faults(
    operations: Any, error: type[DocumentError], document: dict[str, Any] | None = None
) -> tuple[Fault, ...]:
    program = Program.model_validate(
        document or {"items": [{"id": "a"}, {"id": "b"}], "data": {"z": 0}}
    )
    data = operations if isinstance(operations, bytes) else json.dumps(operations).encode()
    with pytest.raises(error) as raised:
        apply_json_patch(canonical(program), data, SETTINGS)
    return raised.value.faults


RFC_6902: list[tuple[str, dict[str, Any], Operations, dict[str, Any]]] = [
    (
        "A.1 adding an object member",
        {"foo": "bar"},
        [{"op": "add", "path": "/baz", "value": "qux"}],
        {"baz": "qux", "foo": "bar"},
    ),
    (
        "A.2 adding an array element",
        {"foo": ["bar", "baz"]},
        [{"op": "add", "path": "/foo/1", "value": "qux"}],
        {"foo": ["bar", "qux", "baz"]},
    ),
    (
        "A.3 removing an object member",
        {"baz": "qux", "foo": "bar"},
        [{"op": "remove", "path": "/baz"}],
        {"foo": "bar"},
    ),
    (
        "A.4 removing an array element",
        {"foo": ["bar", "qux", "baz"]},
        [{"op": "remove", "path": "/foo/1"}],
        {"foo": ["bar", "baz"]},
    ),
    (
        "A.5 replacing a value",
        {"baz": "qux", "foo": "bar"},
        [{"op": "replace", "path": "/baz", "value": "boo"}],
        {"baz": "boo", "foo": "bar"},
    ),
    (
        "A.6 moving a value",
        {"foo": {"bar": "baz", "waldo": "fred"}, "qux": {"corge": "grault"}},
        [{"op": "move", "from": "/foo/waldo", "path": "/qux/thud"}],
        {"foo": {"bar": "baz"}, "qux": {"corge": "grault", "thud": "fred"}},
    ),
    (
        "A.7 moving an array element",
        {"foo": ["all", "grass", "cows", "eat"]},
        [{"op": "move", "from": "/foo/1", "path": "/foo/3"}],
        {"foo": ["all", "cows", "eat", "grass"]},
    ),
    (
        "A.8 testing a value, with success",
        {"baz": "qux", "foo": ["a", 2, "c"]},
        [
            {"op": "test", "path": "/baz", "value": "qux"},
            {"op": "test", "path": "/foo/1", "value": 2},
        ],
        {"baz": "qux", "foo": ["a", 2, "c"]},
    ),
    (
        "A.10 adding a nested member object",
        {"foo": "bar"},
        [{"op": "add", "path": "/child", "value": {"grandchild": {}}}],
        {"foo": "bar", "child": {"grandchild": {}}},
    ),
    (
        "A.11 ignoring unrecognized elements",
        {"foo": "bar"},
        [{"op": "add", "path": "/baz", "value": "qux", "xyz": 123}],
        {"foo": "bar", "baz": "qux"},
    ),
    (
        "A.14 escape ordering",
        {"/": 9, "~1": 10},
        [{"op": "test", "path": "/~01", "value": 10}],
        {"/": 9, "~1": 10},
    ),
    (
        "A.16 adding an array value",
        {"foo": ["bar"]},
        [{"op": "add", "path": "/foo/-", "value": ["abc", "def"]}],
        {"foo": ["bar", ["abc", "def"]]},
    ),
    (
        "copying is no sharing",
        {"a": {"b": 1}},
        [
            {"op": "copy", "from": "/a", "path": "/c"},
            {"op": "replace", "path": "/c/b", "value": 2},
        ],
        {"a": {"b": 1}, "c": {"b": 2}},
    ),
]


@pytest.mark.parametrize(
    ("before", "operations", "after"),
    [case[1:] for case in RFC_6902],
    ids=[case[0] for case in RFC_6902],
)
def test_examples_of_rfc_6902(
    before: dict[str, Any], operations: Operations, after: dict[str, Any]
) -> None:
    assert patched(before, operations) == after


@pytest.mark.parametrize(
    ("before", "operation"),
    [
        ({"baz": "qux"}, {"op": "test", "path": "/baz", "value": "bar"}),  # A.9
        ({"foo": "bar"}, {"op": "add", "path": "/baz/bat", "value": "qux"}),  # A.12
        ({"/": 9, "~1": 10}, {"op": "test", "path": "/~01", "value": "10"}),  # A.15
        ({"a": 1}, {"op": "test", "path": "/a", "value": True}),
        ({"a": [0]}, {"op": "test", "path": "/a", "value": [False]}),
        ({"a": {"b": False}}, {"op": "test", "path": "/a", "value": {"b": 0}}),
        ({"a": [1, 2]}, {"op": "add", "path": "/a/3", "value": 3}),
        ({"a": [1, 2]}, {"op": "add", "path": "/a/01", "value": 3}),
        ({"a": [1, 2]}, {"op": "replace", "path": "/a/-", "value": 3}),
        ({"a": [1, 2]}, {"op": "remove", "path": "/a/-1"}),
        ({"a": [1, 2]}, {"op": "remove", "path": "/a/x"}),
        ({"a": "text"}, {"op": "add", "path": "/a/0", "value": 3}),
        ({"a": 1}, {"op": "replace", "path": "/b", "value": 3}),
        ({"a": 1}, {"op": "copy", "from": "/b", "path": "/c"}),
        ({"a": {"b": 1}}, {"op": "move", "from": "/a", "path": "/a/b"}),
        ({"a": 1}, {"op": "test", "path": "/b", "value": None}),
        ({"a": None}, {"op": "test", "path": "/a/b", "value": None}),
    ],
)
def test_an_operation_that_does_not_fit_is_a_conflict(
    before: dict[str, Any], operation: dict[str, Any]
) -> None:
    fine = {"op": "add", "path": "/new", "value": 1}
    with pytest.raises(PatchConflict) as raised:
        patched(before, [fine, operation])
    (fault,) = raised.value.faults
    assert fault.pointer == "/1"
    assert fault.detail


def test_numbers_that_are_equal_are_equal() -> None:
    assert patched({"a": 1}, [{"op": "test", "path": "/a", "value": 1.0}]) == {"a": 1}


@pytest.mark.parametrize(
    ("operations", "error", "place", "phrase"),
    [
        (b"[", UnreadableDocument, "", "JSON"),
        ({}, InvalidDocument, "", "list"),
        ([3], InvalidDocument, "/0", "object"),
        ([{"op": "put", "path": "/name"}], InvalidDocument, "/0/op", "'add'"),
        ([{"path": "/name"}], InvalidDocument, "/0", '"op"'),
        ([{"op": "add", "path": "/name"}], InvalidDocument, "/0/value", "missing"),
        ([{"op": "remove", "path": "name"}], InvalidDocument, "/0/path", ""),
        ([{"op": "remove", "path": "/a~2"}], InvalidDocument, "/0/path", ""),
        ([{"op": "copy", "path": "/name"}], InvalidDocument, "/0/from", "missing"),
        ([{"op": "remove", "path": ""}], PatchConflict, "/0", ""),
        (
            [{"op": "test", "path": "/items/0/id", "value": "z"}],
            PatchConflict,
            "/0",
            "/items/0/id",
        ),
        (
            [{"op": "remove", "path": "/items/7"}],
            PatchConflict,
            "/0",
            "no such place: /items/7",
        ),
        (
            [{"op": "replace", "path": "/items/1/id", "value": "a"}],
            InconsistentDocument,
            "/items/1/id",
            "unique",
        ),
        (
            [{"op": "add", "path": "/items/0/labl", "value": "x"}],
            InvalidDocument,
            "/items/0/labl",
            'mean "label"',
        ),
    ],
)
def test_what_is_wrong_is_said_where_it_is(
    operations: Any, error: type[DocumentError], place: str, phrase: str
) -> None:
    (fault,) = faults(operations, error)
    assert fault.pointer == place
    assert phrase in fault.detail


GROWING = [{"op": "add", "path": "/data/a", "value": [1] * 20}] + [
    {"op": "copy", "from": "/data", "path": f"/data/a{n}"} for n in range(60)
]
SINKING = [
    {"op": "add", "path": "/data/a", "value": {}},
    *(
        operation
        for n in range(400)
        for operation in (
            {"op": "move", "from": "/data/a", "path": "/data/b"},
            {"op": "add", "path": "/data/a", "value": {}},
            {"op": "move", "from": "/data/b", "path": "/data/a/b"},
        )
    ),
]
MANY_COPIES = [{"op": "add", "path": "/data/a", "value": [[1] * 100] * 100}] + [
    {"op": "copy", "from": "/data/a", "path": f"/data/c{n}"} for n in range(9_000)
]
COMPARISONS = [
    {"op": "add", "path": "/data/a", "value": [1] * 100_000},
    {"op": "test", "path": "/data/a/0", "value": 1},
    *({"op": "copy", "from": "/data/a", "path": "/data/b"} for _ in range(2_000)),
]

PATIENT = json.dumps([{"op": "replace", "path": "/data/z", "value": 1}] * 10_000).encode()
"""As many operations as a patch may have, all of which are done."""


@pytest.mark.parametrize(
    ("operations", "error"),
    [
        (GROWING, DocumentTooLarge),
        (SINKING, DocumentTooLarge),
        (MANY_COPIES, DocumentTooLarge),
        (COMPARISONS, DocumentTooLarge),
        ([{"op": "remove", "path": "/items/0"}] * 10_001, InvalidDocument),
        ([{"op": "remove", "path": "/a" * 5_001}], InvalidDocument),
        ([{"op": "remove", "path": "/0" * 5_000}], PatchConflict),
        (b'[{"op": "add", "path": "/data/a", "value": ' + b"[" * 300 + b"]" * 300 + b"}]",
         UnreadableDocument),
    ],
    ids=["growing", "sinking", "copies", "comparisons", "many", "long", "deep path", "deep value"],
)  # fmt: skip
def test_bombs_are_refused_quickly(operations: Any, error: type[DocumentError]) -> None:
    small = Settings(max_values=200_000)
    data = operations if isinstance(operations, bytes) else json.dumps(operations).encode()
    document = b'{"items":[{"id":"a"}],"data":{"z":0}}'

    def refuse() -> None:
        with pytest.raises(error):
            apply_json_patch(document, data, small)

    check_costs_less(refuse, lambda: apply_json_patch(document, PATIENT, small), times=3)


RFC_7396: list[tuple[JsonValue, JsonValue, JsonValue]] = [
    ({"a": "b"}, {"a": "c"}, {"a": "c"}),
    ({"a": "b"}, {"b": "c"}, {"a": "b", "b": "c"}),
    ({"a": "b"}, {"a": None}, {}),
    ({"a": "b", "b": "c"}, {"a": None}, {"b": "c"}),
    ({"a": ["b"]}, {"a": "c"}, {"a": "c"}),
    ({"a": "c"}, {"a": ["b"]}, {"a": ["b"]}),
    ({"a": {"b": "c"}}, {"a": {"b": "d", "c": None}}, {"a": {"b": "d"}}),
    ({"a": [{"b": "c"}]}, {"a": [1]}, {"a": [1]}),
    (["a", "b"], ["c", "d"], ["c", "d"]),
    ({"a": "b"}, ["c"], ["c"]),
    ({"a": "foo"}, None, None),
    ({"a": "foo"}, "bar", "bar"),
    ({"e": None}, {"a": 1}, {"e": None, "a": 1}),
    ([1, 2], {"a": "b", "c": None}, {"a": "b"}),
    ({}, {"a": {"bb": {"ccc": None}}}, {"a": {"bb": {}}}),
]


@pytest.mark.parametrize(("target", "patch", "result"), RFC_7396)
def test_examples_of_rfc_7396(target: JsonValue, patch: JsonValue, result: JsonValue) -> None:
    before = json.dumps([target, patch])
    assert merged(target, patch) == result
    assert json.dumps([target, patch]) == before, "neither is changed"


def test_the_long_example_of_rfc_7396() -> None:
    target: JsonValue = {
        "title": "Goodbye!",
        "author": {"givenName": "John", "familyName": "Doe"},
        "tags": ["example", "sample"],
        "content": "This will be unchanged",
    }
    patch: JsonValue = {
        "title": "Hello!",
        "phoneNumber": "+01-123-456-7890",
        "author": {"familyName": None},
        "tags": ["example"],
    }
    assert merged(target, patch) == {
        "title": "Hello!",
        "author": {"givenName": "John"},
        "tags": ["example"],
        "content": "This will be unchanged",
        "phoneNumber": "+01-123-456-7890",
    }


def test_a_merge_patch_changes_what_differs_of_a_program() -> None:
    program = Program.model_validate(
        {"name": "old", "items": [{"id": "a"}], "style": {"palette": "tol", "labels": False}}
    )
    patch = b'{"name": null, "style": {"labels": null, "halo": 0}}'
    made = apply_merge_patch(canonical(program), patch, SETTINGS)
    assert (made.name, made.items) == (None, program.items)
    assert (made.style.palette, made.style.labels, made.style.halo) == ("tol", True, 0)


@pytest.mark.parametrize(
    ("patch", "error", "place"),
    [
        (b"[]", InvalidDocument, ""),
        (b"{", UnreadableDocument, ""),
        (b'{"items": null}', InvalidDocument, "/items"),
        (b'{"items": [{"id": "a", "parent": "z"}]}', InconsistentDocument, "/items/0/parent"),
        (b'{"style": {"halo": -1}}', InvalidDocument, "/style/halo"),
        (b'{"data": {"a": ' + b"[" * 300 + b"]" * 300 + b"}}", UnreadableDocument, ""),
    ],
)
def test_a_merge_patch_that_makes_no_program_is_refused(
    patch: bytes, error: type[DocumentError], place: str
) -> None:
    program = Program.model_validate({"items": [{"id": "a"}]})
    with pytest.raises(error) as raised:
        apply_merge_patch(canonical(program), patch, SETTINGS)
    assert raised.value.faults[0].pointer == place
