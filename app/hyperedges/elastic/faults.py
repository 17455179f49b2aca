"""What is wrong with fitted curves: where they come too near, or bend too much."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from app.arrays import Flags, Floats, Indices
from app.hyperedges.clearance.near_items import ItemsAround
from app.hyperedges.clearance.obstacle_gaps import obstacle_gaps
from app.hyperedges.clearance.obstacles import Obstacles
from app.hyperedges.clearance.own import own_contacts
from app.hyperedges.clearance.pairs import boxes, close_pairs
from app.hyperedges.pinches import find_pinches
from app.hyperedges.routing import Routing
from app.hyperedges.stopping import unchecked

TINY = 1e-12


@dataclass(frozen=True, slots=True, eq=False)
class Curves:
    """Curves that are kept: ``points`` (g, 4, 3), ``owners`` and ``radii`` (g,).

    ``boxes`` (g, 8) are around their tubes, as those of `app.hyperedges.clearance.pairs.boxes`.
    """

    points: Floats
    owners: Indices
    radii: Floats
    boxes: Floats

    @staticmethod
    def of(points: Floats, owners: Indices, radii: Floats) -> Curves:
        """With their boxes."""
        return Curves(points, owners, radii, boxes(points, radii))


@dataclass(frozen=True, slots=True, eq=False)
class Faults:
    """Places where curves are too near, and segments that bend too much.

    ``segments`` (n,) come too near; ``others`` (n,): to which other segment, those that are kept
    behind those that move, or -1 for an item; ``items`` (n,): to which item, or -1.
    ``places`` (n, 3) are halfway, ``ways`` (n, 3) unit vectors from the other one to the
    segment, ``lower`` (n,) bounds of the distance.
    ``pinched`` (p,) segments; ``own`` (k,) hyperedges that touch themselves, at ``own_places``
    (k, 3). ``hit`` (m,): kept hyperedges, by their owners' numbers.
    """

    segments: Indices
    others: Indices
    items: Indices
    places: Floats
    ways: Floats
    lower: Floats
    pinched: Indices
    own: Indices
    own_places: Floats
    hit: Indices

    @property
    def count(self) -> int:
        """How many there are."""
        return len(self.segments) + len(self.pinched) + len(self.own)


def find_faults(
    routing: Routing,
    kept: Curves,
    around: ItemsAround,
    clearance: float,
    active: Flags,
    check: Callable[[], None] = unchecked,
) -> Faults:
    """The faults of the hyperedges ``active`` (h,), and of others with them and with items.

    ``check`` is called now and then, and may raise to end it.
    """
    count = len(routing.control_points)
    owners = np.repeat(np.arange(len(routing.radii)), np.diff(routing.segment_starts))
    moving = Curves.of(routing.control_points, owners, routing.radii[owners])
    asking = np.flatnonzero(active[owners])
    rows = _within_reach(moving, kept, asking, clearance)
    points, owners, radii = (
        np.concatenate([here[rows[rows < count]], there[rows[rows >= count] - count]])
        for here, there in (
            (moving.points, kept.points),
            (moving.owners, kept.owners),
            (moving.radii, kept.radii),
        )
    )
    asked = np.zeros(len(rows), dtype=np.bool_)
    asked[np.searchsorted(rows, asking)] = True
    pairs, found = close_pairs(points, owners, radii, clearance, asked, check=check)
    at, lower, places = found.at, found.lower, found.places
    hit = np.unique(owners[pairs[rows[pairs[:, 1]] >= count, 1]])
    ways = _ways(points, pairs, at)
    pairs = rows[pairs]
    check()
    near = around.near(
        moving.points[asking], moving.owners[asking], moving.radii[asking], clearance
    )
    beside = obstacle_gaps(near.points, near.radii, around.obstacles, near.pairs, clearance)
    close = beside.lower < clearance
    part = np.flatnonzero(active)
    some = routing.part(part)
    own = own_contacts(some)
    return Faults(
        segments=np.concatenate([pairs[:, 0], asking[near.segments[near.pairs[close, 0]]]]),
        others=np.concatenate([pairs[:, 1], np.full(int(close.sum()), -1)]),
        items=np.concatenate(
            [np.full(len(pairs), -1), around.obstacles.items[near.pairs[close, 1]]]
        ),
        places=np.concatenate([places, beside.places[close]]),
        ways=np.concatenate(
            [ways, _outward(around.obstacles, near.pairs[close, 1], beside.places[close])]
        ),
        lower=np.concatenate([lower, beside.lower[close]]),
        pinched=asking[find_pinches(some).segments],
        own=part[own.hyperedges],
        own_places=own.places,
        hit=hit,
    )


def _within_reach(moving: Curves, kept: Curves, asking: Indices, clearance: float) -> Indices:
    """Which curves, those ``kept`` behind those ``moving``, meet the box around some: ascending.

    Around those ``asking`` (k,) and ``clearance`` from them.
    """
    around = np.concatenate([moving.boxes, kept.boxes])
    if len(asking) == 0:
        return asking
    low = moving.boxes[asking, :3].min(axis=0) - clearance
    high = moving.boxes[asking, 4:7].max(axis=0) + clearance
    meets = (around[:, :3] <= high) & (around[:, 4:7] >= low)
    return np.flatnonzero(meets[:, 0] & meets[:, 1] & meets[:, 2])


def _ways(points: Floats, pairs: Indices, at: Floats) -> Floats:
    """Unit vectors (n, 3) between the nearest places of pairs, to the first."""
    share = at[:, :, None, None]
    rest = 1.0 - share
    weights = np.concatenate([rest**3, 3 * rest**2 * share, 3 * rest * share**2, share**3], axis=3)
    there = np.einsum("nkij,nkjc->nkc", weights, points[pairs])
    way = there[:, 0] - there[:, 1]
    return np.asarray(way / np.maximum(np.linalg.norm(way, axis=1), 1e-12)[:, None])


def _outward(obstacles: Obstacles, boxes: Indices, places: Floats) -> Floats:
    """Unit vectors (n, 3) from ``boxes`` (n,) of obstacles to ``places`` (n, 3).

    From within a box by the shortest way out.
    """
    frames, halves = obstacles.rotations[boxes], obstacles.halves[boxes]
    local = np.einsum("nij,ni->nj", frames, places - obstacles.centers[boxes])
    ways = local - np.clip(local, -halves, halves)
    inside = np.flatnonzero(np.abs(ways).max(axis=1, initial=0.0) < TINY)
    axis = np.argmin(halves[inside] - np.abs(local[inside]), axis=1)
    ways[inside, axis] = np.where(local[inside, axis] < 0.0, -1.0, 1.0)
    lengths = np.linalg.norm(ways, axis=1)[:, None]
    return np.asarray(np.einsum("nij,nj->ni", frames, ways / np.maximum(lengths, TINY)))
