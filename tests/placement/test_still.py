"""Placements after an edit: who stays, who grows to where, and who makes way."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.arrays import Floats
from app.notations.loader import load_notation
from app.placement.beside import beside, overlaps
from app.placement.place import place
from app.placement.placement import Placement
from app.placement.standing import Standing
from app.program.model import Program
from tests.placement.standing_rules import assert_in_order

Json = dict[str, Any]


class Placed:
    """A document and its placement, which may go on from that of another one."""

    def __init__(self, document: Json, before: Placed | None = None) -> None:
        self.program = Program.model_validate(document)
        standing = None if before is None else before.standing
        self.made: Placement = place(self.program, load_notation(self.program.notation), standing)
        self.names = [item.id for item in self.program.items]

    @property
    def standing(self) -> Standing:
        return Standing.of(self.program, self.made)

    def center(self, name: str) -> list[float]:
        center: list[float] = self.made.centers[self.names.index(name)].tolist()
        return center

    def size(self, name: str) -> list[float]:
        size: list[float] = self.made.sizes[self.names.index(name)].tolist()
        return size

    def moved(self, before: Placed) -> set[str]:
        """Items that are at another place, or of another size."""
        return {
            name
            for name in self.names
            if name in before.names
            and (self.center(name), self.size(name)) != (before.center(name), before.size(name))
        }


def tray(*contents: str, name: str = "t", **more: Any) -> list[Json]:
    return [{"id": name, "shape": {"type": "tray"}, **more}] + [
        {"id": one, "parent": name} for one in contents
    ]


def items(*groups: list[Json], **more: Any) -> Json:
    return {"items": [item for group in groups for item in group], **more}


def test_the_same_document_stands_as_it_stood() -> None:
    document = items(tray("a", "b"), tray("c", name="u"), [{"id": "d", "position": [9, 9, 0]}])
    before = Placed(document)
    assert Placed(document, before).moved(before) == set()


def test_a_new_item_stands_beside_the_others_and_the_tray_grows() -> None:
    before = Placed(items(tray("a", "b")))
    after = Placed(items(tray("a", "b", "new")), before)
    assert after.moved(before) == {"t"}
    assert_in_order(after.program, after.made)


def test_what_goes_leaves_a_gap_that_the_next_one_fills() -> None:
    before = Placed(items(tray("a", "b", "c", "d")))
    between = Placed(items(tray("a", "c", "d")), before)
    assert between.moved(before) == set()
    after = Placed(items(tray("a", "c", "d", "new")), between)
    assert after.moved(before) == set()
    assert after.center("new") == pytest.approx(before.center("b"))


def test_a_tray_grows_away_from_its_neighbour() -> None:
    left, right = tray("a", name="l"), tray("b", name="r")
    line = {"layout": {"constraints": [{"type": "row", "items": ["l", "r"]}]}}
    before = Placed(items(left, right, **line))
    for side, group in (("l", left), ("r", right)):
        more = [*group, {"id": "new", "parent": side}, {"id": "newer", "parent": side}]
        groups = (more, right) if side == "l" else (left, more)
        after = Placed(items(*groups, **line), before)
        assert after.moved(before) <= {side}
        assert_in_order(after.program, after.made)


def test_in_a_row_the_neighbours_on_one_side_make_way() -> None:
    row = {"layout": {"constraints": [{"type": "row", "items": ["a", "b", "c", "d", "e"]}]}}
    small = [{"id": name} for name in "abcde"]
    before = Placed({"items": small, **row})
    large = [{**item, "label": "a long label"} if item["id"] == "b" else item for item in small]
    after = Placed({"items": large, **row}, before)
    assert after.moved(before) == {"a", "b"}, "the fewest move"
    x = [after.center(name)[0] for name in "abcde"]
    assert x == sorted(x)
    assert_in_order(after.program, after.made)


def test_in_a_column_too() -> None:
    column = {"layout": {"constraints": [{"type": "column", "items": ["a", "b", "c"]}]}}
    small = [{"id": name, "shape": {"type": "box", "size": [1, 1, 1]}} for name in "abc"]
    before = Placed({"items": small, **column})
    deep = {"id": "c", "shape": {"type": "box", "size": [1, 3, 1]}}
    after = Placed({"items": [*small[:2], deep], **column}, before)
    assert after.moved(before) == {"c"}
    deep = {"id": "b", "shape": {"type": "box", "size": [1, 3, 1]}}
    after = Placed({"items": [small[0], deep, small[2]], **column}, before)
    assert len(after.moved(before)) == 2
    y = [after.center(name)[1] for name in "abc"]
    assert y == sorted(y, reverse=True)
    assert_in_order(after.program, after.made)


def test_elsewhere_what_finds_no_room_goes_to_a_place_nearby() -> None:
    names = [f"i{number}" for number in range(25)]
    small = [{"id": name, "shape": {"type": "box", "size": [1, 1, 1]}} for name in names]
    before = Placed({"items": small})
    middle = min(names, key=lambda name: float(np.linalg.norm(before.center(name)[:2])))
    large = [
        {"id": name, "shape": {"type": "box", "size": [3, 3, 1]}} if name == middle else item
        for name, item in zip(names, small, strict=True)
    ]
    after = Placed({"items": large}, before)
    assert after.moved(before) == {middle}
    assert_in_order(after.program, after.made)


def test_a_helix_stands_whole_or_is_wound_anew() -> None:
    names = [f"i{number}" for number in range(6)]
    helix = {"layout": {"constraints": [{"type": "helix", "items": names}]}}
    plain: list[Json] = [{"id": name} for name in names]
    before = Placed({"items": plain, **helix})
    more = Placed({"items": [*plain, {"id": "new"}], **helix}, before)
    assert more.moved(before) == set()
    larger = [{**plain[0], "shape": {"type": "box", "size": [2, 2, 2]}}, *plain[1:]]
    after = Placed({"items": larger, **helix}, before)
    heights = [after.center(name)[2] for name in names]
    assert heights == sorted(heights)
    assert len(set(heights)) == len(heights)


def test_what_stands_on_a_block_rises_with_it() -> None:
    block = {"id": "b", "shape": {"type": "box", "size": [3, 3, 1]}}
    before = Placed({"items": [block, {"id": "c", "parent": "b"}]})
    taller = {"id": "b", "shape": {"type": "box", "size": [3, 3, 2]}}
    after = Placed({"items": [taller, {"id": "c", "parent": "b"}]}, before)
    assert after.center("c") == pytest.approx([*before.center("c")[:2], before.center("c")[2] + 1])


def test_a_block_takes_a_label_that_fits_without_growing() -> None:
    before = Placed({"items": [{"id": "a", "label": "wide enough"}, {"id": "b"}]})
    after = Placed({"items": [{"id": "a", "label": "wide enoug"}, {"id": "b"}]}, before)
    assert after.moved(before) == set()


def test_a_tray_keeps_its_room_under_another_label() -> None:
    before = Placed(items(tray("a", "b", label="the longer one")))
    assert Placed(items(tray("a", "b", label="other one")), before).moved(before) == set()
    longer = Placed(items(tray("a", "b", label="one that is much too long for it")), before)
    assert longer.moved(before) == {"t"}
    assert_in_order(longer.program, longer.made)


def test_an_item_that_loses_its_position_stays_where_it_was() -> None:
    before = Placed({"items": [{"id": "a", "position": [5, 6, 0.25]}, {"id": "b"}]})
    after = Placed({"items": [{"id": "a"}, {"id": "b"}]}, before)
    assert after.moved(before) == set()


def test_a_tray_around_what_has_positions_never_moves() -> None:
    inside = {"id": "p", "parent": "t", "position": [0, 0, 0.4]}
    before = Placed(items(tray("a"), [inside]))
    after = Placed(items(tray("a", "new"), [inside]), before)
    assert after.moved(before) <= {"t"}
    assert after.center("t") == before.center("t")


def test_another_notation_begins_anew() -> None:
    document = items(tray("a", "b"))
    other = {**document, "notation": "sparcl"}
    anew, after = Placed(other), Placed(other, Placed(document))
    assert after.made.centers.tolist() == anew.made.centers.tolist()


def test_a_tray_grows_between_its_neighbours_but_becomes_no_tower() -> None:
    line = {"layout": {"constraints": [{"type": "row", "items": ["l", "t", "r"]}]}}
    names = [f"i{number}" for number in range(20)]
    before = Placed(items(tray("a", name="l"), tray("b"), tray("c", name="r"), **line))
    for count in range(1, len(names) + 1):
        groups = tray("a", name="l"), tray("b", *names[:count]), tray("c", name="r")
        before = Placed(items(*groups, **line), before)
        assert_in_order(before.program, before.made)
    width, depth, _ = before.size("t")
    assert max(width, depth) < 6 * min(width, depth)


rectangles = st.lists(
    st.tuples(st.integers(-5, 5), st.integers(-5, 5), st.integers(1, 4), st.integers(1, 4)),
    min_size=1,
    max_size=12,
).map(lambda made: np.array([[x, y, x + w, y + d] for x, y, w, d in made], dtype=np.float64))

sizes = st.tuples(st.floats(0.1, 5), st.floats(0.1, 5))


@given(rectangles, sizes, st.floats(0.01, 1), st.sampled_from(("row", "column", "rows")))
def test_a_place_beside_others_is_free(
    taken: Floats, size: tuple[float, float], gap: float, arrangement: Any
) -> None:
    x, y = beside(taken, size, gap, arrangement)
    assert not overlaps(around((x, y), size), taken, gap)


@given(rectangles, sizes, st.floats(0.01, 1), st.integers(0, 3))
def test_a_place_is_within_the_room_that_there_is(
    taken: Floats, size: tuple[float, float], gap: float, side: int
) -> None:
    room = np.concatenate([taken[:, :2].min(axis=0), taken[:, 2:].max(axis=0)])
    room[side] = -np.inf if side < 2 else np.inf
    across = side % 2 == 0
    if size[1 if across else 0] > (room[3] - room[1] if across else room[2] - room[0]):
        return
    made = around(beside(taken, size, gap, "rows", room, near=(0.0, 0.0)), size)
    assert (made[:2] >= room[:2] - 1e-6).all()
    assert (made[2:] <= room[2:] + 1e-6).all()


@given(rectangles, sizes, st.tuples(st.floats(-9, 9), st.floats(-9, 9)))
def test_a_place_near_another_one_is_not_far_away(
    taken: Floats, size: tuple[float, float], near: tuple[float, float]
) -> None:
    place = beside(taken, size, 0.1, "rows", near=near)
    reach = np.concatenate([np.abs(taken).max(axis=0), np.abs(near)]).max()
    assert np.hypot(place[0] - near[0], place[1] - near[1]) <= 4 * reach + sum(size)


def around(center: tuple[float, float], size: tuple[float, float]) -> Floats:
    half = np.array(size) / 2
    return np.concatenate([np.array(center) - half, np.array(center) + half])
