from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from app.errors import DocumentTooLarge, InconsistentDocument
from app.hyperedges.clearance.obstacles import obstacles_of
from app.placement.trees import tree_of
from app.placement.turning import turned
from app.program.csg import CsgNode
from app.program.model import Program
from app.program.shapes import Csg
from app.solids.csg_tree import Leaf, leaves_of
from app.solids.meshing import mesh_of
from tests.placement.test_place import EXAMPLES, attach, placed

BALL = {"type": "sphere", "radius": 1}


def shape(tree: dict[str, Any]) -> dict[str, Any]:
    return {"type": "csg", "tree": tree}


def node(tree: dict[str, Any]) -> CsgNode:
    return Csg.model_validate(shape(tree)).tree


def box(*size: float, **more: Any) -> dict[str, Any]:
    return {"type": "box", "size": list(size), **more}


def union(*of: dict[str, Any], **more: Any) -> dict[str, Any]:
    return {"type": "union", "of": list(of), **more}


vectors = st.lists(st.floats(-5, 5), min_size=3, max_size=3)
degrees = st.lists(st.floats(-400, 400), min_size=3, max_size=3)


@given(st.lists(st.tuples(vectors, degrees), min_size=1, max_size=4), vectors)
def test_frames_within_frames_are_put_one_after_another(
    frames: list[tuple[list[float], list[float]]], inside: list[float]
) -> None:
    tree: dict[str, Any] = {**BALL}
    expected = np.array(inside)
    for place, angles in frames:
        tree = union(tree) if "position" in tree else tree
        tree |= {"position": place, "rotation": angles}
        expected = Rotation.from_euler("xyz", angles, degrees=True).apply(expected) + place
    (leaf,) = leaves_of(tree_of(node(tree)))
    x, y, z = inside
    found = np.array(turned(leaf.rotation, (x, y, z))) + leaf.position
    np.testing.assert_allclose(found, expected, atol=1e-9)


def magnitudes(most: int) -> st.SearchStrategy[float]:
    """Numbers of both signs and of any magnitude below 10 to the power ``most``; zero, too."""
    powers = st.integers(-324, most - 1).map(lambda power: float(f"1e{power}"))
    return st.builds(lambda digits, power: digits * power, st.floats(-10, 10), powers)


along_an_axis = st.builds(
    lambda long, asides, axis: (*asides[:axis], long, *asides[axis:]),
    st.sampled_from((-1e6, -683927.0, -1.0, -1e-3, 1.0, 1e6)),
    st.tuples(*[magnitudes(-3)] * 2),
    st.integers(0, 2),
)
"""Normals that are nearly those of an axis, or the opposite of it."""


@example((2e-311, 2e-311, -683927.0), 1.0)
@example((5e-324, -5e-324, 5e-324), 1.0)
@given(
    st.tuples(*[magnitudes(6)] * 3).filter(any) | along_an_axis,
    st.floats(1e-3, 1e6) | st.floats(-1e6, -1e-3),
)
def test_a_half_space_faces_along_its_normal_and_ends_at_its_offset(
    normal: tuple[float, float, float], offset: float
) -> None:
    half = {"type": "half_space", "normal": normal, "offset": offset}
    leaf = tree_of(node(half))
    assert isinstance(leaf, Leaf)
    unit = np.array(normal) / np.abs(normal).max()
    unit /= np.linalg.norm(unit)
    np.testing.assert_allclose(turned(leaf.rotation, (0.0, 0.0, 1.0)), unit, atol=1e-12)
    for on_plane in ((0.0, 0.0, offset), (offset, 0.0, offset), (0.0, -offset, offset)):
        assert np.dot(turned(leaf.rotation, on_plane), unit) == pytest.approx(offset, rel=1e-12)


def test_a_leaf_keeps_its_sizes() -> None:
    cone = node({"type": "cone", "radius": 1, "height": 2})
    assert tree_of(cone) == Leaf("cone", (1.0, 2.0, 0.0))


def test_the_trees_origin_is_where_the_position_is() -> None:
    off = union(box(1, 1, 1), box(1, 1, 1, position=[2, 0, 0]))
    made = placed({"items": [{"id": "a", "shape": shape(off), "position": [10, 0, 0],
                              "rotation": [0, 0, 90]}]})  # fmt: skip
    np.testing.assert_allclose(made.centers, [[10, 1, 0]], atol=1e-9)
    assert made.sizes.tolist() == [[3, 1, 1]]


