"""Each edit: what it does, what it leaves alone, and what it refuses."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings

from app.errors import (
    DocumentError,
    DocumentTooLarge,
    Fault,
    InconsistentDocument,
    InvalidDocument,
    UnreadableDocument,
)
from app.notations.loader import load_notation
from app.placement.place import place
from app.program.checking import check
from app.program.digest import canonical
from app.program.edits import apply_edits
from app.program.model import Item, Program
from app.program.reading import read_program
from app.program.renaming import renamed
from app.settings import Settings
from tests.program.edit_sequences import SETTINGS, Json, as_bytes, edited, sequences

DOCUMENT: Json = {
    "items": [
        {"id": "tray"},
        {"id": "a", "parent": "tray", "label": "A"},
        {"id": "b", "parent": "tray", "shape": {"type": "box", "size": [1, 1, 1]}},
        {"id": "c", "attachment_points": [{"id": "top", "position": [0, 0, 1]}]},
        {"id": "d"},
    ],
    "hyperedges": [
        {"id": "e", "label": "E", "attachments": [{"item": "a"}, {"item": "b"}]},
        {
            "id": "f",
            "color": "#123456",
            "attachments": [{"item": "b"}, {"item": "c", "point": "top"}, {"item": "d"}],
        },
    ],
    "layout": {"constraints": [{"type": "row", "items": ["tray", "c", "d"]}]},
}
PROGRAM = Program.model_validate(DOCUMENT)
FINE: Json = {"type": "set_program", "fields": {"name": "never seen"}}


def after(*edits: Json) -> Json:
    """The document after edits, as it is stored."""
    document: Json = json.loads(canonical(edited(PROGRAM, *edits).program))
    return document


def ids(document: Json, part: str = "items") -> list[str]:
    return [one["id"] for one in document.get(part, ())]


def find(document: Json, name: str, part: str = "items") -> Json:
    (found,) = (one for one in document[part] if one["id"] == name)
    return dict(found)


def ends(document: Json, name: str) -> list[str]:
    return [end["item"] for end in find(document, name, "hyperedges")["attachments"]]


def faults(*edits: Json, error: type[DocumentError] = InconsistentDocument) -> tuple[Fault, ...]:
    """What is wrong with edits after three that are fine."""
    with pytest.raises(error) as raised:
        edited(PROGRAM, FINE, FINE, FINE, *edits)
    return raised.value.faults


def test_an_item_is_added_behind_the_others() -> None:
    made = after({"type": "add_item", "item": {"id": "new", "parent": "a"}})
    assert ids(made) == ["tray", "a", "b", "c", "d", "new"]
    assert find(made, "new")["parent"] == "a"


def test_an_item_goes_with_its_contents_and_what_joins_less_than_two_then() -> None:
    made = after({"type": "remove_item", "id": "tray"})
    assert ids(made) == ["c", "d"]
    assert ids(made, "hyperedges") == ["f"]
    assert ends(made, "f") == ["c", "d"]
    assert made["layout"]["constraints"] == [{"type": "row", "items": ["c", "d"]}]


def test_a_row_of_one_is_none() -> None:
    made = after({"type": "remove_item", "id": "c"}, {"type": "remove_item", "id": "d"})
    assert "layout" not in made


def test_a_new_name_stands_wherever_the_old_one_stood() -> None:
    made = after({"type": "rename_item", "id": "tray", "to": "box"},
                 {"type": "rename_item", "id": "b", "to": "B"})  # fmt: skip
    assert ids(made) == ["box", "a", "B", "c", "d"]
    assert {find(made, name)["parent"] for name in ("a", "B")} == {"box"}
    assert ends(made, "e") == ["a", "B"]
    assert ends(made, "f") == ["B", "c", "d"]
    assert made["layout"]["constraints"][0]["items"] == ["box", "c", "d"]


def test_names_can_be_exchanged() -> None:
    result = edited(
        PROGRAM,
        {"type": "rename_item", "id": "c", "to": "x"},
        {"type": "rename_item", "id": "d", "to": "c"},
        {"type": "rename_item", "id": "x", "to": "d"},
    )
    assert result.items == {"c": "d", "d": "c"}
    before = renamed(PROGRAM, result)
    assert before == result.program


def test_a_name_that_is_taken_over_belongs_to_another_item() -> None:
    result = edited(
        PROGRAM,
        {"type": "rename_item", "id": "c", "to": "old"},
        {"type": "add_item", "item": {"id": "c"}},
        {"type": "rename_item", "id": "c", "to": "newer"},
    )
    assert result.items == {"old": "c"}
    result = edited(
        PROGRAM,
        {"type": "remove_item", "id": "d"},
        {"type": "rename_item", "id": "c", "to": "d"},
    )
    before = [item.id for item in renamed(PROGRAM, result).items]
    assert before[3] == "d"
    assert before[4] not in {item.id for item in result.program.items}


def test_a_hyperedge_is_renamed_where_it_stands() -> None:
    result = edited(PROGRAM, {"type": "rename_hyperedge", "id": "e", "to": "E"})
    assert [one.id for one in result.program.hyperedges] == ["E", "f"]
    assert result.hyperedges == {"E": "e"}


def test_fields_of_an_item_are_merged() -> None:
    made = after(
        {"type": "set_item", "id": "a", "fields": {"label": None, "data": {"x": 1}}},
        {"type": "set_item", "id": "a", "fields": {"data": {"y": 2}, "color": "#fff"}},
        {"type": "set_item", "id": "b", "fields": {"shape": {"size": [2, 1, 1]}}},
    )
    assert find(made, "a") == {
        "id": "a", "parent": "tray", "color": "#fff", "data": {"x": 1, "y": 2},
    }  # fmt: skip
    assert find(made, "b")["shape"] == {"type": "box", "size": [2.0, 1.0, 1.0]}


def test_a_shape_of_another_type_takes_nothing_from_the_old_one() -> None:
    made = after({"type": "set_item", "id": "b", "fields": {"shape": {"type": "sphere"}}})
    assert find(made, "b")["shape"] == {"type": "sphere"}


def test_what_gets_a_position_leaves_its_row() -> None:
    made = after({"type": "set_item", "id": "c", "fields": {"position": [1, 2, 3]}})
    assert made["layout"]["constraints"][0]["items"] == ["tray", "d"]


def test_an_item_moves_into_another_one_and_out_again() -> None:
    made = after({"type": "reparent", "id": "c", "parent": "a"})
    assert find(made, "c")["parent"] == "a"
    assert made["layout"]["constraints"][0]["items"] == ["tray", "d"]
    made = after({"type": "reparent", "id": "a", "parent": None})
    assert "parent" not in find(made, "a")


def test_a_position_says_nothing_in_another_parent() -> None:
    made = after(
        {"type": "set_item", "id": "a", "fields": {"position": [1, 2, 3]}},
        {"type": "reparent", "id": "a", "parent": "tray"},
        {"type": "reparent", "id": "a", "parent": "c"},
    )
    assert "position" not in find(made, "a")


def test_items_are_grouped_and_ungrouped() -> None:
    grouped = {"type": "group", "items": ["a", "b"], "tray": {"id": "inner", "label": "L"}}
    made = after(grouped)
    assert find(made, "inner") == {
        "id": "inner", "parent": "tray", "label": "L", "shape": {"type": "tray"},
    }  # fmt: skip
    assert {find(made, name)["parent"] for name in "ab"} == {"inner"}
    assert after(grouped, {"type": "ungroup", "id": "inner"})["items"] == [
        find(json.loads(canonical(PROGRAM)), name) for name in ("tray", "a", "b", "c", "d")
    ]


def world(program: Program) -> dict[str, list[float]]:
    placement = place(program, load_notation(program.notation))
    return {
        item.id: center.tolist()
        for item, center in zip(program.items, placement.centers, strict=True)
    }


def test_what_has_a_position_stays_there_when_it_is_grouped_and_ungrouped() -> None:
    items = [
        {"id": "a", "position": [0.1, 0.2, 0.3]},
        {"id": "b", "position": [4, -7, 2]},
        {"id": "in", "parent": "b", "position": [0, 1, 1]},
    ]
    program = Program.model_validate({"items": items})
    grouped = edited(program, {"type": "group", "items": ["a", "b"], "tray": {"id": "t"}}).program
    back = edited(grouped, {"type": "ungroup", "id": "t"}).program
    for made in (grouped, back):
        for name, center in world(program).items():
            np.testing.assert_allclose(world(made)[name], center, atol=1e-12)


def test_hyperedges_come_and_go() -> None:
    new = {"id": "g", "attachments": [{"item": "tray"}, {"item": "d"}]}
    made = after({"type": "add_hyperedge", "hyperedge": new})
    assert ids(made, "hyperedges") == ["e", "f", "g"]
    made = after({"type": "remove_hyperedge", "id": "e"})
    assert ids(made, "hyperedges") == ["f"]
    assert ids(made) == ids(DOCUMENT)


def test_fields_of_a_hyperedge_are_merged() -> None:
    made = after({"type": "set_hyperedge", "id": "f", "fields": {"color": None, "radius": 0.2}})
    assert "color" not in find(made, "f", "hyperedges")
    assert find(made, "f", "hyperedges")["radius"] == 0.2


def test_hyperedges_connect_and_let_go() -> None:
    made = after({"type": "connect", "id": "e", "attachments": [{"item": "d"}, {"item": "c"}]})
    assert ends(made, "e") == ["a", "b", "d", "c"]
    point = {"item": "c", "point": "top"}
    made = after({"type": "disconnect", "id": "f", "attachments": [point]})
    assert ends(made, "f") == ["b", "d"]


def test_two_hyperedges_become_one() -> None:
    made = after({"type": "merge", "id": "e", "other": "f"})
    assert ids(made, "hyperedges") == ["e"]
    assert ends(made, "e") == ["a", "b", "c", "d"]
    assert find(made, "e", "hyperedges")["label"] == "E"


def test_one_hyperedge_becomes_two_that_look_the_same() -> None:
    moving = [{"item": "d"}, {"item": "c", "point": "top"}]
    made = after({"type": "split", "id": "f", "into": "g", "attachments": moving,
                  "shared": [{"item": "d"}]})  # fmt: skip
    assert (ends(made, "f"), ends(made, "g")) == (["b", "d"], ["d", "c"])
    assert find(made, "g", "hyperedges")["color"] == "#123456"


def test_the_frame_of_a_program_changes() -> None:
    made = after(
        {"type": "set_program", "fields": {"name": "N", "layout": {"clearance": 0.1}}},
        {"type": "set_program", "fields": {"view": {"from": [0, 0, 1]}}},
    )
    assert (made["name"], made["layout"]["clearance"]) == ("N", 0.1)
    assert made["layout"]["constraints"] == DOCUMENT["layout"]["constraints"]
    assert made["view"]["from"] == [0.0, 0.0, 1.0]


ATTACHED = [{"item": "a"}, {"item": "b"}]


@pytest.mark.parametrize(
    ("edit", "place", "phrase"),
    [
        ({"type": "add_item", "item": {"id": "a"}}, "/item/id", "already"),
        ({"type": "add_item", "item": {"id": "n", "parent": "tary"}}, "/item/parent",
         'Did you mean "tray"?'),
        ({"type": "remove_item", "id": "trya"}, "/id", 'Did you mean "tray"?'),
        ({"type": "rename_item", "id": "z", "to": "y"}, "/id", 'no item "z"'),
        ({"type": "rename_item", "id": "a", "to": "b"}, "/to", "already"),
        ({"type": "set_item", "id": "z", "fields": {}}, "/id", 'no item "z"'),
        ({"type": "set_item", "id": "a", "fields": {"id": "q"}}, "/fields/id", "rename_item"),
        ({"type": "set_item", "id": "a", "fields": {"parent": "c"}}, "/fields/parent", "reparent"),
        ({"type": "reparent", "id": "z", "parent": None}, "/id", 'no item "z"'),
        ({"type": "reparent", "id": "a", "parent": "z"}, "/parent", 'no item "z"'),
        ({"type": "reparent", "id": "tray", "parent": "a"}, "/parent", "in itself"),
        ({"type": "reparent", "id": "tray", "parent": "tray"}, "/parent", "in itself"),
        ({"type": "group", "items": ["a", "z"], "tray": {"id": "t"}}, "/items/1", 'no item "z"'),
        ({"type": "group", "items": ["a", "c"], "tray": {"id": "t"}}, "/items/1", "same parent"),
        ({"type": "group", "items": ["a", "a"], "tray": {"id": "t"}}, "/items", "twice"),
        ({"type": "group", "items": ["a"], "tray": {"id": "b"}}, "/tray/id", "already"),
        ({"type": "group", "items": ["a"], "tray": {"id": "t", "parent": "c"}}, "/tray/parent",
         "parent that the items had"),
        ({"type": "ungroup", "id": "z"}, "/id", 'no item "z"'),
        ({"type": "add_hyperedge", "hyperedge": {"id": "e", "attachments": ATTACHED}},
         "/hyperedge/id", "already"),
        ({"type": "add_hyperedge",
          "hyperedge": {"id": "n", "attachments": [{"item": "a"}, {"item": "z"}]}},
         "/hyperedge/attachments/1/item", 'no item "z"'),
        ({"type": "add_hyperedge",
          "hyperedge": {"id": "n", "attachments": [{"item": "a"}, {"item": "c", "point": "tap"}]}},
         "/hyperedge/attachments/1/point", 'Did you mean "top"?'),
        ({"type": "add_hyperedge",
          "hyperedge": {"id": "n", "attachments": [{"item": "a"}, {"item": "a"}]}},
         "/hyperedge/attachments/1", "twice"),
        ({"type": "remove_hyperedge", "id": "z"}, "/id", 'no hyperedge "z"'),
        ({"type": "rename_hyperedge", "id": "e", "to": "f"}, "/to", "already"),
        ({"type": "set_hyperedge", "id": "e", "fields": {"id": "q"}}, "/fields/id",
         "rename_hyperedge"),
        ({"type": "set_hyperedge", "id": "e", "fields": {"attachments": []}},
         "/fields/attachments", "connect"),
        ({"type": "connect", "id": "z", "attachments": ATTACHED}, "/id", 'no hyperedge "z"'),
        ({"type": "connect", "id": "e", "attachments": [{"item": "c"}, {"item": "a"}]},
         "/attachments/1", "already"),
        ({"type": "connect", "id": "e", "attachments": [{"item": "z"}]},
         "/attachments/0/item", 'no item "z"'),
        ({"type": "disconnect", "id": "f", "attachments": [{"item": "c"}]},
         "/attachments/0", 'does not join "c"'),
        ({"type": "disconnect", "id": "e", "attachments": [{"item": "a"}]},
         "/attachments", "less than two"),
        ({"type": "merge", "id": "e", "other": "e"}, "/other", "itself"),
        ({"type": "merge", "id": "e", "other": "z"}, "/other", 'no hyperedge "z"'),
        ({"type": "split", "id": "f", "into": "e", "attachments": [{"item": "b"}, {"item": "d"}]},
         "/into", "already"),
        ({"type": "split", "id": "f", "into": "g", "attachments": [{"item": "b"}, {"item": "d"}]},
         "/attachments", "less than two"),
        ({"type": "split", "id": "f", "into": "g", "attachments": [{"item": "b"}, {"item": "d"}],
          "shared": [{"item": "a"}]}, "/shared/0", "Only attachments"),
        ({"type": "split", "id": "f", "into": "g", "attachments": [{"item": "b"}, {"item": "a"}],
          "shared": [{"item": "b"}]}, "/attachments/1", 'does not join "a"'),
        ({"type": "set_program", "fields": {"items": []}}, "/fields/items", "edits of items"),
    ],
)  # fmt: skip
def test_what_does_not_fit_is_said_where_it_is(edit: Json, place: str, phrase: str) -> None:
    (fault,) = faults(edit)
    assert fault.pointer == "/edits/3" + place
    assert phrase in fault.detail


@pytest.mark.parametrize(
    ("edit", "place", "phrase"),
    [
        ({"type": "set_item", "id": "a", "fields": {"labl": "x"}}, "/fields/labl", '"label"'),
        ({"type": "set_item", "id": "b", "fields": {"shape": {"size": [0, 1, 1]}}},
         "/fields/shape/size/0", "at least"),
        ({"type": "set_hyperedge", "id": "e", "fields": {"radius": "thick"}}, "/fields/radius",
         "number"),
        ({"type": "set_program", "fields": {"style": {"halo": 9}}}, "/fields/style/halo",
         "at most 3"),
        ({"type": "set_program", "fields": {"notation": None, "nam": "x"}}, "/fields/nam",
         '"name"'),
        ({"type": "add_item", "item": {"id": "n", "labl": "x"}}, "/item/labl", '"label"'),
        ({"type": "add_item"}, "/item", "missing"),
        ({"type": "remov_item", "id": "a"}, "/type", "remove_item"),
        ({"id": "a"}, "", '"type"'),
        ({"type": "reparent", "id": "a"}, "/parent", "missing"),
        ({"type": "connect", "id": "e", "attachments": []}, "/attachments", "at least 1"),
    ],
)  # fmt: skip
def test_what_is_no_edit_is_said_where_it_is(edit: Json, place: str, phrase: str) -> None:
    (fault,) = faults(edit, error=InvalidDocument)
    assert fault.pointer == "/edits/3" + place
    assert phrase in fault.detail


@pytest.mark.parametrize(
    ("edit", "phrase"),
    [
        ({"type": "set_item", "id": "d", "fields": {"shape": {"type": "text"}}}, "needs a label"),
        ({"type": "set_item", "id": "c", "fields": {"attachment_points": []}},
         '/hyperedges/1/attachments/1/point: Item "c" has no attachment point "top"'),
        ({"type": "set_program",
          "fields": {"layout": {"constraints": [{"type": "row", "items": ["a", "c"]}]}}},
         "same parent"),
    ],
)  # fmt: skip
def test_what_does_not_agree_in_the_end_is_told_of_the_end(edit: Json, phrase: str) -> None:
    (fault,) = faults(edit)
    assert fault.pointer == "/edits"
    assert fault.detail.startswith("After these edits, ")
    assert phrase in fault.detail


@pytest.mark.parametrize(
    ("data", "error"),
    [
        (b"", UnreadableDocument),
        (b"[]", InvalidDocument),
        (b"{}", InvalidDocument),
        (b'{"edits": []}', InvalidDocument),
        (b'{"edits": 3}', InvalidDocument),
        (b'{"edits": [null]}', InvalidDocument),
        (as_bytes(*[FINE] * 1_001), InvalidDocument),
    ],
)
def test_other_documents_are_no_edits(data: bytes, error: type[DocumentError]) -> None:
    with pytest.raises(error):
        apply_edits(PROGRAM, data, SETTINGS)


def tree(depth: int) -> Json:
    made: Json = {"type": "box", "size": [1, 1, 1]}
    for _ in range(depth):
        made = {"type": "union", "of": [made]}
    return {"type": "csg", "tree": made}


@pytest.mark.parametrize(
    "edit",
    [
        {"type": "add_item", "item": {"id": "n", "shape": tree(80)}},
        {"type": "group", "items": ["a"], "tray": {"id": "n", "shape": tree(80)}},
        {"type": "set_item", "id": "a", "fields": {"shape": tree(80)}},
    ],
)
def test_trees_that_are_too_deep_are_refused(edit: Json) -> None:
    (fault,) = faults(edit, error=DocumentTooLarge)
    assert fault.pointer == "/edits/3"


def test_limits_hold_after_edits_too() -> None:
    few = Settings(max_items=5, max_depth=2)
    more = as_bytes({"type": "add_item", "item": {"id": "n"}})
    with pytest.raises(DocumentTooLarge) as raised:
        apply_edits(PROGRAM, more, few)
    assert raised.value.faults[0].pointer == "/edits"
    deeper = as_bytes({"type": "reparent", "id": "c", "parent": "a"})
    with pytest.raises(InconsistentDocument, match="at most 2 deep"):
        apply_edits(PROGRAM, deeper, few)


@settings(max_examples=30)
@given(sequences(most=8))
def test_after_any_edits_a_program_is_right(made: tuple[Program, tuple[Json, ...]]) -> None:
    program, done = made
    before = canonical(program)
    together = edited(program, *done).program
    check(together, SETTINGS)
    assert read_program(canonical(together), SETTINGS) == together
    one_by_one = program
    for edit in done:
        one_by_one = edited(one_by_one, edit).program
    assert one_by_one == together
    assert canonical(program) == before, "nobody changes the program that there was"


def test_items_that_are_not_named_are_the_same_objects() -> None:
    made = edited(PROGRAM, {"type": "set_item", "id": "a", "fields": {"label": "other"}}).program
    kept: list[tuple[Item, Item]] = [
        pair for pair in zip(PROGRAM.items, made.items, strict=True) if pair[0].id != "a"
    ]
    assert all(old is new for old, new in kept)
    assert made.hyperedges == PROGRAM.hyperedges


def test_much_is_removed_quickly() -> None:
    count = 5_000
    document: dict[str, Any] = {
        "items": [{"id": "t"}] + [{"id": str(n), "parent": "t"} for n in range(count)],
        "hyperedges": [{"id": "e", "attachments": [{"item": str(n)} for n in range(count)]}],
        "layout": {"constraints": [{"type": "row", "items": [str(n) for n in range(count)]}]},
    }
    made = edited(Program.model_validate(document), {"type": "remove_item", "id": "t"}).program
    assert (made.items, made.hyperedges, made.layout.constraints) == ((), (), ())
