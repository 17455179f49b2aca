import json
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from app.arrays import Floats
from app.notations.loader import load_notation
from app.placement.place import place
from app.placement.placement import Placement
from app.program.model import Program
from app.solids.extents import size_of
from app.solids.solid import Box, Text, Tray

EXAMPLES = Path(__file__).parents[2] / "examples"


def placed(document: dict[str, Any]) -> Placement:
    program = Program.model_validate(document)
    return place(program, load_notation(program.notation))


def example(name: str) -> tuple[Program, Placement]:
    program = Program.model_validate_json((EXAMPLES / f"{name}.json").read_bytes())
    return program, place(program, load_notation(program.notation))


def boxes(placement: Placement) -> Floats:
    """Low and high corners (n, 2, 3) of items that are not turned."""
    half = placement.sizes / 2
    return np.stack([placement.centers - half, placement.centers + half], axis=1)


def attach(*names: str) -> dict[str, Any]:
    return {"hyperedges": [{"id": "e", "attachments": [{"item": name} for name in names]}]}


def test_items_with_positions_stay_exactly_there() -> None:
    positions = [[0.1, 0.2, 0.3], [-5, 1e-7, 12]]
    made = placed({"items": [{"id": str(n), "position": p} for n, p in enumerate(positions)]})
    assert made.centers.tolist() == positions


def test_positions_of_children_are_relative_to_their_turned_parent() -> None:
    parent = {"id": "p", "position": [10, 0, 0], "rotation": [0, 0, 90]}
    made = placed({"items": [parent, {"id": "c", "parent": "p", "position": [2, 0, 1]}]})
    np.testing.assert_allclose(made.centers[1], [10, 2, 1], atol=1e-12)
    np.testing.assert_allclose(made.rotations[1], made.rotations[0], atol=1e-12)


def test_free_roots_stand_on_the_ground_side_by_side() -> None:
    made = placed({"items": [{"id": name, "label": name * 4} for name in "abcdef"]})
    assert (boxes(made)[:, 0, 2] == 0).all()
    assert len({tuple(center) for center in made.centers}) == 6


def test_a_child_of_a_block_stands_on_top_of_it() -> None:
    parent = {"id": "p", "shape": {"type": "box", "size": [4, 4, 1]}}
    made = placed({"items": [parent, {"id": "c", "parent": "p"}]})
    assert boxes(made)[1, 0, 2] == pytest.approx(1.0)


def test_sizes_of_the_document_are_kept() -> None:
    shapes: list[dict[str, Any]] = [
        {"type": "box", "size": [0.5, 0.25, 3]},
        {"type": "tray", "size": [9, 8, 2], "wall": 0.5},
        {"type": "sphere", "radius": 2},
        {"type": "cylinder", "radius": 0.25, "height": 4},
        {"type": "cone", "radius": 0.25, "height": 4},
        {"type": "arrow", "length": 7, "radius": 0.5},
    ]
    made = placed(
        {"items": [{"id": str(n), "shape": s, "label": "long label"} for n, s in enumerate(shapes)]}
    )
    assert made.sizes.tolist() == [
        [0.5, 0.25, 3], [9, 8, 2], [4, 4, 4], [0.5, 0.5, 4], [0.5, 0.5, 4], [7, 1, 1],
    ]  # fmt: skip


trees = st.integers(1, 25).flatmap(
    lambda count: st.tuples(
        st.tuples(*[st.integers(-1, number - 1) for number in range(count)]),
        st.lists(
            st.sampled_from(["", "x", "label", "a longer label"]), min_size=count, max_size=count
        ),
        st.lists(
            st.sampled_from(["variable", "literal", "constant", "argument", "clause"]),
            min_size=count,
            max_size=count,
        ),
    )
)


@settings(max_examples=60)
@given(trees, st.sampled_from(["plain", "sparcl"]))
def test_siblings_do_not_overlap_and_lie_within_their_tray(
    tree: tuple[tuple[int, ...], list[str], list[str]], notation: str
) -> None:
    parents, labels, kinds = tree
    items = [
        {"id": str(n), "label": label, "kind": kind}
        | ({"parent": str(parent)} if parent >= 0 else {})
        for n, (parent, label, kind) in enumerate(zip(parents, labels, kinds, strict=True))
    ]
    made = placed({"items": items, "notation": notation})
    corners = boxes(made)
    for number, parent in enumerate(parents):
        low, high = corners[number]
        for other in range(number):
            if parents[other] == parent:
                apart = np.maximum(low - corners[other][1], corners[other][0] - high)[:2]
                assert apart.max() > 0.05
        if parent >= 0 and isinstance(made.solids[parent], Tray):
            tray = made.solids[parent]
            assert isinstance(tray, Tray)
            inner = corners[parent] + np.array([[tray.wall], [-tray.wall]])
            assert (low[:2] > inner[0, :2]).all()
            assert (high[:2] < inner[1, :2]).all()
            assert low[2] == pytest.approx(corners[parent][0, 2] + tray.floor)


