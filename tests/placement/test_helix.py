from __future__ import annotations

import json
from itertools import combinations
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.errors import InconsistentDocument
from app.formats.registry import read
from app.placement.helix import Bulk, wind
from app.placement.turning import matrices
from app.program.model import Helix
from app.settings import Settings
from tests.placement.test_place import placed

EXAMPLE = Path(__file__).parents[2] / "examples" / "helix.json"


def helix(count: int, **more: Any) -> Helix:
    items = tuple(str(number) for number in range(count))
    return Helix.model_validate({"type": "helix", "items": items, **more})


def on_helix(count: int, item: dict[str, Any] | None = None, **more: Any) -> dict[str, Any]:
    items = [{"id": str(number), **(item or {})} for number in range(count)]
    constraint = {"type": "helix", "items": [str(number) for number in range(count)], **more}
    return {"items": items, "layout": {"constraints": [constraint]}}


bulks = st.lists(st.builds(Bulk, st.floats(0.1, 3.0), st.floats(0.1, 3.0)), min_size=2, max_size=30)


@given(
    bulks,
    st.floats(0.0, 1.0),
    st.fixed_dictionaries(
        {},
        optional={"items_per_turn": st.floats(0.1, 40.0), "radius": st.floats(0.001, 20.0)},
    ),
)
def test_nothing_overlaps_where_the_pitch_is_left_out(
    things: list[Bulk], gap: float, said: dict[str, float]
) -> None:
    wound = wind(helix(len(things), **said), things, gap)
    for one, other in combinations(range(len(things)), 2):
        (a, b, c), (x, y, z) = wound.centers[one], wound.centers[other]
        aside = np.hypot(a - x, b - y) - things[one].radius - things[other].radius
        above = abs(c - z) - (things[one].height + things[other].height) / 2
        assert max(aside, above) > gap - 1e-6


@given(bulks, st.floats(0.0, 1.0), st.floats(0.5, 20.0))
def test_nothing_overlaps_where_only_the_pitch_is_given(
    things: list[Bulk], gap: float, pitch: float
) -> None:
    wound = wind(helix(len(things), pitch=pitch), things, gap)
    for one, other in combinations(range(len(things)), 2):
        (a, b, c), (x, y, z) = wound.centers[one], wound.centers[other]
        aside = np.hypot(a - x, b - y) - things[one].radius - things[other].radius
        above = abs(c - z) - (things[one].height + things[other].height) / 2
        assert max(aside, above) > gap - 1e-6


def test_numbers_that_are_given_are_obeyed() -> None:
    made = placed(on_helix(9, radius=5, pitch=4, items_per_turn=4))
    about = made.centers - made.centers[[0, 2, 4, 6]].mean(axis=0)
    np.testing.assert_allclose(np.hypot(about[:, 0], about[:, 1]), 5.0)
    np.testing.assert_allclose(np.diff(made.centers[:, 2]), 1.0)
    np.testing.assert_allclose(made.centers[0, :2], made.centers[4, :2], atol=1e-12)


def test_the_first_stands_in_front_and_the_next_to_its_right() -> None:
    made = placed(on_helix(4, items_per_turn=4, radius=3))
    center = made.centers[:, :2].mean(axis=0)
    ways = [[0, -3], [3, 0], [0, 3], [-3, 0]]
    np.testing.assert_allclose(made.centers[:, :2] - center, ways, atol=1e-12)
    back = placed(on_helix(4, items_per_turn=4, radius=3, clockwise=True, start=90))
    center = back.centers[:, :2].mean(axis=0)
    ways = [[3, 0], [0, -3], [-3, 0], [0, 3]]
    np.testing.assert_allclose(back.centers[:, :2] - center, ways, atol=1e-12)


def test_fronts_face_outward_and_tops_lean_as_far_as_asked() -> None:
    made = placed(on_helix(7, tilt=20))
    middle = (made.centers[:, :2].min(axis=0) + made.centers[:, :2].max(axis=0)) / 2
    turns = matrices(made.rotations)
    fronts, tops = -turns[:, :, 1], turns[:, :, 2]
    outward = made.centers[:, :2] - made.centers[:7, :2].mean(axis=0)
    assert middle.shape == (2,)
    outward /= np.linalg.norm(outward, axis=1, keepdims=True)
    np.testing.assert_allclose(tops[:, 2], np.cos(np.radians(20)))
    np.testing.assert_allclose(np.einsum("ni,ni->n", tops[:, :2], outward), np.sin(np.radians(20)))
    np.testing.assert_allclose(
        np.einsum("ni,ni->n", fronts[:, :2], outward), np.cos(np.radians(20))
    )


def test_items_keep_their_own_turns() -> None:
    made = placed(on_helix(5, {"rotation": [0, 0, 30]}, rotate=False))
    assert len({tuple(turn) for turn in made.rotations.tolist()}) == 1
    turned = placed(on_helix(5, {"rotation": [90, 0, 0]}))
    np.testing.assert_allclose(matrices(turned.rotations)[:, 2, 1], 1.0)


def test_attachments_turn_with_their_items() -> None:
    point = {"id": "p", "position": [0, -0.3, 0], "direction": [0, -1, 0]}
    document = on_helix(6, {"attachment_points": [point]})
    ends = [{"item": str(number), "point": "p"} for number in range(6)]
    made = placed({**document, "hyperedges": [{"id": "e", "attachments": ends}]})
    outward = made.attachment_positions - made.centers
    np.testing.assert_allclose(outward, 0.3 * made.attachment_directions, atol=1e-12)
    np.testing.assert_allclose(made.attachment_directions.sum(axis=0), 0.0, atol=1e-12)


def test_a_helix_stands_on_its_parent_beside_its_siblings() -> None:
    document = on_helix(6, {"parent": "tray"})
    document["items"] += [{"id": "tray"}, {"id": "free", "parent": "tray"}]
    made = placed(document)
    lowest = made.centers[0, 2] - made.sizes[0, 2] / 2
    assert lowest == pytest.approx(made.centers[7, 2] - made.sizes[7, 2] / 2)
    low, high = made.centers[6] - made.sizes[6] / 2, made.centers[6] + made.sizes[6] / 2
    reach = np.hypot(made.sizes[:6, 0], made.sizes[:6, 1]).max() / 2
    assert (made.centers[:6, :2] - reach > low[:2]).all()
    assert (made.centers[:6, :2] + reach < high[:2]).all()
    apart = np.linalg.norm(made.centers[:6, :2] - made.centers[7, :2], axis=1)
    assert (apart > reach).all()


def test_members_must_be_siblings_without_positions() -> None:
    document = on_helix(3)
    document["items"][1]["position"] = [0, 0, 0]
    document["items"][2]["parent"] = "0"
    document["layout"]["constraints"][0]["items"].append("3")
    with pytest.raises(InconsistentDocument) as raised:
        read("tubeloom", json.dumps(document).encode(), Settings())
    places = [fault.pointer for fault in raised.value.faults]
    assert places == [
        "/layout/constraints/0/items",
        "/layout/constraints/0/items/1",
        "/layout/constraints/0/items/3",
    ]


def test_the_example_is_complexly_oriented() -> None:
    made = placed(json.loads(EXAMPLE.read_text()))
    tops = matrices(made.rotations)[:, :, 2]
    alike = np.abs(tops @ tops.T) > 0.999
    assert (alike.sum(axis=1) == 1).all()
