from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.arrays import Floats
from app.hyperedges.clearance.certificate import certify
from app.hyperedges.route import route
from app.hyperedges.routing import Routing
from app.placement.placement import Placement
from app.solids.solid import Box, Sphere
from tests.hyperedges.clearance.curves import points_at
from tests.hyperedges.clearance.furniture import furnished, label, routed

CUBE = Box((1.0, 1.0, 1.0), 0.05)
NO_ITEMS: Floats = np.zeros((0, 3))


def line(start: list[float], end: list[float]) -> Floats:
    return np.linspace(start, end, 4)


def crossing(gap: float, *, radius: float = 0.1) -> Routing:
    """Two straight tubes that cross with a gap between their surfaces."""
    over = gap + 2 * radius
    return routed(
        [[line([-2, 0, 0], [2, 0, 0])], [line([0, -2, over], [0, 2, over])]], radius=radius
    )


def bare(routing: Routing) -> Placement:
    """The placement of hyperedges without items."""
    return dataclasses.replace(
        furnished([CUBE], [[0, 0, 1e6]], attachments=[[0, 0]] * len(routing.radii)),
        radii=routing.radii,
    )


@pytest.mark.parametrize("gap", [0.051, 0.1, 0.2])
def test_tubes_farther_apart_than_the_clearance_are_certified(gap: float) -> None:
    routing = crossing(gap)
    found = certify(routing, bare(routing), 0.05)
    assert found.certified
    assert len(found.conflicts) == 0
    assert 0.99 * gap <= found.minimum <= gap
    assert found.nearest is not None
    assert (found.nearest.with_item, found.nearest.first, found.nearest.second) == (False, 0, 1)
    np.testing.assert_allclose(found.nearest.place, [0, 0, 0.1 + gap / 2], atol=1e-3)


def test_far_tubes_are_as_far_as_was_looked() -> None:
    routing = crossing(7.0)
    found = certify(routing, bare(routing), 0.05)
    assert found.certified
    assert found.nearest is None
    assert found.minimum == pytest.approx(0.05 + 0.2)


@pytest.mark.parametrize("gap", [0.049, 0.01, -0.05])
def test_tubes_nearer_than_the_clearance_are_one_conflict(gap: float) -> None:
    routing = crossing(gap)
    found = certify(routing, bare(routing), 0.05)
    assert not found.certified
    assert found.conflicts.first.tolist() == [0]
    assert found.conflicts.second.tolist() == [1]
    assert not found.conflicts.with_items[0]
    assert found.conflicts.lower[0] <= gap <= found.conflicts.upper[0] + 1e-9
    assert found.conflicts.lower[0] >= gap - 0.01 * abs(gap) - 1e-5
    assert found.minimum == found.conflicts.lower[0]
    np.testing.assert_allclose(found.conflicts.places[0], [0, 0, 0.1 + gap / 2], atol=1e-3)


def test_exactly_the_clearance_is_not_decided() -> None:
    routing = crossing(0.25, radius=0.125)
    found = certify(routing, bare(routing), 0.25)
    assert not found.certified
    assert found.conflicts.lower[0] < 0.25 <= found.conflicts.upper[0]


def test_a_pair_with_many_near_places_is_listed_once_at_the_nearest() -> None:
    weave = routed(
        [
            [line([k, 0, 0], [k + 1, 0, 0]) for k in range(6)],
            [line([k, 0.1 - 0.01 * k, 0], [k + 1, 0.09 - 0.01 * k, 0]) for k in range(6)],
        ]
    )
    found = certify(weave, bare(weave), 0.05)
    assert len(found.conflicts) == 1
    np.testing.assert_allclose(found.conflicts.places[0, 0], 6.0, atol=1e-3)


def test_hyperedges_that_share_an_attachment_touch() -> None:
    routing = routed([[line([0, 0, 0], [2, 0, 0])], [line([0, 0, 0], [0, 2, 0])]])
    found = certify(routing, bare(routing), 0.05)
    assert found.conflicts.lower[0] == pytest.approx(-0.2)


@pytest.mark.parametrize(("height", "clear"), [(0.66, True), (0.64, False), (0.3, False)])
def test_a_tube_over_an_item_is_clear_or_a_conflict(height: float, clear: bool) -> None:
    scene = furnished([CUBE] * 3, [[0, 0, 0], [-9, 0, -1], [9, 0, -1]], attachments=[[1, 2]])
    routing = routed([[line([-8.4, 0, height], [8.4, 0, height])]])
    found = certify(routing, scene, 0.05)
    assert found.certified == clear
    if not clear:
        assert found.conflicts.with_items.tolist() == [True]
        assert found.conflicts.second.tolist() == [0]
        assert found.conflicts.upper[0] < 0.05


@pytest.mark.parametrize(
    ("way", "through"),
    [
        ([[0, 0, 0.5], [0, 0, 9], [5, 0, 9], [5, 0, 0.5]], []),
        ([[0, 0, 0.5], [0, 0, -9], [5, 0, 9], [5, 0, 0.5]], [0]),
        ([[0, 0, 0.5], [1, 0, 0.5], [4, 0, 0.5], [5, 0, 0.5]], [0, 1]),
    ],
)
def test_a_tube_leaves_its_items_and_does_not_run_through_them(
    way: list[list[float]], through: list[int]
) -> None:
    scene = furnished([CUBE, CUBE], [[0, 0, 0], [5, 0, 0]], attachments=[[0, 1]])
    found = certify(routed([[np.array(way, dtype=np.float64)]]), scene, 0.05)
    assert found.certified == (not through)
    assert found.conflicts.second.tolist() == through
    assert found.conflicts.with_items.all()


