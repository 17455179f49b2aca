from __future__ import annotations

import json
import subprocess
import sys
from dataclasses import replace
from functools import lru_cache
from typing import Any, Literal

import numpy as np
import pytest

from app.arrays import Floats
from app.hyperedges.clearance.certificate import certify
from app.hyperedges.pinches import find_pinches
from app.hyperedges.route import route
from app.hyperedges.routing import Routing
from app.layout import lay_out
from app.placement.placement import Placement
from app.program.reading import read_program
from app.settings import Settings
from benchmarks.random_in_space import random_in_space
from benchmarks.random_programs import CLEARANCE, random_program
from tests.hyperedges.scenes import placement as placement_of
from tests.hyperedges.scenes import troubles

Kind = Literal["ground", "space"]
CASES: list[tuple[Kind, int, int]] = [
    *(("ground", 10, seed) for seed in range(6)),
    *(("ground", 30, seed) for seed in range(3)),
    *(("space", 10, seed) for seed in range(6)),
    ("space", 10, 16),  # an attachment leads below the ground that all items stand above
    ("space", 10, 29),  # a tube turns closely around an edge of its own item
    *(("space", 30, seed) for seed in range(3)),
    ("space", 30, 16),  # an attachment leads downwards just above the ground
    ("space", 100, 0),
    ("space", 100, 18),  # a tube passes its own item beside where another end attaches to it
    ("space", 100, 33),  # a tube has to make a U-turn between two others
]


@lru_cache(maxsize=len(CASES))
def placed(kind: Kind, hyperedges: int, seed: int) -> Placement:
    make = random_program if kind == "ground" else random_in_space
    return make(hyperedges, seed).placement()


@lru_cache(maxsize=len(CASES))
def routed(kind: Kind, hyperedges: int, seed: int) -> Routing:
    return elastic(placed(kind, hyperedges, seed))


def elastic(placement: Placement, heights: Floats | None = None) -> Routing:
    return route(placement, routing="elastic", clearance=CLEARANCE, join_heights=heights)


def places(routing: Routing) -> Floats:
    """Places along all segments, (33, s, 3)."""
    share = np.linspace(0.0, 1.0, 33)[:, None, None]
    p = routing.control_points.transpose(1, 0, 2)
    rest = 1.0 - share
    at = rest**3 * p[0] + 3 * rest**2 * share * p[1] + 3 * rest * share**2 * p[2] + share**3 * p[3]
    return np.asarray(at)


def length(routing: Routing) -> float:
    return float(np.linalg.norm(np.diff(places(routing), axis=0), axis=2).sum())


@pytest.mark.parametrize(("kind", "hyperedges", "seed"), CASES)
def test_random_programs_come_out_clear_without_pinches_and_own_contacts(
    kind: Kind, hyperedges: int, seed: int
) -> None:
    routing = routed(kind, hyperedges, seed)
    proof = certify(routing, placed(kind, hyperedges, seed), CLEARANCE)
    assert proof.certified
    assert len(proof.own.hyperedges) == 0
    assert len(find_pinches(routing).segments) == 0


@pytest.mark.parametrize("kind", ["ground", "space"])
def test_every_attachment_has_one_tube_that_leaves_along_its_direction(kind: Kind) -> None:
    routing, placement = routed(kind, 30, 0), placed(kind, 30, 0)
    owners = np.repeat(np.arange(len(routing.radii)), np.diff(routing.segment_starts))
    counts = routing.attachment_counts
    found = []
    for segment, (ends, owner) in enumerate(zip(routing.segment_ends, owners, strict=True)):
        for side, end in enumerate(ends):
            if end < counts[owner]:
                row = placement.attachment_starts[owner] + end
                p = routing.control_points[segment][:: 1 if side == 0 else -1]
                np.testing.assert_array_equal(p[0], placement.attachment_positions[row])
                way = (p[1] - p[0]) / np.linalg.norm(p[1] - p[0])
                np.testing.assert_allclose(way, placement.attachment_directions[row], atol=1e-9)
                found.append(row)
    assert sorted(found) == list(range(len(placement.attachment_items)))


