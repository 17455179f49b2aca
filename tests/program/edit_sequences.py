"""Random programs, and random edits that fit them one after another, for Hypothesis."""

from __future__ import annotations

import json
from collections.abc import Callable
from typing import Any

from hypothesis import strategies as st

from app.program.edits import Edited, apply_edits
from app.program.model import Attachment, Hyperedge, Item, Program
from app.settings import Settings

Json = dict[str, Any]

SETTINGS = Settings()

KINDS = ("clause", "literal", "argument", "term_table", "ntuple", "variable", "constant")
LABELS = ("A", "Vs", "label", "a rather long label", "q\u0301y", "")

SHAPES: tuple[Json, ...] = (
    {"type": "box"},
    {"type": "box", "size": [1.5, 0.8, 0.4]},
    {"type": "tray"},
    {"type": "tray", "wall": 0.1},
    {"type": "sphere", "radius": 0.4},
    {"type": "cylinder"},
    {"type": "cone", "radius": 0.3},
)

BODIES: tuple[Json, ...] = (
    {"type": "box", "size": [1, 1, 1]},
    {"type": "box", "size": [0.5, 1, 1.5]},
    {"type": "sphere", "radius": 0.6},
)
"""Of items that float."""

LAYOUTS: tuple[Json, ...] = ({}, {}, {}, {"curves": "prose"}, {"clearance": None})
"""Most are as they are by default."""

coordinates = st.integers(-60, 60).map(lambda tenths: tenths / 10)
positions = st.lists(coordinates, min_size=3, max_size=3)
labels = st.sampled_from(LABELS)
colors = st.sampled_from(("#b91c1c", "#0369a1"))
looks = {
    "kind": st.sampled_from(KINDS),
    "label": labels,
    "shape": st.sampled_from(SHAPES),
    "color": colors,
}


@st.composite
def programs(draw: st.DrawFn, placed: bool = True) -> Program:
    """Up to ten items within each other, and up to five hyperedges; some ``placed`` by hand."""
    items: list[Json] = []
    for number in range(draw(st.integers(2, 10))):
        item: Json = {"id": f"i{number}", **draw(_item(placed))}
        parent = draw(st.integers(-1, number - 1))
        items.append(item if parent < 0 else item | {"parent": f"i{parent}"})
    names = [item["id"] for item in items]
    hyperedges = [
        {"id": f"e{number}", "attachments": [{"item": name} for name in ends]}
        for number, ends in enumerate(
            draw(
                st.lists(
                    st.lists(st.sampled_from(names), min_size=2, max_size=4, unique=True),
                    max_size=5,
                )
            )
        )
    ]
    document = {
        "notation": draw(st.sampled_from(("plain", "sparcl"))),
        "items": items,
        "hyperedges": hyperedges,
        "layout": {"constraints": draw(_line_ups(items)), **draw(st.sampled_from(LAYOUTS))},
    }
    return Program.model_validate_json(json.dumps(document))


@st.composite
def in_space(draw: st.DrawFn) -> Program:
    """Up to eight items that float apart from each other, and up to six hyperedges."""
    cells = st.tuples(*[st.integers(-2, 2)] * 3)
    places = draw(st.lists(cells, min_size=3, max_size=8, unique=True))
    items: list[Json] = [
        {
            "id": f"i{number}",
            "shape": draw(st.sampled_from(BODIES)),
            "position": [3 * step for step in cell],
        }
        for number, cell in enumerate(places)
    ]
    names = st.sampled_from([item["id"] for item in items])
    ends = st.lists(names, min_size=2, max_size=4, unique=True)
    hyperedges = [
        {"id": f"e{number}", "attachments": [{"item": name} for name in chosen]}
        for number, chosen in enumerate(draw(st.lists(ends, min_size=1, max_size=6)))
    ]
    document = {"items": items, "hyperedges": hyperedges, "style": {"ground": False}}
    return Program.model_validate_json(json.dumps(document))


def routed(program: Program, routing: str) -> Program:
    """The program with another way to route it, by short trees that keep clear."""
    layout = {"routing": routing, "curves": None, "clearance": 0.05}
    return program.model_copy(update={"layout": program.layout.model_copy(update=layout)})


@st.composite
def edits(draw: st.DrawFn, program: Program, number: int, placed: bool = True) -> Json:
    """An edit that ``program`` takes; what is new has the ``number`` in its id."""
    fitting = [name for name, (fits, _) in _EDITS.items() if fits(program)]
    name = draw(st.sampled_from(fitting))
    made = draw(_EDITS[name][1](program, number, placed))
    return {"type": name, **made}


@st.composite
def sequences(
    draw: st.DrawFn, most: int = 6, placed: bool = True
) -> tuple[Program, tuple[Json, ...]]:
    """A program, and edits that can be done on it one after another."""
    first = program = draw(programs(placed))
    done: list[Json] = []
    for number in range(draw(st.integers(1, most))):
        edit = draw(edits(program, number, placed))
        program = edited(program, edit).program
        done.append(edit)
    return first, tuple(done)