@pytest.mark.parametrize("name", ["id3-clause-1", "id3-clause-2"])
def test_the_papers_programs_come_out_compact(name: str) -> None:
    program, made = example(name)
    size = [float(length) for length in made.sizes[0]]
    assert 0.7 < size[0] / size[1] < 2.2
    leaves = {item.parent for item in program.items}
    blocks = sum(
        float(made.sizes[n][0] * made.sizes[n][1])
        for n, item in enumerate(program.items)
        if item.id not in leaves
    )
    assert blocks / (size[0] * size[1]) > 0.06


@pytest.mark.parametrize("name", ["id3-clause-1", "id3-clause-2"])
def test_the_same_kind_looks_alike(name: str) -> None:
    program, made = example(name)
    heights = {
        float(made.sizes[n][2]) for n, item in enumerate(program.items) if item.kind == "variable"
    }
    assert len(heights) == 1


def test_labels_lie_on_their_items() -> None:
    program, made = example("id3-clause-2")
    for item, size, solid, label in zip(
        program.items, made.sizes, made.solids, made.labels, strict=True
    ):
        assert (label is None) == (not item.label)
        if label is None:
            continue
        width, tall, _ = size_of(label.text)
        x, y, z = label.position
        assert abs(x) + width / 2 <= size[0] / 2
        if isinstance(solid, Box):
            assert y == -size[1] / 2
            assert abs(z) + tall / 2 <= size[2] / 2
        else:
            assert abs(y) + tall / 2 <= size[1] / 2


@settings(max_examples=60)
@given(
    st.lists(
        st.tuples(
            st.sampled_from(["sphere", "cylinder", "cone", "arrow", "box", "text"]),
            st.tuples(*[st.sampled_from([0, 30, 90, 180, -75])] * 3),
            st.sampled_from(["x", "a longer label"]),
        ),
        min_size=2,
        max_size=6,
    )
)
def test_labels_of_turned_items_keep_clear_of_their_siblings_and_their_tray(
    children: list[tuple[str, tuple[int, int, int], str]],
) -> None:
    items: list[dict[str, Any]] = [{"id": "tray", "label": "contents"}]
    for number, (shape, turn, label) in enumerate(children):
        turned_child = {"shape": {"type": shape}, "rotation": list(turn), "label": label}
        items.append({"id": str(number), "parent": "tray", **turned_child})
    made = placed({"items": items})
    boxes_seen = [box_with_label(made, number) for number in range(1, len(items))]
    for number, (low, high) in enumerate(boxes_seen):
        for other_low, other_high in boxes_seen[:number]:
            assert np.maximum(low - other_high, other_low - high).max() > 0
    tray, caption = made.solids[0], made.labels[0]
    assert isinstance(tray, Tray)
    assert caption is not None
    inner = made.sizes[0, :2] / 2 - tray.wall
    caption_top = made.centers[0, 1] + caption.position[1] + size_of(caption.text)[1] / 2
    for low, high in boxes_seen:
        assert (low > made.centers[0, :2] - inner).all()
        assert (high < made.centers[0, :2] + inner).all()
        assert low[1] > caption_top


def box_with_label(made: Placement, number: int) -> tuple[Floats, Floats]:
    """Low and high corners (2,), seen from above, of an item and its label, turned as they are."""
    solids = [(made.sizes[number], np.zeros(3), Rotation.identity())]
    label = made.labels[number]
    if label is not None:
        place_of_label = (np.array(label.position), Rotation.from_quat(label.rotation))
        solids.append((np.array(size_of(label.text)), *place_of_label))
    unit = np.array(list(product((-0.5, 0.5), repeat=3)))
    own = np.concatenate([turn.apply(unit * size) + at for size, at, turn in solids])
    seen = Rotation.from_quat(made.rotations[number]).apply(own) + made.centers[number]
    return seen[:, :2].min(axis=0), seen[:, :2].max(axis=0)


@pytest.mark.parametrize("count", [1, 2, 13])
def test_letters_without_ink_take_a_place_but_no_room(count: int) -> None:
    text = {"label": "\N{ZERO WIDTH SPACE}", "shape": {"type": "text"}}
    made = placed({"items": [{"id": str(number), **text} for number in range(count)]})
    assert (made.sizes == 0).all()
    assert len({tuple(center) for center in made.centers}) == count


def test_without_labels_nothing_is_written_and_no_room_is_taken() -> None:
    items = [{"id": "a", "label": "a very long label indeed"}]
    shown = placed({"items": items})
    hidden = placed({"items": items, "style": {"labels": False}})
    assert hidden.labels == (None,)
    assert hidden.sizes[0][0] < shown.sizes[0][0]