@pytest.mark.parametrize("kind", ["ground", "space"])
def test_segments_meet_at_joins_with_one_tangent(kind: Kind) -> None:
    routing = routed(kind, 30, 1)
    counts = routing.attachment_counts
    for k in range(len(routing.radii)):
        joins = slice(routing.join_starts[k], routing.join_starts[k + 1])
        positions, tangents = routing.join_positions[joins], routing.join_tangents[joins]
        np.testing.assert_allclose(np.linalg.norm(tangents, axis=1), 1.0)
        meeting = np.zeros(len(positions), dtype=np.int64)
        for s in range(routing.segment_starts[k], routing.segment_starts[k + 1]):
            for side, end in enumerate(routing.segment_ends[s] - counts[k]):
                if end < 0:
                    continue
                p = routing.control_points[s][:: 1 if side == 0 else -1]
                np.testing.assert_array_equal(p[0], positions[end])
                way = (p[1] - p[0]) / np.linalg.norm(p[1] - p[0])
                assert abs(way @ tangents[end]) == pytest.approx(1.0)
                meeting[end] += 1
        inner = counts[k] - 2
        assert meeting.tolist() == [3] * inner + [2] * (len(positions) - inner)


def test_facing_attachments_get_a_straight_tube() -> None:
    facing = placement_of(np.array([[0.0, 0, 5], [3, 0, 5]]), [0, 2])
    directions = np.array([[1.0, 0, 0], [-1, 0, 0]])
    routing = elastic(replace(facing, attachment_directions=directions))
    assert length(routing) == pytest.approx(3.0, abs=1e-6)
    np.testing.assert_allclose(
        routing.control_points[:, :, 1:],
        [[[0.0, 5.0]] * 4] * len(routing.control_points),
        atol=1e-6,
    )


def test_arches_hang_over_the_ground_and_over_what_stands_between() -> None:
    routing, placement = routed("ground", 30, 0), placed("ground", 30, 0)
    owners = np.repeat(np.arange(len(routing.radii)), np.diff(routing.segment_starts))
    lowest = routing.control_points[:, :, 2].min(axis=1)
    assert (lowest >= np.minimum(routing.radii[owners], placement.sizes[:, 2].min())).all()
    tops = np.maximum.reduceat(
        routing.control_points[:, :, 2].max(axis=1), routing.segment_starts[:-1]
    )
    attached = np.maximum.reduceat(
        placement.attachment_positions[:, 2], placement.attachment_starts[:-1]
    )
    assert (tops > attached + 4 * routing.radii).all()


def test_joins_are_held_at_heights_that_are_given() -> None:
    placement = placed("ground", 10, 0)
    heights = np.full(len(placement.radii), np.nan)
    heights[::2] = 3.5
    routing = elastic(placement, heights)
    for k in range(0, len(heights), 2):
        first = routing.join_starts[k]
        joins = routing.join_positions[first : first + routing.attachment_counts[k] - 2]
        np.testing.assert_array_equal(joins[:, 2], 3.5)
        assert routing.join_planes[k] == 3.5


@pytest.mark.parametrize("shape", ["box", "sphere"])
def test_an_own_item_is_passed_at_a_distance(shape: str) -> None:
    # From the far side of an item around it to another one.
    body: dict[str, Any] = {"type": shape}
    body |= {"size": [2.0] * 3} if shape == "box" else {"radius": 1.0}
    point = {"id": "p", "position": [-1.0, 0.0, 0.0], "direction": [-1.0, 0.0, 0.0]}
    items = [
        {
            "id": name,
            "shape": body,
            "position": [x, 0.0, 5.0],
            "attachment_points": [point],
        }
        for name, x in (("a", 0.0), ("b", 7.0))
    ]
    ends = [{"item": "a", "point": "p"}, {"item": "b", "point": "p"}]
    document = {
        "items": items,
        "hyperedges": [{"id": "e", "attachments": ends, "radius": 0.08}],
        "layout": {"routing": "elastic"},
    }
    layout = lay_out(read_program(json.dumps(document).encode(), Settings()))
    at = places(layout.routing).reshape(-1, 3)
    beyond = at - layout.placement.centers[0]
    if shape == "box":
        beyond = np.maximum(np.abs(beyond) - 1.0, 0.0)
    outside = np.linalg.norm(beyond, axis=1) - (0.0 if shape == "box" else 1.0)
    far = np.linalg.norm(at - [-1.0, 0.0, 5.0], axis=1) > 3 * (0.08 + CLEARANCE)
    assert outside[far].min() >= 0.08 + CLEARANCE
    assert len(find_pinches(layout.routing).segments) == 0


