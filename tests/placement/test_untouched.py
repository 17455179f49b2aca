"""What an edit does not concern is taken over, and that is what placing it again would give."""

from __future__ import annotations

from dataclasses import fields, replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.notations.loader import load_notation
from app.placement.place import place
from app.placement.placement import Placement
from app.placement.standing import Standing
from app.placement.untouched import untouched
from app.program.model import Program

Json = dict[str, Any]

NAMES = tuple("abcdefgh")
LOOKS: tuple[Json, ...] = (
    {},
    {"label": "a"},
    {"label": "much longer", "shape": {"type": "box"}},
    {"shape": {"type": "sphere", "radius": 0.4}, "label": "s"},
    {"shape": {"type": "tray"}},
    {"kind": "argument"},
    {"color": "#102030", "data": {"some": 1}},
    {"rotation": [0, 0, 30]},
    {"attachment_points": [{"id": "p", "position": [0.1, 0, 0.2], "direction": [1, 0, 0]}]},
)


def document(draw: st.DrawFn, before: Json | None = None) -> Json:
    """Some of the names as items, in trays or not, that stand somewhere or are to be placed.

    Most are as they were ``before``, if there was anything.
    """
    known = {item["id"]: item for item in before["items"]} if before else {}
    items: list[Json] = []
    for name in draw(st.permutations(NAMES)) if before is None else NAMES:
        if name in known and draw(st.integers(0, 7)):
            items.append(known[name])
        elif draw(st.integers(0, 3)):
            items.append(_item(draw, name))
    present = {item["id"] for item in items}
    for item in items:
        if item.get("parent") not in present:
            item.pop("parent", None)
    if before is not None and draw(st.booleans()):
        items.reverse()
    # With a clearance, ends that share a place remember where they were (test_spreading).
    hyperedges = list(_hyperedges(draw, items))
    return {"items": items, "hyperedges": hyperedges, "layout": {"clearance": None}}


def _item(draw: st.DrawFn, name: str) -> Json:
    item = {"id": name, **draw(st.sampled_from(LOOKS))}
    if draw(st.booleans()):
        place = st.floats(-9, 9, allow_nan=False)
        item["position"] = [draw(place), draw(place), 0.0]
    if name > "c" and draw(st.booleans()):
        item["parent"] = draw(st.sampled_from("abc"))
    return item


def _hyperedges(draw: st.DrawFn, items: list[Json]) -> Any:
    names = [item["id"] for item in items]
    for number in range(3 if len(names) > 1 else 0):
        ends = draw(st.lists(st.sampled_from(names), min_size=2, max_size=4, unique=True))
        yield {"id": f"e{number}", "attachments": [{"item": name} for name in ends]}


@st.composite
def edits(draw: st.DrawFn) -> tuple[Program, Program]:
    """A program, and what an edit made of it."""
    before = document(draw)
    program = Program.model_validate(before)
    return program, Program.model_validate(document(draw, program.model_dump(exclude_unset=True)))


def assert_same(one: Placement, other: Placement) -> None:
    for part in fields(Placement):
        mine, theirs = getattr(one, part.name), getattr(other, part.name)
        if isinstance(mine, np.ndarray):
            assert mine.dtype == theirs.dtype
            assert mine.shape == theirs.shape, part.name
            assert mine.tobytes() == theirs.tobytes(), part.name
        else:
            assert mine == theirs, part.name


@settings(deadline=None, max_examples=300)
@given(edits())
def test_what_is_taken_over_is_what_would_be_placed(edit: tuple[Program, Program]) -> None:
    before, after = edit
    notation = load_notation(before.notation)
    standing = Standing.of(before, place(before, notation))
    taken_over = place(after, notation, standing)
    assert_same(taken_over, place(after, notation, replace(standing, whole=None)))


def stood(*items: Json, **more: Any) -> Standing:
    program = Program.model_validate({"items": items, **more})
    return Standing.of(program, place(program, load_notation(program.notation)))


def taken(standing: Standing, *items: Json, **more: Any) -> list[int] | None:
    found = untouched(Program.model_validate({"items": items, **more}), standing)
    return None if found is None else found.numbers.tolist()


A: Json = {"id": "a", "position": [0.0, 0.0, 0.0]}
B: Json = {"id": "b"}
TRAY: Json = {"id": "t", "shape": {"type": "tray"}}
WITHIN: Json = {"id": "w", "parent": "t"}


def test_what_says_where_it_stands_is_placed_alone() -> None:
    standing = stood(A, B, TRAY, WITHIN)
    moved = {**A, "position": [1.0, 0.0, 0.0]}
    assert taken(standing, A, B, TRAY, WITHIN) == [0, 1, 2, 3]
    assert taken(standing, B, moved, TRAY, WITHIN) == [1, -1, 2, 3]
    assert taken(standing, A, {**B, "position": [5.0, 0.0, 0.0]}, TRAY, WITHIN) == [0, -1, 2, 3]
    assert taken(standing, TRAY, WITHIN) == [2, 3]
    assert taken(standing, A, {**B, "color": "#123456"}, TRAY, WITHIN) == [0, 1, 2, 3]


@pytest.mark.parametrize(
    "items",
    [
        (A, B, TRAY, WITHIN, {"id": "new"}),
        (A, B, TRAY, {**WITHIN, "label": "more"}),
        (A, B, TRAY),
        ({**A, "parent": "t"}, B, TRAY, WITHIN),
        (A, B, {**TRAY, "position": [1.0, 0.0, 0.0]}, WITHIN),
        (A, {**B, "label": "b"}, TRAY, WITHIN),
    ],
)
def test_where_others_may_have_to_make_room_all_are_placed(items: tuple[Json, ...]) -> None:
    assert taken(stood(A, B, TRAY, WITHIN), *items) is None


def test_other_rules_place_all_anew() -> None:
    standing = stood(A, B)
    assert taken(standing, A, B, style={"labels": False}) is None
    assert taken(stood(A, B, layout={"dimensions": 2}), A, B, layout={"dimensions": 2}) is None
