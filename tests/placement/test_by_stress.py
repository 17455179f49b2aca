from __future__ import annotations

from itertools import combinations, pairwise
from typing import Any, Literal

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.hyperedges.clearance.overlaps import find_overlaps
from app.notations.loader import load_notation
from app.placement.place import place
from app.placement.placement import Placement
from app.placement.standing import Standing
from app.program.model import Program

Stress = Literal["ground", "sheet", "space"]
MODES: tuple[Stress, ...] = ("ground", "sheet", "space")
modes = pytest.mark.parametrize("mode", MODES)


def document(
    count: int, hyperedges: int, mode: str, seed: int = 0, **layout: Any
) -> dict[str, Any]:
    chance = np.random.default_rng(seed)
    shapes: list[dict[str, Any]] = [{"type": "sphere"}, {"type": "box"}, {"type": "cylinder"}]
    joined = [
        chance.choice(count, min(count, int(chance.integers(2, 5))), replace=False)
        for _ in range(hyperedges)
    ]
    return {
        "items": [
            {"id": f"i{k}", "label": "l" * int(chance.integers(1, 12)), "shape": shapes[k % 3]}
            for k in range(count)
        ],
        "hyperedges": [
            {"id": f"h{k}", "attachments": [{"item": f"i{item}"} for item in each]}
            for k, each in enumerate(joined)
        ],
        "layout": {"placement": mode, **layout},
    }


def laid(source: dict[str, Any], standing: Standing | None = None) -> tuple[Program, Placement]:
    program = Program.model_validate(source)
    return program, place(program, load_notation(program.notation), standing)


def after(source: dict[str, Any], edited: dict[str, Any]) -> tuple[Placement, Placement]:
    """How a document is placed, and how the edited one is after it."""
    program, before = laid(source)
    return before, laid(edited, Standing.of(program, before))[1]


@settings(max_examples=25)
@given(st.integers(2, 15), st.integers(0, 20), st.sampled_from(MODES), st.integers(0, 1000))
def test_nothing_overlaps(count: int, hyperedges: int, mode: Stress, seed: int) -> None:
    _, made = laid(document(count, hyperedges, mode, seed))
    assert len(find_overlaps(made).items) == 0
    for one, other in combinations(range(count), 2):
        boxes = [_reach(made, number) for number in (one, other)]
        assert (boxes[0][1] < boxes[1][0]).any() or (boxes[1][1] < boxes[0][0]).any()
    flat = {"ground": made.centers[:, 2] - made.sizes[:, 2] / 2, "sheet": made.centers[:, 1]}
    assert mode == "space" or np.ptp(flat[mode]) < 1e-9


def _reach(made: Placement, number: int) -> tuple[Any, Any]:
    """Low and high corner of an item that is not turned, with its label."""
    center, half = made.centers[number], made.sizes[number] / 2
    label = made.labels[number]
    low, high = center - half, center + half
    if label is not None:
        # Labels stand upright: their own depth is along y.
        x, y, z = label.position
        ink = np.array([label.size[0], label.size[2], label.size[1]]) / 2
        low = np.minimum(low, center + np.array([x, y, z]) - ink)
        high = np.maximum(high, center + np.array([x, y, z]) + ink)
    return low, high


@modes
def test_items_with_positions_stay_and_others_are_around_them(mode: Stress) -> None:
    source = document(12, 14, mode, 3)
    places = {0: [5.0, 1.5, 2.0], 4: [-3.25, 1.5, 7.0], 7: [0.1, 1.5, 0.3]}
    for number, position in places.items():
        source["items"][number]["position"] = position
    _, made = laid(source)
    for number, position in places.items():
        assert made.centers[number].tolist() == position
    assert len(find_overlaps(made).items) == 0
    if mode == "sheet":
        assert (made.centers[:, 1] == 1.5).all()


@modes
def test_an_item_added_stands_near_what_it_is_joined_to_and_moves_no_other(mode: Stress) -> None:
    source = document(20, 18, mode, 5)
    edited = document(20, 18, mode, 5)
    edited["items"].append({"id": "new", "label": "new"})
    ends = [{"item": name} for name in ("new", "i3")]
    edited["hyperedges"].append({"id": "n", "attachments": ends})
    before, now = after(source, edited)
    assert (now.centers[:20] == before.centers).all()
    far = np.linalg.norm(now.centers[:20] - now.centers[20], axis=1)
    assert far[3] < np.median(far)
    assert len(find_overlaps(now).items) == 0