def test_parallel_hyperedges_do_not_braid() -> None:
    count = 5
    offsets = np.arange(count) * 0.5
    ends = np.stack(
        [
            np.stack([0 * offsets, offsets, 0 * offsets], 1),
            np.stack([0 * offsets + 6, offsets, 0 * offsets], 1),
        ],
        axis=1,
    ).reshape(-1, 3)
    routing = elastic(placement_of(ends, list(range(0, 2 * count + 1, 2))))
    owners = np.repeat(np.arange(count), np.diff(routing.segment_starts))
    for k in range(count - 1):
        assert routing.control_points[owners == k, :, 1].max() < (
            routing.control_points[owners == k + 1, :, 1].min()
        )


SCRIPT = """
import hashlib
from app.hyperedges.route import route
from benchmarks.random_in_space import random_in_space
from benchmarks.random_programs import random_program
for make in (random_program, random_in_space):
    routing = route(make(10, 1).placement(), routing="elastic", clearance=0.05)
    print(hashlib.sha256(routing.control_points.tobytes()).hexdigest())
"""


def test_two_processes_make_the_same_bits() -> None:
    one, other = (
        subprocess.run([sys.executable, "-c", SCRIPT], check=True, capture_output=True, text=True)
        for _ in range(2)
    )
    assert one.stdout == other.stdout
    assert len(one.stdout.split()) == 2


def test_progress_can_end_the_work() -> None:
    class Ended(Exception):
        pass

    shares: list[float] = []

    def progress(share: float) -> None:
        shares.append(share)
        if share > 0.5:
            raise Ended

    with pytest.raises(Ended):
        route(placed("ground", 10, 1), routing="elastic", clearance=CLEARANCE, progress=progress)
    assert shares == sorted(shares)


@pytest.mark.parametrize(
    "name", sorted(set(troubles(6)) - {"huge", "all scales", "two far clusters"})
)
@pytest.mark.parametrize("side", ["up", "down", "all"])
def test_whatever_is_to_be_joined_curves_are_finite_and_end_there(name: str, side: str) -> None:
    points = troubles(6)[name]
    scene = placement_of(points, [0, 2, 6])
    if side != "up":
        chance = np.random.default_rng(1)
        directions = -scene.attachment_directions
        if side == "all":
            directions = chance.normal(size=(6, 3))
            directions /= np.linalg.norm(directions, axis=1)[:, None]
        scene = replace(scene, attachment_directions=directions)
    routing = elastic(scene)
    for numbers in (routing.control_points, routing.join_tangents, routing.join_planes):
        assert np.isfinite(numbers).all()
    np.testing.assert_allclose(np.linalg.norm(routing.join_tangents, axis=1), 1.0)
    counts = np.repeat(routing.attachment_counts, np.diff(routing.segment_starts))
    at_start = np.flatnonzero(routing.segment_ends[:, 0] < counts)
    firsts = scene.attachment_starts[np.repeat([0, 1], np.diff(routing.segment_starts))]
    rows = firsts[at_start] + routing.segment_ends[at_start, 0]
    np.testing.assert_array_equal(routing.control_points[at_start, 0], points[rows])


def test_a_program_without_hyperedges_has_no_curves() -> None:
    empty = placement_of(np.zeros((0, 3)), [0])
    assert len(elastic(empty).control_points) == 0