def test_attachment_points_are_where_the_tree_has_them() -> None:
    off = union(box(1, 1, 1), box(1, 1, 1, position=[2, 0, 0]))
    point = {"id": "p", "position": [2.5, 0, 0], "direction": [1, 0, 0]}
    items = [
        {"id": "a", "shape": shape(off), "position": [10, 0, 0], "attachment_points": [point]},
        {"id": "b"},
    ]
    ends = [{"item": "a", "point": "p"}, {"item": "a"}, {"item": "b"}]
    made = placed({"items": items, "hyperedges": [{"id": "e", "attachments": ends}]})
    np.testing.assert_allclose(
        made.attachment_positions[:2], [[12.5, 0, 0], [10, 0, 0.5]], atol=1e-6
    )


def test_a_free_body_stands_on_the_ground_beside_its_siblings() -> None:
    high = box(1, 1, 1, position=[7, 8, 9])
    made = placed({"items": [{"id": "a", "shape": shape(high)}, {"id": "b"}]})
    assert made.centers[0, 2] == pytest.approx(0.5)
    apart = np.abs(made.centers[0] - made.centers[1])[:2] - (made.sizes.sum(axis=0) / 2)[:2]
    assert apart.max() > 0.1


def test_children_stand_on_a_body_and_their_positions_are_from_its_origin() -> None:
    table = box(4, 4, 1, position=[0, 0, 5])
    items = [
        {"id": "t", "shape": shape(table), "position": [0, 0, 0]},
        {"id": "free", "parent": "t"},
        {"id": "told", "parent": "t", "position": [1, 1, 6]},
    ]
    made = placed({"items": items})
    assert made.centers[1, 2] - made.sizes[1, 2] / 2 == pytest.approx(5.5)
    np.testing.assert_allclose(made.centers[2], [1, 1, 6], atol=1e-9)


def test_a_ring_is_attached_to_on_its_rim() -> None:
    ring = {"type": "difference", "of": [box(3, 3, 1), box(1, 1, 1)]}
    made = placed({"items": [{"id": "a", "shape": shape(ring), "position": [0, 0, 0]}, {"id": "b"}],
                   **attach("a", "b")})  # fmt: skip
    np.testing.assert_allclose(made.attachment_positions[0], [0, 1, 0.5], atol=1e-6)


def test_a_body_is_inside_its_obstacle() -> None:
    document = json.loads((EXAMPLES / "csg.json").read_text())
    made = placed(document)
    obstacles = obstacles_of(made)
    for number, solid in enumerate(made.solids):
        first = int(np.flatnonzero(obstacles.items == number)[0])
        reach = np.abs(mesh_of(solid).vertices).max(axis=0)
        assert (reach <= obstacles.halves[first] * (1 + 1e-6)).all()


def test_bodies_that_cannot_be_are_named_by_their_items() -> None:
    nothing = {"type": "difference", "of": [box(1, 1, 1), box(2, 2, 2)]}
    half = {"type": "half_space", "normal": [1, 1, 1]}
    endless = {"type": "intersection", "of": [half, half]}
    trees: list[dict[str, Any]] = [BALL, nothing, endless]
    items = [{"id": str(n), "shape": shape(tree)} for n, tree in enumerate(trees)]
    with pytest.raises(InconsistentDocument) as raised:
        placed({"items": items})
    places = [(fault.pointer, fault.detail.split()[0]) for fault in raised.value.faults]
    assert places == [
        ("/items/1/shape/tree", "Nothing"),
        ("/items/2/shape/tree", "Half-spaces"),
    ]


def test_a_body_that_is_too_much_is_named_by_its_item() -> None:
    slabs = [
        union(*(
            box(*[0.2 if other == axis else 200.0 for other in range(3)],
                position=[k * (other == axis) for other in range(3)])
            for k in range(60)
        ))
        for axis in range(3)
    ]  # fmt: skip
    lattice = {"type": "intersection", "of": slabs}
    with pytest.raises(DocumentTooLarge) as raised:
        placed({"items": [{"id": "a"}, {"id": "b", "shape": shape(lattice)}]})
    assert raised.value.faults[0].pointer == "/items/1/shape/tree"


def test_equal_trees_share_one_body() -> None:
    program = Program.model_validate_json((Path(EXAMPLES) / "csg.json").read_bytes())
    tree = program.items[0].shape
    assert isinstance(tree, Csg)
    first, second = tree_of(tree.tree), tree_of(tree.tree.model_copy())
    assert first == second
    assert hash(first) == hash(second)
