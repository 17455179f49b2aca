"""Routings for these tests: the paper's CURVES over a given order, written as plainly as can be."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from app.arrays import Floats
from app.hyperedges.routing import Routing

RADIUS = 0.1


def routing_of(hyperedges: Sequence[Floats], radius: float = RADIUS) -> Routing:
    """A routing of hyperedges that join the points of each array (n, 3), two by two in order."""
    curves: list[Floats] = []
    ends: list[tuple[int, int]] = []
    joins: list[Floats] = []
    tangents: list[Floats] = []
    for points in hyperedges:
        queue = list(range(len(points)))
        places = [np.asarray(point, dtype=np.float64) for point in points]
        following: dict[int, Floats] = {}
        height = max(place[2] for place in places) + 1.5
        while len(queue) > 2:
            a, b, *queue = queue
            rest = np.mean([places[k] for k in queue], axis=0)
            middle = (places[a] + places[b] + rest) / 3
            middle[2] = height
            inside = (middle + places[a] + places[b]) / 3
            number = len(places)
            places.append(middle)
            queue.append(number)
            following[number] = 2 * middle - inside
            for end in (a, b):
                first = following.get(end, (places[end] + middle) / 2)
                curves.append(np.array([places[end], first, inside, middle]))
                ends.append((end, number))
            joins.append(middle)
            tangents.append((middle - inside) / np.linalg.norm(middle - inside))
        a, b = queue
        if b in following and a not in following:
            a, b = b, a
        first, last = _last_handles(
            places[a], places[b], following.get(a), following.get(b), height
        )
        curves.append(np.array([places[a], first, last, places[b]]))
        ends.append((a, b))
    sizes = np.array([len(points) for points in hyperedges])
    return Routing(
        control_points=np.array(curves),
        segment_starts=np.concatenate([[0], np.cumsum(2 * (sizes - 2) + 1)]),
        segment_ends=np.array(ends),
        join_positions=np.array(joins).reshape(-1, 3),
        join_tangents=np.array(tangents).reshape(-1, 3),
        join_starts=np.concatenate([[0], np.cumsum(sizes - 2)]),
        join_planes=np.zeros(len(sizes)),
        radii=np.full(len(sizes), radius),
    )


def _last_handles(
    a: Floats, b: Floats, after_a: Floats | None, after_b: Floats | None, height: float
) -> tuple[Floats, Floats]:
    if after_a is None or after_b is None:
        if after_a is not None:
            return after_a, (after_a + b) / 2
        first, last = (2 * a + b) / 3, (a + 2 * b) / 3
        first[2] = last[2] = height
        return first, last
    return after_a, after_b


def segments(*curves: Sequence[Sequence[float]], radius: float = RADIUS) -> Routing:
    """A routing whose hyperedges are single segments with these control points."""
    count = len(curves)
    return Routing(
        control_points=np.array(curves, dtype=np.float64).reshape(count, 4, 3),
        segment_starts=np.arange(count + 1),
        segment_ends=np.tile([0, 1], (count, 1)),
        join_positions=np.zeros((0, 3)),
        join_tangents=np.zeros((0, 3)),
        join_starts=np.zeros(count + 1, dtype=np.int64),
        join_planes=np.zeros(count),
        radii=np.full(count, radius),
    )


def random_routing(
    seed: int, hyperedges: int, attachments: int = 3, spread: float = 6.0, radius: float = RADIUS
) -> Routing:
    """Hyperedges between points spread out enough for gentle bends."""
    generator = np.random.default_rng(seed)
    points = []
    for _ in range(hyperedges):
        while True:
            candidate = generator.uniform(0, spread, (attachments, 3)) * [1, 1, 0.1]
            apart = np.linalg.norm(candidate[:, None] - candidate, axis=2) + 9 * np.eye(attachments)
            if apart.min() > spread / 4:
                break
        points.append(candidate)
    return routing_of(points, radius)


def places_on(control_points: Floats, count: int) -> Floats:
    """Points at equal steps of the parameter, (…, count, 3), of curves (…, 4, 3)."""
    t = np.linspace(0.0, 1.0, count)
    weights = np.stack([(1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t**2 * (1 - t), t**3], axis=1)
    return np.asarray(np.einsum("ti,...ix->...tx", weights, control_points))


def nearest(places: Floats, control_points: Floats) -> Floats:
    """The nearest points (v, 3) to ``places`` (v, 3) on curves (s, 4, 3), by dense sampling."""
    from scipy.spatial import cKDTree

    curve = places_on(control_points, 1501)
    starts, steps = curve[:, :-1].reshape(-1, 3), np.diff(curve, axis=1).reshape(-1, 3)
    _, near = cKDTree(starts + steps / 2).query(places, k=4)
    share = np.einsum("vkx,vkx->vk", places[:, None] - starts[near], steps[near])
    share = np.clip(share / np.einsum("vkx,vkx->vk", steps[near], steps[near]), 0.0, 1.0)
    candidates = starts[near] + share[:, :, None] * steps[near]
    best = np.argmin(np.linalg.norm(places[:, None] - candidates, axis=2), axis=1)
    return np.take_along_axis(candidates, best[:, None, None], axis=1)[:, 0]


def smallest_bend(control_points: Floats) -> Floats:
    """The smallest radius of curvature of each curve (s, 4, 3), by dense sampling."""
    t = np.linspace(0.0, 1.0, 400)
    legs = np.diff(control_points, axis=1)
    first = np.stack([(1 - t) ** 2, 2 * t * (1 - t), t**2], axis=1)
    second = np.stack([1 - t, t], axis=1)
    velocity = 3 * np.einsum("ti,six->stx", first, legs)
    turning = 6 * np.einsum("ti,six->stx", second, np.diff(legs, axis=1))
    across = np.linalg.norm(np.cross(velocity, turning), axis=2)
    radii = np.linalg.norm(velocity, axis=2) ** 3 / np.maximum(across, 1e-12)
    return np.asarray(radii.min(axis=1))