@modes
def test_an_item_taken_away_leaves_its_place(mode: Stress) -> None:
    source = document(14, 12, mode, 8)
    edited = document(14, 12, mode, 8)
    gone = edited["items"].pop(2)["id"]
    edited["hyperedges"] = [
        each
        for each in edited["hyperedges"]
        if all(end["item"] != gone for end in each["attachments"])
    ]
    before, now = after(source, edited)
    assert (now.centers == np.delete(before.centers, 2, axis=0)).all()


@modes
def test_what_grows_stays_or_finds_room_and_moves_no_other(mode: Stress) -> None:
    source = document(14, 12, mode, 2)
    edited = document(14, 12, mode, 2)
    edited["items"][1]["shape"] = {"type": "box", "size": [5, 1, 3]}
    before, now = after(source, edited)
    assert (np.delete(now.centers, 1, axis=0) == np.delete(before.centers, 1, axis=0)).all()
    assert len(find_overlaps(now).items) == 0


def test_another_mode_places_all_anew() -> None:
    before, now = after(document(9, 9, "sheet"), document(9, 9, "ground"))
    assert (now.centers == laid(document(9, 9, "ground"))[1].centers).all()
    assert now.mode == "ground" != before.mode


def test_contents_of_a_tray_on_the_ground_are_placed_by_what_joins_them() -> None:
    # A ring whose items are numbered at random, in a tray.
    order = np.random.default_rng(1).permutation(16).tolist()
    ring = list(zip(order, order[1:] + order[:1], strict=True))
    source: dict[str, Any] = {
        "items": [{"id": "tray", "label": "ring"}]
        + [{"id": f"i{k}", "parent": "tray"} for k in range(16)],
        "hyperedges": [
            {"id": f"h{k}", "attachments": [{"item": f"i{a}"}, {"item": f"i{b}"}]}
            for k, (a, b) in enumerate(ring)
        ],
        "layout": {"placement": "ground"},
    }
    _, made = laid(source)
    inside = np.abs(made.centers[1:, :2] - made.centers[0, :2]) + made.sizes[1:, :2] / 2
    assert (inside <= made.sizes[0, :2] / 2).all()
    source["layout"]["placement"] = "rows"
    _, rows = laid(source)

    def longest(placement: Placement) -> float:
        """Of the ways between neighbours, over the width of all."""
        pairs = np.array(ring) + 1
        ways = placement.centers[pairs[:, 0]] - placement.centers[pairs[:, 1]]
        return float(np.linalg.norm(ways, axis=1).max() / np.ptp(placement.centers[1:, 0]))

    assert longest(made) < longest(rows)
    assert len(find_overlaps(made).items) == 0


@pytest.mark.parametrize("mode", ["sheet", "space"])
def test_ends_leave_on_the_side_of_what_they_join(mode: Stress) -> None:
    source = document(16, 20, mode, 4)
    _, made = laid(source)
    starts, items = made.attachment_starts, made.attachment_items
    for begin, end in pairwise(starts):
        if end - begin != 2:
            continue
        for here, there in ((begin, end - 1), (end - 1, begin)):
            way = made.centers[items[there]] - made.centers[items[here]]
            assert way @ made.attachment_directions[here] > -0.2 * np.linalg.norm(way)
            # Nor through the label on the front.
            assert made.attachment_directions[here, 1] > -0.9


def test_a_flat_drawing_of_a_sheet_lies_on_the_ground() -> None:
    source = document(9, 9, "sheet", 0, dimensions=2)
    _, made = laid(source)
    assert made.mode == "ground"
    assert np.ptp(made.centers[:, 1]) > 1.0


@pytest.mark.parametrize(
    ("change", "mode"),
    [
        ({}, "sheet"),
        ({"layout": {"dimensions": 2}}, "ground"),
        ({"layout": {"routing": "planes"}}, "rows"),
        ({"layout": {"fidelity": "paper"}}, "rows"),
        ({"layout": {"clearance": None}}, "rows"),
        ({"item": {"position": [0, 0, 0]}}, "rows"),
        ({"item": {"parent": "i1"}}, "rows"),
        ({"hyperedges": 11}, "rows"),
    ],
)
def test_auto_puts_graphs_on_a_sheet_and_others_in_rows(change: dict[str, Any], mode: str) -> None:
    source = document(9, change.get("hyperedges", 12), "auto", **change.get("layout", {}))
    source["items"][0].update(change.get("item", {}))
    assert laid(source)[1].mode == mode


def test_after_an_edit_auto_stays_with_the_mode_that_there_was() -> None:
    before, now = after(document(9, 12, "auto"), document(9, 11, "auto"))
    assert before.mode == now.mode == "sheet"
    assert (before.centers == now.centers).all()
