import json
from typing import Any

import pytest

from app.errors import (
    DocumentError,
    DocumentTooLarge,
    Fault,
    InconsistentDocument,
    InvalidDocument,
    UnreadableDocument,
)
from app.formats.registry import read
from app.program.digest import canonical
from app.settings import Settings
from tests.cost import check_costs_less

SETTINGS = Settings()
BALL = {"type": "sphere", "radius": 1}
BOX = {"type": "box", "size": [1, 1, 1]}
HALF = {"type": "half_space", "normal": [0, 0, 1]}


def document(*trees: Any) -> bytes:
    items = [
        {"id": str(number), "shape": {"type": "csg", "tree": tree}}
        for number, tree in enumerate(trees)
    ]
    return json.dumps({"items": items}).encode()


def faults(data: bytes, error: type[DocumentError]) -> tuple[Fault, ...]:
    with pytest.raises(error) as raised:
        read("tubeloom", data, SETTINGS)
    return raised.value.faults


def check_is_refused_soon(data: bytes) -> None:
    """Check that this costs no more than reading a plain list of as many bytes, a few times."""
    plain = b"[" + b"1," * (len(data) // 2) + b"1]"

    def refuse() -> None:
        with pytest.raises(DocumentError):
            read("tubeloom", data, SETTINGS)

    check_costs_less(refuse, lambda: json.loads(plain), times=5)


def op(kind: str, *of: Any) -> dict[str, Any]:
    return {"type": kind, "of": list(of)}


def nested(levels: int) -> bytes:
    opening, closing = b'{"type":"union","of":[', b"]}"
    inner = json.dumps(BALL).encode()
    tree = opening * (levels - 1) + inner + closing * (levels - 1)
    return b'{"items":[{"id":"a","shape":{"type":"csg","tree":' + tree + b"}}]}"


def test_a_tree_is_read_with_every_kind_of_node() -> None:
    cone = {"type": "cone", "radius": 1, "height": 2, "top_radius": 0.5, "rotation": [90, 0, 0]}
    rod = {"type": "cylinder", "radius": 1, "height": 2, "position": [1, 2, 3]}
    tree = op("difference", op("union", BALL, BOX, cone), op("intersection", rod, HALF))
    program = read("tubeloom", document(tree), SETTINGS)
    assert read("tubeloom", canonical(program), SETTINGS) == program
    assert len({program.items[0].shape}) == 1


@pytest.mark.parametrize(
    ("tree", "place", "phrase"),
    [
        (op("onion", BALL), "/type", "'half_space'"),
        (op("union"), "/of", "at least 1"),
        (op("union", BALL, {"type": "sphere"}), "/of/1/radius", "missing"),
        (op("union", op("union", {**BALL, "at": [1, 2, 3]})), "/of/0/of/0/at", "Unknown key"),
        (op("union", {**BALL, "radius": 0}), "/of/0/radius", "at least 0.001"),
        (op("union", {**BOX, "size": [1, 1]}), "/of/0/size/2", "missing"),
        (op("union", 7), "/of/0", "Must be an object"),
        ({"type": "union", "of": 7}, "/of", "list"),
        ([], "", "object"),
        ({**HALF, "normal": [0, 0, 1e9]}, "/normal/2", "at most 1e+06"),
    ],
)
def test_a_fault_in_a_tree_is_found_at_its_place(tree: Any, place: str, phrase: str) -> None:
    found = faults(document(BALL, tree), InvalidDocument)
    assert [fault.pointer for fault in found] == [f"/items/1/shape/tree{place}"]
    assert phrase in found[0].detail


@pytest.mark.parametrize(
    ("tree", "place", "phrase"),
    [
        (op("intersection", BALL, {**HALF, "normal": [0, 0, 0]}), "/of/1/normal", "not zero"),
        (HALF, "", "no end"),
        (op("union", BALL, op("union", HALF)), "/of/1/of/0", "no end"),
        (op("difference", HALF, BALL), "/of/0", "no end"),
        (op("intersection", HALF), "/of/0", "no end"),
    ],
)
def test_half_spaces_that_cannot_be_are_named(tree: Any, place: str, phrase: str) -> None:
    found = faults(document(BALL, tree), InconsistentDocument)
    assert [fault.pointer for fault in found] == [f"/items/1/shape/tree{place}"]
    assert phrase in found[0].detail


def test_half_spaces_that_may_bound_each_other_are_left_to_geometry() -> None:
    trees = op("intersection", HALF, HALF), op("difference", HALF, HALF)
    assert len(read("tubeloom", document(*trees), SETTINGS).items) == 2


@pytest.mark.parametrize("levels", [65, 90])
def test_a_tree_that_is_too_deep_is_refused(levels: int) -> None:
    found = faults(nested(levels), DocumentTooLarge)
    assert found == (Fault("/items/0/shape/tree", "Trees of solids may be at most 64 deep."),)


def test_a_tree_of_the_greatest_depth_is_read() -> None:
    program = read("tubeloom", nested(64), SETTINGS)
    assert canonical(program).count(b"union") == 63


def test_a_tree_a_hundred_thousand_deep_is_refused_where_it_gets_too_deep() -> None:
    data = nested(100_000)
    assert "Nested too deeply" in faults(data, UnreadableDocument)[0].detail
    check_is_refused_soon(data)


@pytest.mark.parametrize("count", [1_000, 600_000, 1_000_000])
def test_a_union_of_very_many_solids_is_refused(count: int) -> None:
    balls = b",".join([b'{"type":"sphere","radius":1}'] * count)
    data = b'{"items":[{"id":"a","shape":{"type":"csg","tree":{"type":"union","of":[%s]}}}]}'
    (found,) = faults(data % balls, DocumentTooLarge)
    assert "at most 1000 nodes" in found.detail or "limit of 2000000" in found.detail
    if count > 1_000:  # so few are read before that can be measured
        check_is_refused_soon(data % balls)


def test_trees_of_all_items_count_together() -> None:
    half = op("union", *[BALL] * 499)
    assert len(read("tubeloom", document(half, half), SETTINGS).items) == 2
    (found,) = faults(document(half, half, BALL), DocumentTooLarge)
    assert found.pointer == "/items/2/shape/tree"
    assert "1000 nodes" in found.detail
