"""Kernels against the same in NumPy, bead by bead and pair by pair."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import pytest

from app.arrays import Floats, Indices
from app.hyperedges.elastic.bending import join_tangent, keep_long, straighten, unbend
from app.hyperedges.elastic.capsules import LEAST_SHARE, nearest, separate, within
from app.hyperedges.elastic.polylines import resample
from app.hyperedges.elastic.relaxation import FARTHEST, OVER, move, spread
from app.hyperedges.elastic.rounded_boxes import Boxes, repel

ARM = 4


class Star(NamedTuple):
    """A join of three chains of `ARM` beads each, of which the outermost are attachments."""

    x: Floats
    links: Indices
    degrees: Indices
    stems: Indices
    thickness: Floats
    free: Floats


def star(seed: int) -> Star:
    chance = np.random.default_rng(seed)
    count = 1 + 3 * ARM
    links = np.full((count, 3), -1)
    for arm in range(3):
        first = 1 + arm * ARM
        links[0, arm] = first
        for k in range(ARM):
            links[first + k, 0] = first + k - 1 if k else 0
            links[first + k, 1] = first + k + 1 if k < ARM - 1 else -1
    degrees = (links >= 0).sum(axis=1)
    free = chance.integers(0, 2, count).astype(np.float64)
    return Star(
        chance.normal(size=(count, 3)),
        links,
        degrees,
        np.array([seed % 3]),
        chance.uniform(0.1, 0.2, count),
        free,
    )


def unit(vector: Floats) -> Floats:
    return np.asarray(vector / np.linalg.norm(vector))


def tangent_of(s: Star) -> Floats:
    arms = [unit(s.x[j] - s.x[0]) for j in s.links[0]]
    stem = s.stems[0]
    others = [arm for k, arm in enumerate(arms) if k != stem]
    return unit(arms[stem] - 0.5 * (others[0] + others[1]))


@pytest.mark.parametrize("seed", range(6))
def test_the_tangent_of_a_join_is_its_stem_against_its_arms(seed: int) -> None:
    s = star(seed)
    found = np.empty(3)
    join_tangent(s.x, s.links, int(s.stems[0]), 0, found)
    np.testing.assert_allclose(found, tangent_of(s), atol=1e-12)


@pytest.mark.parametrize("seed", range(6))
def test_straightening_is_the_laplacian_and_the_biharmonic_operator(seed: int) -> None:
    s = star(seed)
    x, count = s.x.copy(), len(s.x)
    lifts = np.linspace(0.0, 0.1, 3 * count).reshape(count, 3)
    moving = np.flatnonzero(s.degrees >= 2)
    laps, beside = np.zeros_like(x), np.zeros(count)
    straighten(
        x,
        s.links,
        s.degrees,
        s.stems,
        s.thickness,
        lifts,
        moving,
        np.arange(count),
        0.3,
        0.2,
        laps,
        np.zeros((1, 3)),
        beside,
        np.empty_like(x),
    )
    old = s.x
    expected = old.copy()

    def lap(i: int) -> Floats:
        if s.degrees[i] < 2:
            return np.zeros(3)
        return np.asarray(old[s.links[i][s.links[i] >= 0]].mean(axis=0) - old[i])

    for i in moving.tolist():
        step = 0.3 * lap(i)
        step += 0.3 * lifts[i]
        if i > 0:
            beyond = []
            for j in s.links[i, :2]:
                if j > 0:
                    beyond.append(lap(j))
                    continue
                sign = 1.0 if s.links[0, s.stems[0]] == i else -1.0
                image = old[0] - sign * np.linalg.norm(old[i] - old[0]) * tangent_of(s)
                beyond.append(0.5 * (old[i] + image) - old[0])
            step += 0.2 * (lap(i) - 0.5 * (beyond[0] + beyond[1]))
        expected[i] += step
    np.testing.assert_allclose(x, expected, atol=1e-12)
    for i in moving[1:].tolist():
        assert beside[i] == pytest.approx(min(np.linalg.norm(lap(i)) / 3.0, 1.5 * s.thickness[i]))


@pytest.mark.parametrize("seed", range(6))
def test_tight_bends_are_opened_and_short_steps_made_longer(seed: int) -> None:
    s = star(seed)
    count = len(s.x)
    around, bends, spans = np.arange(count), np.full(count, 0.8), np.full(count, 1.5)
    sums, weights = np.zeros_like(s.x), np.zeros(count)
    unbend(s.x, s.links, s.degrees, bends, s.free, around, sums, weights)
    expected, shares = np.zeros_like(s.x), np.zeros(count)
    inner = np.flatnonzero(s.degrees == 2)
    for i in inner:
        p, q = s.links[i, :2]
        second = s.x[p] + s.x[q] - 2 * s.x[i]
        allowed = np.sum((0.5 * (s.x[q] - s.x[p])) ** 2) / 0.8
        total = 4 * s.free[i] + s.free[p] + s.free[q]
        size = np.linalg.norm(second)
        if size <= allowed or total == 0:
            continue
        way = second * (size - allowed) / (size * total)
        for bead, weight, share in ((i, 2.0, 1.0), (p, -1.0, 0.5), (q, -1.0, 0.5)):
            expected[bead] += weight * s.free[bead] * way
            shares[bead] += share * s.free[bead]
    np.testing.assert_allclose(sums, expected, atol=1e-12)
    np.testing.assert_allclose(weights, shares, atol=1e-12)
    sums[:], weights[:], expected[:] = 0.0, 0.0, 0.0
    keep_long(s.x, s.links, s.degrees, spans, s.free, around, sums, weights)
    for i in inner:
        for j in s.links[i, :2]:
            way, total = s.x[i] - s.x[j], s.free[i] + s.free[j]
            lack = 1.5 - np.linalg.norm(way)
            if lack > 0 and total > 0:
                push = 0.5 * lack * unit(way) / total
                expected[i] += s.free[i] * push
                expected[j] -= s.free[j] * push
    np.testing.assert_allclose(sums, expected, atol=1e-12)


def lines(seed: int, count: int = 40) -> tuple[Floats, Indices, Indices]:
    chance = np.random.default_rng(seed)
    x = chance.uniform(0.0, 2.0, (2 * count, 3))
    segments = np.arange(2 * count).reshape(-1, 2)
    pairs = np.stack(np.triu_indices(count, 1), axis=1)
    return x, segments, pairs


def sampled(x: Floats, a: Indices, b: Indices) -> float:
    """The smallest distance of two lines, over a fine grid of places on both."""
    share = np.linspace(0.0, 1.0, 201)[:, None]
    one = x[a[0]] + share * (x[a[1]] - x[a[0]])
    other = x[b[0]] + share * (x[b[1]] - x[b[0]])
    return float(np.linalg.norm(one[:, None] - other[None], axis=2).min())


def test_nearest_places_are_as_near_as_any_that_are_sampled() -> None:
    x, segments, pairs = lines(0, 12)
    for k, q in pairs:
        a, b, c, d = (int(bead) for bead in (*segments[k], *segments[q]))
        s, t = nearest(x, a, b, c, d)
        way = x[a] + s * (x[b] - x[a]) - x[c] - t * (x[d] - x[c])
        there = sampled(x, segments[k], segments[q])
        assert np.linalg.norm(way) <= there + 1e-12
        assert np.linalg.norm(way) == pytest.approx(there, abs=0.02)


def test_capsules_push_each_other_apart_by_what_they_lack() -> None:
    x, segments, pairs = lines(1)
    chance = np.random.default_rng(2)
    rooms, beside = chance.uniform(0.1, 0.3, len(segments)), chance.uniform(0.0, 0.1, len(x))
    free = chance.integers(0, 2, len(x)).astype(np.float64)
    sums, weights = np.zeros_like(x), np.zeros(len(x))
    separate(x, segments, pairs, rooms, beside, free, 0.9, sums, weights)
    expected = np.zeros_like(x)
    close = []
    for k, q in pairs:
        (a, b), (c, d) = segments[k], segments[q]
        s, t = nearest(x, int(a), int(b), int(c), int(d))
        way = x[a] + s * (x[b] - x[a]) - x[c] - t * (x[d] - x[c])
        need = 0.9 * (rooms[k] + rooms[q]) + beside[[a, b]].max() + beside[[c, d]].max()
        close.append(np.linalg.norm(way) < rooms[k] + rooms[q])
        shares = {a: 1 - s, b: s, c: t - 1, d: -t}
        total = sum(share**2 * free[bead] for bead, share in shares.items())
        if np.linalg.norm(way) >= need or total == 0:
            continue
        push = (need - np.linalg.norm(way)) * unit(way) / max(total, LEAST_SHARE)
        for bead, share in shares.items():
            expected[bead] += free[bead] * share * push
    assert np.abs(expected).max() > 0
    np.testing.assert_allclose(sums, expected, atol=1e-9)
    assert within(x, segments, pairs, rooms).tolist() == close


def one_box(half: Floats, rounding: float, is_label: bool = False) -> Boxes:
    return Boxes(
        np.array([[1.0, 2.0, 3.0]]),
        np.eye(3)[None],
        half[None],
        np.array([rounding]),
        np.array([is_label]),
        np.array([[0.0, 0.0, 1.0 if is_label else 0.0]]),
    )


@pytest.mark.parametrize(
    ("begin", "end", "way"),
    [
        ([0.0, 2.0, 3.6], [2.0, 2.0, 3.6], [0.0, 0.0, 1.0]),
        ([0.0, 2.1, 3.0], [2.0, 2.1, 3.0], [0.0, 1.0, 0.0]),
        ([1.0, 1.0, 2.8], [1.0, 3.0, 2.8], [0.0, 0.0, -1.0]),
        ([1.7, 2.0, 2.0], [1.7, 2.0, 4.0], [1.0, 0.0, 0.0]),
    ],
)
def test_boxes_push_lines_out_across_them(
    begin: list[float], end: list[float], way: list[float]
) -> None:
    x = np.array([begin, end])
    half = np.array([0.5, 0.4, 0.5])
    sums, weights = np.zeros((2, 3)), np.zeros(2)
    repel(
        x,
        np.array([[0, 1]]),
        np.array([[0, 0]]),
        np.zeros((1, 4)),
        one_box(half, 0.1),
        np.array([0.2]),
        0.025,
        np.zeros(2),
        np.ones(2),
        1.0,
        sums,
        weights,
    )
    pushed = unit(sums.sum(axis=0))
    np.testing.assert_allclose(pushed, way, atol=1e-9)
    # The middle of the line has gone as far as is needed, by shares of its ends.
    middle = x.mean(axis=0) + sums.mean(axis=0)
    outside = np.abs(middle - [1.0, 2.0, 3.0]) - half
    assert outside.max() == pytest.approx(0.1 + 0.2 + 0.025, abs=0.02)


def test_a_box_does_not_count_near_an_attachment() -> None:
    x = np.array([[0.8, 2.0, 3.0], [1.2, 2.0, 3.0]])
    sums, weights = np.zeros((2, 3)), np.zeros(2)
    exempt = np.array([[1.0, 2.0, 3.0, 1.0]])
    repel(
        x,
        np.array([[0, 1]]),
        np.array([[0, 0]]),
        exempt,
        one_box(np.full(3, 0.5), 0.0),
        np.array([0.2]),
        0.025,
        np.zeros(2),
        np.ones(2),
        1.0,
        sums,
        weights,
    )
    assert not sums.any()
    assert not weights.any()


def test_beads_are_spread_and_move_by_their_mean_corrections() -> None:
    chance = np.random.default_rng(3)
    x = chance.normal(size=(6, 3))
    free = np.array([1.0, 0.0, 1.0, 1.0, 0.0, 0.0])
    apart, distances = np.array([[0, 1], [2, 3], [4, 5]]), np.full(3, 9.0)
    sums, weights = np.zeros((6, 3)), np.zeros(6)
    spread(x, apart, distances, free, sums, weights)
    for i, j in ((0, 1), (2, 3)):
        gap = x[i] + sums[i] - x[j] - sums[j]
        assert np.linalg.norm(gap) == pytest.approx(9.0)
    assert not sums[[1, 4, 5]].any()
    thickness, low = np.array([0.1, 0.1, 0.2, 0.1, 0.1, 0.1]), np.full(6, -0.5)
    moving = np.array([0, 2, 3])
    before, start = x.copy(), x - 0.25
    given = sums.copy()
    far = move(x, start, moving, thickness, low, np.full(6, 0.5), sums, weights)
    expected = before.copy()
    for i in moving:
        way = OVER * given[i]
        expected[i] += way * min(1.0, FARTHEST * thickness[i] / np.linalg.norm(way))
        expected[i, 2] = np.clip(expected[i, 2], -0.5, 0.5)
    np.testing.assert_allclose(x, expected, atol=1e-12)
    gone = np.linalg.norm(expected - start, axis=1)[moving] / thickness[moving]
    assert far == pytest.approx(gone.max())
    assert not sums[moving].any()


def test_beads_lie_evenly_on_their_polyline() -> None:
    points = np.array([[0.0, 0, 0], [3, 0, 0], [3, 4, 0], [9, 9, 9], [9, 9, 10]])
    x = np.zeros((8, 3))
    resample(points, np.array([0, 3, 5]), np.array([7, 2]), np.array([0, 6]), x)
    walked = np.interp(np.arange(1, 7), [0, 3, 7], [0, 3, 3])
    np.testing.assert_allclose(x[:6, 0], walked)
    np.testing.assert_allclose(x[:6, 1], np.maximum(np.arange(1, 7) - 3.0, 0.0))
    np.testing.assert_allclose(x[6], [9.0, 9.0, 9.5])
