"""What an edit does not concern keeps still, to the last bit."""

from __future__ import annotations

import io
import json
import os
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.answers import (
    Answer,
    Change,
    Delta,
    Edits,
    JsonPatch,
    MergePatch,
    RenderOptions,
    Replacement,
    Restoration,
    Revised,
    ReviseOptions,
)
from app.errors import InconsistentDocument, PatchConflict
from app.hyperedges.route import route
from app.layout import Layout, judge
from app.layout_record import read_layout, write_layout
from app.output.media import SceneFormat
from app.pipeline import answer
from app.program.digest import canonical
from app.program.model import Program
from app.program.reading import read_program
from app.revising import revise
from app.settings import Settings
from benchmarks.random_in_space import RandomSpace, random_in_space
from benchmarks.random_programs import RandomProgram, random_program
from tests.output.gltf_reader import Asset
from tests.placement.standing_rules import assert_in_order
from tests.program.edit_sequences import (
    Json,
    as_bytes,
    edits,
    in_space,
    programs,
    routed,
    sequences,
)

SETTINGS = Settings()

SEQUENCES = int(os.environ.get("EDIT_SEQUENCES", "10"))
"""Random ones for each property; a few hundred find what these may miss."""


ROUTED = max(SEQUENCES // 4, 1)
"""Of each kind that is routed by relaxation, which takes longer."""


@dataclass(frozen=True)
class Revision:
    """A revision, and the layout that it was stored with."""

    revised: Revised
    layout: Layout

    @classmethod
    def of(cls, revised: Revised) -> Revision:
        layout = read_layout(read_program(revised.document, SETTINGS), revised.layout)
        assert layout is not None
        return cls(revised, layout)

    @classmethod
    def first(cls, document: Program | Json | bytes) -> Revision:
        if isinstance(document, Program):
            document = canonical(document)
        elif isinstance(document, dict):
            document = json.dumps(document).encode()
        return cls.of(revise(b"", None, Replacement(document), SETTINGS))

    def then(self, change: Change) -> Revision:
        return Revision.of(revise(self.revised.document, self.revised.layout, change, SETTINGS))

    def edited(self, *done: Json) -> Revision:
        return self.then(Edits(as_bytes(*done)))

    @property
    def places(self) -> dict[str, bytes]:
        """Centre, rotation and size of each item."""
        made = self.layout.placement
        rows = np.concatenate([made.centers, made.rotations, made.sizes], axis=1)
        return {
            item.id: row.tobytes()
            for item, row in zip(self.layout.program.items, rows, strict=True)
        }

    @property
    def curves(self) -> dict[str, bytes]:
        """Control points and thickness of each hyperedge."""
        made, starts = self.layout.routing, self.layout.routing.segment_starts
        return {
            one.id: made.control_points[starts[k] : starts[k + 1]].tobytes()
            + made.radii[k].tobytes()
            for k, one in enumerate(self.layout.program.hyperedges)
        }

    @property
    def hues(self) -> dict[str, int]:
        names = [one.id for one in self.layout.program.hyperedges]
        return dict(zip(names, self.layout.hues.tolist(), strict=True))

    @property
    def ends(self) -> dict[str, bytes]:
        """Where each hyperedge attaches, and what it wishes for itself."""
        made, starts = self.layout.placement, self.layout.placement.attachment_starts
        return {
            one.id: made.attachment_positions[starts[k] : starts[k + 1]].tobytes()
            + made.attachment_directions[starts[k] : starts[k + 1]].tobytes()
            + made.radii[k].tobytes()
            for k, one in enumerate(self.layout.program.hyperedges)
        }


def parents(program: Program) -> dict[str, str | None]:
    return {item.id: item.parent for item in program.items}


def and_ancestors(names: set[str], program: Program) -> set[str]:
    up = parents(program)
    found: set[str] = set()
    for name in names:
        here: str | None = name if name in up else None
        while here is not None:
            found.add(here)
            here = up[here]
    return found


def and_contents(names: set[str], program: Program) -> set[str]:
    found = set(names)
    for _ in program.items:
        found |= {item.id for item in program.items if item.parent in found}
    return found


def line_mates(names: set[str], program: Program) -> set[str]:
    """Those that line up with any of them."""
    return {
        name
        for line in program.layout.constraints
        if set(line.items) & names
        for name in line.items
    }


def concerned(edit: Json, before: Program, after: Program) -> set[str]:
    """Items that look or stand otherwise because the edit says so, by their ids afterwards."""
    emptied = {item.parent for item in before.items if item.parent} & {
        item.id for item in after.items
    } - {item.parent for item in after.items}
    filled = {item.parent for item in after.items if item.parent} - {
        item.parent for item in before.items
    }
    touched: set[str] = set()
    match edit["type"]:
        case "add_item":
            touched = {edit["item"]["id"]}
        case "set_item" if not {"color", "data"} & edit["fields"].keys():
            touched = {edit["id"]}
        case "reparent" | "group":
            touched = {edit["id"]} if "id" in edit else {*edit["items"], edit["tray"]["id"]}
        case "ungroup":
            touched = {item.id for item in before.items if item.parent == edit["id"]}
        case "rename_item":
            emptied = filled = set()
    return touched | emptied | filled


def may_move(edit: Json, before: Program, after: Program) -> set[str]:
    """Those that the edit concerns, what holds them, and what stands with any of these.

    Siblings make way in rows; and where there is no room for what holds them, it moves as a whole.
    """
    core = and_ancestors(concerned(edit, before, after), after)
    up = parents(after)
    rows = {item.id for item in after.items if item.kind in ROWS and after.notation == "sparcl"}
    beside = {name for name in up if up[name] in rows and up[name] in core}
    beside |= line_mates(core, before) | line_mates(core, after)
    return core | beside | left_helices(before, after)


def left_helices(before: Program, after: Program) -> set[str]:
    """What climbed with others that are gone stands on the ground again."""
    climbed, climb = (
        {name for line in program.layout.constraints if line.type == "helix" for name in line.items}
        for program in (before, after)
    )
    return (climbed - climb) & {item.id for item in after.items}


ROWS = {"literal", "ntuple"}
"""Kinds whose contents stand in rows."""


def without_room(core: set[str], before: Revision, after: Revision) -> set[str]:
    """Those of ``core`` that took all that is in them elsewhere: there was no room to grow."""
    old, new = before.places, after.places
    return {
        item.parent
        for item in after.layout.program.items
        if item.parent in core
        and item.id not in core
        and item.id in old
        and old[item.id] != new[item.id]
    }


def names_after(edit: Json) -> dict[str, str]:
    """New names by old ones."""
    return {edit["id"]: edit["to"]} if edit["type"].startswith("rename") else {}


def assert_still(edit: Json, before: Revision, after: Revision) -> None:
    news = names_after(edit)
    old = {news.get(name, name): place for name, place in before.places.items()}
    core = may_move(edit, before.layout.program, after.layout.program)
    moving = and_contents(core & without_room(core, before, after), after.layout.program)
    moving |= and_contents(
        core
        - and_ancestors(
            concerned(edit, before.layout.program, after.layout.program), after.layout.program
        ),
        after.layout.program,
    )
    moving |= core
    for name, place in after.places.items():
        if name in old and name not in moving:
            assert place == old[name], f"{name} moved"


def assert_colors_stay(edit: Json, before: Revision, after: Revision) -> None:
    news = names_after(edit)
    old = {news.get(name, name): hue for name, hue in before.hues.items()}
    assert {name: hue for name, hue in after.hues.items() if name in old} == {
        name: hue for name, hue in old.items() if name in after.hues
    }
    assert len(set(after.hues.values())) == len(after.hues), "two of one colour"


def assert_curves_stay(edit: Json, before: Revision, after: Revision) -> None:
    news = names_after(edit)
    if edit["type"] == "set_program" and "layout" in edit["fields"]:
        return
    old = {news.get(name, name): curve for name, curve in before.curves.items()}
    old_ends = {news.get(name, name): ends for name, ends in before.ends.items()}
    unmoved = {name for name, ends in after.ends.items() if old_ends.get(name) == ends}
    changed = {name for name in unmoved if after.curves[name] != old[name]}
    places = set(before.places.values())
    new = unmoved < after.curves.keys() or not places >= set(after.places.values())
    assert new or not changed, f"{changed} run otherwise, and nothing is new"


def assert_told(before: Revision, after: Revision) -> None:
    told = after.revised.changes
    for kind, was, now, differences in (
        ("items", before.places, after.places, told.items),
        ("hyperedges", before.curves, after.curves, told.hyperedges),
    ):
        said = {
            state: {part.id: part for part in getattr(revision.layout.program, kind)}
            for state, revision in (("was", before), ("now", after))
        }
        hues = (before.hues, after.hues) if kind == "hyperedges" else ({}, {})
        assert set(differences.added) == now.keys() - was.keys()
        assert set(differences.removed) == was.keys() - now.keys()
        assert set(differences.changed) == {
            name
            for name in now.keys() & was.keys()
            if (now[name], said["now"][name], hues[1].get(name))
            != (was[name], said["was"][name], hues[0].get(name))
        }


def assert_kept(before: Revision, after: Revision) -> None:
    """What is stored says the same when it is read again."""
    assert write_layout(after.layout) == after.revised.layout
    assert canonical(after.layout.program) == after.revised.document
    assert after.revised.items == len(after.places)
    assert after.revised.hyperedges == len(after.curves)
    undone = after.then(Restoration(before.revised.document, before.revised.layout))
    assert (undone.revised.document, undone.revised.layout, undone.revised.digest) == (
        before.revised.document,
        before.revised.layout,
        before.revised.digest,
    )


def assert_keeps_still(edit: Json, before: Revision, after: Revision) -> None:
    """Nothing moves or changes its colour that the edit does not concern, and all else is told."""
    assert_still(edit, before, after)
    assert_colors_stay(edit, before, after)
    assert_curves_stay(edit, before, after)
    assert_told(before, after)
    assert_kept(before, after)


@settings(max_examples=SEQUENCES)
@given(st.data())
def test_whatever_an_edit_does_not_concern_keeps_still(data: st.DataObject) -> None:
    revision = Revision.first(data.draw(programs()))
    for number in range(data.draw(st.integers(1, 4))):
        edit = data.draw(edits(revision.layout.program, number))
        after = revision.edited(edit)
        assert_keeps_still(edit, revision, after)
        revision = after


@settings(max_examples=2 * SEQUENCES)
@given(sequences(placed=False))
def test_after_edits_everything_stands_in_order(made: tuple[Program, tuple[Json, ...]]) -> None:
    program, done = made
    revision = Revision.first(program)
    for edit in done:
        revision = revision.edited(edit)
        assert_in_order(revision.layout.program, revision.layout.placement)


def assert_as_clear_as_anew(before: Revision, after: Revision) -> None:
    """Where hyperedges of the same placement can be kept apart anew, they are after an edit."""
    layout = after.layout
    if not is_certified(before.layout) or is_certified(layout):
        return
    wishes = layout.program.layout
    anew = route(layout.placement, clearance=wishes.clearance, routing=wishes.routing)
    assert not is_certified(replace(layout, routing=anew))


def is_certified(layout: Layout) -> bool:
    found = judge(layout)
    return found is not None and found.certificate.certified


@pytest.mark.parametrize("routing", ["elastic", "auto"])
@pytest.mark.parametrize("kind", [programs(), in_space()], ids=["ground", "space"])
@settings(max_examples=ROUTED)
@given(data=st.data())
def test_edits_of_what_is_routed_by_relaxation(
    kind: st.SearchStrategy[Program], routing: str, data: st.DataObject
) -> None:
    revision = Revision.first(routed(data.draw(kind), routing))
    for number in range(data.draw(st.integers(1, 3))):
        edit = data.draw(edits(revision.layout.program, number))
        after = revision.edited(edit)
        assert_keeps_still(edit, revision, after)
        assert_as_clear_as_anew(revision, after)
        revision = after


EXAMPLE = Path(__file__).parents[1] / "examples" / "id3-clause-2.json"


def example() -> Revision:
    return Revision.first(EXAMPLE.read_bytes())


def added(name: str, parent: str | None, **more: Any) -> Json:
    item = {"id": name, "kind": "variable", "label": name, **more}
    return {"type": "add_item", "item": item if parent is None else item | {"parent": parent}}


def relabelled(name: str, label: str) -> Json:
    return {"type": "set_item", "id": name, "fields": {"label": label}}


@pytest.mark.parametrize(
    ("edit", "moving"),
    [
        (added("New", "h.a1"), {"h.a1", "h", "c2"}),
        (added("New", "l1.a1"), {"l1.a1", "l1", "c2"}),
        (relabelled("l1.a1.v", "Examples"), {"l1.a1.v", "l1.a1", "l1", "c2"}),
        (relabelled("l1.a1.v", "As"), set()),
        (relabelled("l1", "Best"), set()),
        ({"type": "rename_item", "id": "c2", "to": "clause"}, {"c2", "clause"}),
        ({"type": "remove_item", "id": "l2"}, set()),
        (added("New", None), set()),
    ],
)  # fmt: skip
def test_trays_grow_to_where_there_is_room_and_move_nobody(edit: Json, moving: set[str]) -> None:
    before = example()
    after = before.edited(edit)
    moved = {
        name
        for name, place in after.places.items()
        if name in before.places and place != before.places[name]
    }
    assert moved <= moving


def test_in_a_row_without_room_neighbours_make_way_and_keep_their_order() -> None:
    before = example()
    after = before.edited(relabelled("l1.a2.v", "Attributes"))
    x = {
        item.id: float(center[0])
        for item, center in zip(
            after.layout.program.items, after.layout.placement.centers, strict=True
        )
    }
    assert x["l1.a1"] < x["l1.a2"] < x["l1.a3"]
    assert before.places["l2"] == after.places["l2"]
    assert_in_order(after.layout.program, after.layout.placement)


def test_one_that_leaves_a_row_leaves_the_others_and_all_curves_as_they_are() -> None:
    document = {
        "items": [{"id": name} for name in "abcd"],
        "hyperedges": [{"id": "e", "attachments": [{"item": "a"}, {"item": "d"}]}],
        "layout": {"constraints": [{"type": "row", "items": ["a", "b", "c", "d"]}]},
    }
    before = Revision.first(document)
    after = before.edited({"type": "remove_item", "id": "b"})
    assert after.places.items() <= before.places.items()
    assert after.curves == before.curves
    assert not after.revised.changes.whole


def test_hyperedges_that_touch_at_an_item_leave_each_other_alone() -> None:
    items = [{"id": name, "position": [3 * n, n % 2, 0]} for n, name in enumerate("abcd")]
    ends = {"e": "ab", "f": "bc"}
    before = Revision.first(
        {
            "items": items,
            "hyperedges": [
                {"id": name, "attachments": [{"item": end} for end in pair]}
                for name, pair in ends.items()
            ],
        }
    )
    new = {"id": "g", "attachments": [{"item": "b"}, {"item": "d"}]}
    after = before.edited({"type": "add_hyperedge", "hyperedge": new})
    assert before.curves.items() <= after.curves.items()
    assert after.hues == {**before.hues, "g": 2}


def test_a_colour_that_is_free_again_is_taken_again_and_no_other_changes() -> None:
    hyperedges = [{"id": str(n), "attachments": [{"item": "a"}, {"item": "b"}]} for n in range(4)]
    before = Revision.first({"items": [{"id": "a"}, {"id": "b"}], "hyperedges": hyperedges})
    after = before.edited(
        {"type": "remove_hyperedge", "id": "1"},
        {"type": "rename_hyperedge", "id": "2", "to": "two"},
        {"type": "add_hyperedge", "hyperedge": {**hyperedges[0], "id": "new"}},
    )
    assert after.hues == {"0": 0, "two": 2, "3": 3, "new": 1}


def test_patches_keep_still_too_and_say_what_changed() -> None:
    before = example()
    patch = [{"op": "add", "path": "/items/-", "value": {"id": "New", "parent": "h.a1"}}]
    after = before.then(JsonPatch(json.dumps(patch).encode()))
    told = after.revised.changes
    assert told.items.added == ("New",)
    assert set(told.items.changed) <= {"h.a1", "h", "c2"}
    assert told.hyperedges.present == frozenset()
    named = after.then(MergePatch(b'{"name": "Other"}'))
    assert named.places == after.places
    assert named.revised.name == "Other"
    assert named.revised.changes.whole
    assert named.revised.changes.items.present == frozenset()


def test_a_document_in_place_of_another_keeps_what_is_the_same() -> None:
    before = example()
    document = json.loads(before.revised.document)
    document["items"].reverse()
    after = before.then(Replacement(json.dumps(document).encode()))
    assert after.places == before.places


@pytest.mark.parametrize(
    ("change", "error"),
    [
        (Edits(as_bytes({"type": "remove_item", "id": "nothing"})), InconsistentDocument),
        (JsonPatch(b'[{"op": "remove", "path": "/items/999"}]'), PatchConflict),
        (MergePatch(b'{"items": [{"id": "a", "parent": "b"}]}'), InconsistentDocument),
    ],
)
def test_what_does_not_fit_is_refused(change: Change, error: type[Exception]) -> None:
    before = example().revised
    with pytest.raises(error):
        revise(before.document, before.layout, change, SETTINGS)


def test_without_a_layout_that_can_be_read_it_is_laid_out_anew_and_stored_so() -> None:
    before = example().revised
    other = write_layout_of_another_form(before.layout)
    after = revise(before.document, before.layout, Restoration(before.document, other), SETTINGS)
    assert after.layout == before.layout
    assert revise(before.document, other, MergePatch(b"{}"), SETTINGS).layout == before.layout


def write_layout_of_another_form(layout: bytes) -> bytes:
    with np.load(io.BytesIO(layout)) as arrays:
        told = {**arrays, "form": np.array(-1)}
    file = io.BytesIO()
    np.savez(file, **told)
    return file.getvalue()


def nodes(body: bytes) -> dict[str, Any]:
    """Of each node its place, and its meshes and materials as they are stored."""
    asset = Asset.from_glb(body)
    found = {}
    for node in asset.json["nodes"]:
        if node.get("extras", {}).get("shows") in {"item", "hyperedge"}:
            mesh = asset.json["meshes"][node["mesh"]] if "mesh" in node else {"primitives": []}
            parts = [
                (
                    asset.values(part["attributes"]["POSITION"]).tobytes(),
                    asset.values(part["indices"]).tobytes(),
                    json.dumps(asset.json["materials"][part["material"]], sort_keys=True),
                )
                for part in mesh["primitives"]
            ]
            place = {key: node.get(key) for key in ("translation", "rotation", "extras")}
            found[node["name"]] = (place, parts)
    return found


@settings(max_examples=SEQUENCES // 3)
@given(sequences(most=3))
def test_a_scene_of_what_changed_makes_the_old_scene_the_new_one(
    made: tuple[Program, tuple[Json, ...]],
) -> None:
    program, done = made
    before = Revision.first(program)
    after = before.edited(*done)
    changes = after.revised.changes
    old, new = (glb(revision) for revision in (before, after))
    part = glb(after, since(after))
    shown = nodes(part)
    assert shown.keys() == changes.items.present | changes.hyperedges.present
    assert shown.items() <= nodes(new).items()
    told = Asset.from_glb(part).json["scenes"][0]["extras"]["delta"]
    assert (told["since"], told["revision"]) == (1, 2)
    gone = {*told["removed"]["items"], *told["removed"]["hyperedges"]}
    if not changes.whole:
        kept = {name: node for name, node in nodes(old).items() if name not in gone}
        assert without_detail(kept | shown) == without_detail(nodes(new))


@pytest.mark.parametrize("make", [random_program, random_in_space])
def test_only_what_is_new_or_moves_is_in_the_scene_of_an_edit(
    make: Callable[[int, int], RandomProgram | RandomSpace],
) -> None:
    document = make(10, 3).document(routing="elastic")
    new = document["hyperedges"].pop()
    before = Revision.first(document)
    after = before.edited({"type": "add_hyperedge", "hyperedge": new})
    assert nodes(glb(after, since(after))).keys() == {new["id"]}
    assert is_certified(after.layout)

    item = document["items"][0]
    x, y, z = item["position"]
    fields = {"position": [x, y, z + 0.05]}
    moved = after.edited({"type": "set_item", "id": item["id"], "fields": fields})
    tubes = {
        hyperedge["id"]
        for hyperedge in [*document["hyperedges"], new]
        if any(end["item"] == item["id"] for end in hyperedge["attachments"])
    }
    assert tubes
    assert nodes(glb(moved, since(moved))).keys() == {item["id"], *tubes}
    assert is_certified(moved.layout)


def since(after: Revision) -> Delta:
    """What the last edit changed."""
    told = after.revised.changes
    parts = told.items.present, told.hyperedges.present
    return Delta(1, 2, *parts, told.items.removed, told.hyperedges.removed)


def without_detail(found: dict[str, Any]) -> dict[str, Any]:
    """The same but for what the meshes' fineness decides, which is another in a larger scene."""
    return {
        name: (
            place["extras"] if place["extras"]["shows"] == "hyperedge" else place,
            [material for *_, material in parts],
        )
        for name, (place, parts) in found.items()
    }


def glb(revision: Revision, delta: Delta | None = None) -> bytes:
    options = RenderOptions(SceneFormat.GLB, 64, 48, delta=delta)
    revised = revision.revised
    made = answer(revised.document, options, SETTINGS, layout=revised.layout)
    assert isinstance(made, Answer)
    return made.body


def test_the_pipeline_revises() -> None:
    before = example().revised
    change = Edits(as_bytes(added("New", "h.a1")))
    made = answer(before.document, ReviseOptions(change), SETTINGS, layout=before.layout)
    assert made == revise(before.document, before.layout, change, SETTINGS)