def test_hyperedges_end_on_top_of_items() -> None:
    made = placed({"items": [{"id": "a"}, {"id": "b"}], **attach("b", "a")})
    top = made.centers + np.array([0.0, 0.0, 0.5]) * made.sizes
    np.testing.assert_allclose(made.attachment_positions, top[[1, 0]])
    assert made.attachment_items.tolist() == [1, 0]
    assert made.attachment_starts.tolist() == [0, 2]


def test_at_a_tray_they_end_on_the_rim_of_its_back_wall() -> None:
    made = placed({"items": [{"id": "t"}, {"id": "c", "parent": "t"}], **attach("t", "c")})
    tray = made.solids[0]
    assert isinstance(tray, Tray)
    expected = made.centers[0] + [0, made.sizes[0][1] / 2 - tray.wall / 2, made.sizes[0][2] / 2]
    np.testing.assert_allclose(made.attachment_positions[0], expected)


def test_named_points_turn_with_their_item() -> None:
    point = {"id": "p", "position": [1, 0, 0], "direction": [3, 0, 0]}
    item = {"id": "a", "position": [0, 0, 5], "rotation": [0, 0, 90], "attachment_points": [point]}
    edge = {"id": "e", "attachments": [{"item": "a", "point": "p"}, {"item": "b"}]}
    made = placed({"items": [item, {"id": "b"}], "hyperedges": [edge]})
    np.testing.assert_allclose(made.attachment_positions[0], [0, 1, 5], atol=1e-12)
    np.testing.assert_allclose(made.attachment_directions[0], [0, 1, 0], atol=1e-12)


def test_what_lines_up_stands_in_one_line_in_order() -> None:
    names = [str(n) for n in range(9)]
    for kind, axis, sign in (("row", 0, 1), ("column", 1, -1)):
        layout = {"constraints": [{"type": kind, "items": ["7", "2", "5"]}]}
        made = placed({"items": [{"id": name} for name in names], "layout": layout})
        line = made.centers[[7, 2, 5]]
        assert len(set(line[:, 1 - axis].round(9))) == 1
        assert (np.diff(line[:, axis]) * sign > 0).all()


def test_lines_stand_each_in_their_own_row() -> None:
    names = [str(n) for n in range(40)]
    pairs = [[names[n + 1], names[n]] for n in range(0, 40, 2)]
    layout = {"constraints": [{"type": "row", "items": pair} for pair in pairs]}
    made = placed({"items": [{"id": name} for name in names], "layout": layout})
    assert (made.centers[1::2, 0] < made.centers[::2, 0]).all()
    np.testing.assert_array_equal(made.centers[1::2, 1], made.centers[::2, 1])
    assert len({tuple(center) for center in made.centers}) == 40


def test_free_children_stand_before_those_with_positions() -> None:
    fixed = {"id": "f", "parent": "t", "position": [0.3, 0.2, 0.4]}
    made = placed(
        {"items": [{"id": "t"}, fixed, {"id": "a", "parent": "t"}, {"id": "b", "parent": "t"}]}
    )
    np.testing.assert_allclose(made.centers[1] - made.centers[0], [0.3, 0.2, 0.4])
    corners = boxes(made)
    assert (corners[2:, 1, 1] < corners[1, 0, 1]).all()
    assert (corners[1:, :, :2].min(axis=(0, 1)) > corners[0, 0, :2]).all()
    assert (corners[1:, :, :2].max(axis=(0, 1)) < corners[0, 1, :2]).all()


def test_text_is_its_own_solid() -> None:
    made = placed({"items": [{"id": "t", "label": "x → y", "shape": {"type": "text"}}]})
    assert isinstance(made.solids[0], Text)
    assert made.labels == (None,)


def test_radii_come_from_the_document_or_the_notation() -> None:
    ends = [{"item": "a"}, {"item": "b"}]
    edges = [
        {"id": "1", "attachments": ends, "radius": 0.3},
        {"id": "2", "attachments": ends, "kind": "clock"},
    ]
    made = placed({"items": [{"id": "a"}, {"id": "b"}], "hyperedges": edges, "notation": "netlist"})
    assert made.radii.tolist() == [0.3, load_notation("netlist").hyperedges["clock"].radius]


def test_a_chain_of_sixty_four_and_thousands_of_leaves() -> None:
    chain = [{"id": "0"}, *({"id": str(n), "parent": str(n - 1)} for n in range(1, 64))]
    leaves = [{"id": f"leaf {n}"} for n in range(5000)]
    made = placed({"items": chain + leaves})
    assert np.isfinite(made.centers).all()
    assert (np.diff(made.sizes[:64, 0]) <= 1e-9).all()


def test_the_same_program_is_placed_the_same() -> None:
    document = json.loads((EXAMPLES / "id3-clause-2.json").read_text())
    assert placed(document).centers.tobytes() == placed(document).centers.tobytes()