def as_bytes(*done: Json) -> bytes:
    """Edits as they are sent."""
    return json.dumps({"edits": done}).encode()


def edited(program: Program, *done: Json) -> Edited:
    """The program after edits."""
    return apply_edits(program, as_bytes(*done), SETTINGS)


@st.composite
def _item(draw: st.DrawFn, placed: bool) -> Json:
    item: Json = draw(st.fixed_dictionaries({}, optional=looks))
    if placed and draw(st.integers(0, 7)) == 7:
        item["position"] = draw(positions)
    if placed and draw(st.integers(0, 11)) == 11:
        item["rotation"] = [0, 0, draw(st.sampled_from((30, 90)))]
    return item


@st.composite
def _line_ups(draw: st.DrawFn, items: list[Json]) -> list[Json]:
    siblings: dict[str | None, list[str]] = {}
    for item in items:
        if "position" not in item:
            siblings.setdefault(item.get("parent"), []).append(item["id"])
    lines = []
    for names in siblings.values():
        if len(names) > 1 and draw(st.integers(0, 5)) == 5:
            members = draw(st.lists(st.sampled_from(names), min_size=2, max_size=4, unique=True))
            kind = draw(st.sampled_from(("row", "column", "helix")))
            lines.append({"type": kind, "items": members})
    return lines


def _ends(hyperedge: Hyperedge) -> list[Json]:
    return [_end(end) for end in hyperedge.attachments]


def _end(end: Attachment) -> Json:
    return end.model_dump(exclude_none=True)


def _within(program: Program, name: str) -> set[str]:
    found = {name}
    for _ in program.items:
        found |= {item.id for item in program.items if item.parent in found}
    return found


def _one_item(program: Program) -> st.SearchStrategy[Item]:
    return st.sampled_from(program.items)


def _one_hyperedge(program: Program, least: int = 2) -> st.SearchStrategy[Hyperedge]:
    return st.sampled_from([one for one in program.hyperedges if len(one.attachments) >= least])


def _some(ends: list[Json], least: int, most: int) -> st.SearchStrategy[list[Json]]:
    return st.lists(
        st.sampled_from(ends), min_size=least, max_size=most, unique_by=lambda end: end["item"]
    )


@st.composite
def _add_item(draw: st.DrawFn, program: Program, number: int, placed: bool) -> Json:
    item = {"id": f"new{number}", **draw(_item(placed))}
    parent = draw(st.none() | st.sampled_from([item.id for item in program.items]))
    return {"item": item if parent is None else item | {"parent": parent}}


@st.composite
def _remove_item(draw: st.DrawFn, program: Program, _number: int, _placed: bool) -> Json:
    return {"id": draw(st.sampled_from(_removable(program)))}


def _removable(program: Program) -> list[str]:
    """What leaves some items, so that there is still something to edit."""
    return [
        item.id
        for item in program.items
        if len(program.items) - len(_within(program, item.id)) >= 2
    ]


@st.composite
def _rename_item(draw: st.DrawFn, program: Program, number: int, _placed: bool) -> Json:
    return {"id": draw(_one_item(program)).id, "to": f"renamed{number}"}


@st.composite
def _set_item(draw: st.DrawFn, program: Program, _number: int, placed: bool) -> Json:
    item = draw(_one_item(program))
    optional: dict[str, st.SearchStrategy[Any]] = {
        name: strategy | st.none() for name, strategy in looks.items()
    }
    if placed:
        optional["position"] = positions | st.none()
        optional["data"] = st.just({"seen": True})
    name = draw(st.sampled_from(sorted(optional)))
    return {"id": item.id, "fields": {name: draw(optional[name])}}


@st.composite
def _reparent(draw: st.DrawFn, program: Program, _number: int, _placed: bool) -> Json:
    item = draw(_one_item(program))
    inside = _within(program, item.id)
    others = [other.id for other in program.items if other.id not in inside]
    parent = draw(st.sampled_from([None, *others]))
    return {"id": item.id, "parent": parent}


@st.composite
def _group(draw: st.DrawFn, program: Program, number: int, _placed: bool) -> Json:
    first = draw(_one_item(program))
    siblings = [item.id for item in program.items if item.parent == first.parent]
    names = draw(st.lists(st.sampled_from(siblings), min_size=1, max_size=3, unique=True))
    return {"items": names, "tray": {"id": f"tray{number}", "label": draw(labels)}}


@st.composite
def _ungroup(draw: st.DrawFn, program: Program, _number: int, _placed: bool) -> Json:
    return {"id": draw(_one_item(program)).id}