def test_what_contains_an_attached_item_lets_its_tube_pass() -> None:
    outer, inner = Box((9.0, 9.0, 9.0), 0.05), Box((5.0, 5.0, 5.0), 0.05)
    scene = furnished(
        [outer, inner, CUBE, CUBE],
        [[0, 0, 0], [0, 0, 0], [0, 0, 0], [20, 0, 0]],
        attachments=[[2, 3], [3, 3]],
    )
    through = np.array([[0, 0, 0.5], [0, 0, 9], [20, 0, 9], [20, 0, 0.5]])
    beside = line([20, 0.4, 0.5], [3, 0.4, 0.5])
    routing = routed([[through], [beside]])
    contained = dataclasses.replace(scene, parents=np.array([-1, 0, 1, -1]))
    found = certify(routing, contained, 0.05).conflicts
    pairs = set(zip(found.first.tolist(), found.second.tolist(), strict=True))
    assert pairs & {(0, 0), (0, 1), (1, 0)} == {(1, 0)}
    strangers = certify(routing, scene, 0.05).conflicts
    pairs = set(zip(strangers.first.tolist(), strangers.second.tolist(), strict=True))
    assert {(0, 0), (0, 1), (1, 0)} <= pairs


def test_a_label_makes_no_conflict_that_its_item_would_not() -> None:
    beside = label("a long word", (2.0, 0.0, 0.0))
    scene = furnished(
        [CUBE, CUBE, CUBE],
        [[0, 0, 0], [2, 9, 0], [2, -9, 0]],
        labels=[beside, None, None],
        attachments=[[1, 2]],
    )
    routing = routed([[line([2, 8.3, 0], [2, -8.3, 0])]])
    assert certify(routing, scene, 0.05).certified


def test_pairs_of_hyperedges_come_before_items_and_all_are_sorted() -> None:
    scene = furnished(
        [Sphere(0.5), CUBE, CUBE],
        [[1, 0, 0], [0, 0, 40], [3, 0, 0]],
        attachments=[[1, 1]] * 3,
    )
    routing = routed([[line([0, 0.1 * k, 0], [4, 0.1 * k, 0])] for k in range(3)])
    found = certify(routing, scene, 0.05).conflicts
    assert found.first.tolist() == [0, 0, 1, 0, 0, 1, 1, 2, 2]
    assert found.second.tolist() == [1, 2, 2, 0, 2, 0, 2, 0, 2]
    assert found.with_items.tolist() == [False] * 3 + [True] * 6


def test_hyperedges_that_touch_themselves_are_listed_apart() -> None:
    loop = np.array([[0, 0, 0], [4, 3, 0], [-3, 3, 0], [1, 0, 0.0]])
    routing = routed([[loop]])
    found = certify(routing, bare(routing), 0.05)
    assert found.certified
    assert found.own.hyperedges.tolist() == [0]


def test_nothing_is_clear_of_everything() -> None:
    found = certify(routed([]), furnished([], NO_ITEMS), 0.05)
    assert found.certified
    assert found.minimum == 0.05


@pytest.mark.parametrize("number", [np.nan, np.inf])
def test_what_is_nowhere_is_not_certified(number: float) -> None:
    routing = crossing(1.0)
    routing.control_points[0, 1, 2] = number
    with pytest.raises(ValueError, match="finite"):
        certify(routing, bare(routing), 0.05)


def scene_of(seed: int) -> Placement:
    """Twelve local hyperedges among 25 blocks."""
    chance = np.random.default_rng(seed)
    centers = np.stack(np.meshgrid(np.arange(5), np.arange(5), [0]), -1).reshape(-1, 3) * 2.6
    ends = [chance.choice(25, int(chance.integers(2, 5)), replace=False) for _ in range(12)]
    scene = furnished(
        [CUBE] * 25, centers.astype(np.float64), attachments=[some.tolist() for some in ends]
    )
    spread = chance.uniform(-0.45, 0.45, (len(scene.attachment_positions), 2))
    scene.attachment_positions[:, :2] += spread
    return scene


@given(seed=st.integers(0, 2**32 - 1))
@settings(max_examples=10)
def test_conflicts_are_those_that_sampling_finds(seed: int) -> None:
    scene = scene_of(seed)
    routing = route(scene, curves="prose")
    found = certify(routing, scene, 0.05)
    t = np.linspace(0, 1, 60)
    tubes = [
        np.concatenate([points_at(curve, t) for curve in routing.control_points[begin:end]])
        for begin, end in zip(routing.segment_starts, routing.segment_starts[1:], strict=False)
    ]
    near = {}
    for a in range(12):
        for b in range(a + 1, 12):
            ways = tubes[a][:, None] - tubes[b][None]
            near[a, b] = float(np.sqrt((ways**2).sum(axis=2).min())) - 0.2
    tube_pairs = ~found.conflicts.with_items
    listed = dict(
        zip(
            zip(
                found.conflicts.first[tube_pairs].tolist(),
                found.conflicts.second[tube_pairs].tolist(),
                strict=True,
            ),
            found.conflicts.lower[tube_pairs].tolist(),
            strict=True,
        )
    )
    assert {pair for pair, gap in near.items() if gap < 0.05} <= set(listed)
    for pair, lower in listed.items():
        assert lower <= near[pair]
        # Samples are at most so far from each other.
        assert near[pair] < 0.05 + 0.4
    assert found.minimum <= min(near.values())


def test_the_same_routing_has_the_same_certificate() -> None:
    scene = scene_of(5)
    first, second = (certify(route(scene, curves="prose"), scene, 0.05) for _ in range(2))
    assert first.conflicts.lower.tobytes() == second.conflicts.lower.tobytes()
    assert first.nearest == second.nearest