@st.composite
def _add_hyperedge(draw: st.DrawFn, program: Program, number: int, _placed: bool) -> Json:
    ends = draw(_some([{"item": item.id} for item in program.items], 2, 4))
    return {"hyperedge": {"id": f"edge{number}", "attachments": ends}}


@st.composite
def _one_by_id(draw: st.DrawFn, program: Program, _number: int, _placed: bool) -> Json:
    return {"id": draw(_one_hyperedge(program)).id}


@st.composite
def _rename_hyperedge(draw: st.DrawFn, program: Program, number: int, _placed: bool) -> Json:
    return {"id": draw(_one_hyperedge(program)).id, "to": f"other{number}"}


@st.composite
def _set_hyperedge(draw: st.DrawFn, program: Program, _number: int, _placed: bool) -> Json:
    optional = {"label": labels, "color": colors, "radius": st.sampled_from((0.05, 0.12))}
    name = draw(st.sampled_from(sorted(optional)))
    return {
        "id": draw(_one_hyperedge(program)).id,
        "fields": {name: draw(optional[name] | st.none())},
    }


def _unjoined(program: Program, hyperedge: Hyperedge) -> list[Json]:
    joined = {end.item for end in hyperedge.attachments}
    return [{"item": item.id} for item in program.items if item.id not in joined]


@st.composite
def _connect(draw: st.DrawFn, program: Program, _number: int, _placed: bool) -> Json:
    hyperedge = draw(
        st.sampled_from([one for one in program.hyperedges if _unjoined(program, one)])
    )
    return {
        "id": hyperedge.id,
        "attachments": draw(_some(_unjoined(program, hyperedge), 1, 2)),
    }


@st.composite
def _disconnect(draw: st.DrawFn, program: Program, _number: int, _placed: bool) -> Json:
    hyperedge = draw(_one_hyperedge(program, 3))
    ends = _ends(hyperedge)
    return {"id": hyperedge.id, "attachments": draw(_some(ends, 1, len(ends) - 2))}


@st.composite
def _merge(draw: st.DrawFn, program: Program, _number: int, _placed: bool) -> Json:
    pair = draw(
        st.lists(
            st.sampled_from([one.id for one in program.hyperedges]),
            min_size=2,
            max_size=2,
            unique=True,
        )
    )
    return {"id": pair[0], "other": pair[1]}


@st.composite
def _split(draw: st.DrawFn, program: Program, number: int, _placed: bool) -> Json:
    hyperedge = draw(_one_hyperedge(program, 3))
    moving = draw(_some(_ends(hyperedge), 2, len(hyperedge.attachments)))
    staying = len(hyperedge.attachments) - len(moving)
    return {
        "id": hyperedge.id,
        "into": f"half{number}",
        "attachments": moving,
        "shared": moving[: max(0, 2 - staying)],
    }


@st.composite
def _set_program(draw: st.DrawFn, _program: Program, _number: int, _placed: bool) -> Json:
    optional: dict[str, st.SearchStrategy[Any]] = {
        "name": labels,
        "style": st.fixed_dictionaries({"background": colors}),
        "view": st.just({"from": [0, -1, 0.5]}),
        "layout": st.fixed_dictionaries({"clearance": st.sampled_from((0.05, 0.08))}),
    }
    name = draw(st.sampled_from(sorted(optional)))
    return {"fields": {name: draw(optional[name])}}


Fits = Callable[[Program], bool]
Maker = Callable[[Program, int, bool], st.SearchStrategy[Json]]


def _always(_program: Program) -> bool:
    return True


def _any_hyperedge(program: Program) -> bool:
    return bool(program.hyperedges)


def _any_large(program: Program) -> bool:
    return any(len(one.attachments) > 2 for one in program.hyperedges)


_EDITS: dict[str, tuple[Fits, Maker]] = {
    "add_item": (_always, _add_item),
    "remove_item": (lambda program: bool(_removable(program)), _remove_item),
    "rename_item": (_always, _rename_item),
    "set_item": (_always, _set_item),
    "reparent": (_always, _reparent),
    "group": (_always, _group),
    "ungroup": (
        lambda program: len(program.items) > 2,
        _ungroup,
    ),
    "add_hyperedge": (lambda program: len(program.items) > 1, _add_hyperedge),
    "remove_hyperedge": (_any_hyperedge, _one_by_id),
    "rename_hyperedge": (_any_hyperedge, _rename_hyperedge),
    "set_hyperedge": (_any_hyperedge, _set_hyperedge),
    "connect": (
        lambda program: any(_unjoined(program, one) for one in program.hyperedges),
        _connect,
    ),
    "disconnect": (_any_large, _disconnect),
    "merge": (lambda program: len(program.hyperedges) > 1, _merge),
    "split": (_any_large, _split),
    "set_program": (_always, _set_program),
}
"""Which programs an edit fits, and how it is made up."""
