"""The proof that hyperedges are clear of each other and of items, or where they are not."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from app.arrays import Floats, Indices
from app.hyperedges.clearance.conflicts import Conflicts, Contact, kept, nearest_of, once
from app.hyperedges.clearance.near_items import ItemsAround
from app.hyperedges.clearance.obstacle_gaps import obstacle_gaps
from app.hyperedges.clearance.obstacles import Obstacles, obstacles_of
from app.hyperedges.clearance.own import OwnContacts, own_contacts
from app.hyperedges.clearance.pairs import Gaps, close_parts, gaps, joined, near_pairs
from app.hyperedges.routing import Routing
from app.hyperedges.stopping import StoppedError, unchecked
from app.placement.placement import Placement

AHEAD = 2.0
"""Of the largest radius: so much farther than the clearance the smallest distance is looked for."""

AT_ONCE = 16384
"""Pairs measured before the smallest distance so far is taken into account."""

MOST_CONFLICTS = 250_000
"""Pairs of hyperedges in conflict beyond which no others are looked for."""


@dataclass(frozen=True, slots=True, eq=False)
class Certificate:
    """What is proven of a routing.

    ``certified``: every two hyperedges, and every hyperedge and every item, are ``required`` apart
    or more, surface from surface. A hyperedge may be nearer to an item that it attaches to, but
    only in a ball about its attachment (`app.hyperedges.clearance.own_bodies`), and may pass what
    contains such an item. Labels do not count. Where all that is so ``conflicts`` is empty; what
    could not be decided is in it. ``minimum`` is a lower bound of the smallest of these distances,
    within a hundredth of it where ``nearest`` says what is there; without ``nearest`` nothing is as
    near as that. ``own`` are hyperedges that touch themselves, which is for them to decide.

    Where not everything was measured it is not ``complete``: ``conflicts`` are those found so far,
    nothing is ``certified``, there is no ``nearest``, and ``minimum`` is what tubes that lie on
    each other would have.
    """

    required: float
    certified: bool
    minimum: float
    nearest: Contact | None
    conflicts: Conflicts
    own: OwnContacts
    complete: bool = True


def certify(
    routing: Routing,
    placement: Placement,
    clearance: float,
    check: Callable[[], None] = unchecked,
) -> Certificate:
    """The certificate of a routing, for surfaces ``clearance`` apart.

    Distances are bounded by subdivision, never by sampling, in floating point with more room for
    rounding than it can take (`app.hyperedges.clearance.cubic`). A pair that is exactly
    ``clearance`` apart cannot be decided, and is a conflict. Hyperedges that share an attachment
    are one too. Without conflicts the smallest distance is looked for as far as the clearance and
    the diameter of the thickest tube. Beyond `MOST_CONFLICTS`, or where ``check`` raises
    `app.hyperedges.stopping.StoppedError`, the rest is left, and the certificate not complete.

    Raises `ValueError` where a control point, a radius or an item's place is not finite.
    """
    _refuse_infinite(routing, placement)
    scene = _Scene.of(routing, placement, clearance)
    conflicts, complete = scene.conflicts(clearance, check)
    nearest: Contact | None
    if not complete:
        minimum, nearest = -2.0 * float(routing.radii.max(initial=0.0)), None
    elif len(conflicts):
        nearest = nearest_of(conflicts)
        minimum = nearest.lower
    else:
        reach = clearance + AHEAD * float(routing.radii.max(initial=0.0))
        minimum, nearest = _look_ahead(scene.near(reach), scene.around.obstacles, reach)
        # The clearance is proven already, and may be within a hundredth of the smallest distance.
        minimum = max(minimum, clearance)
    return Certificate(
        clearance,
        complete and not len(conflicts),
        minimum,
        nearest,
        conflicts,
        own_contacts(routing),
        complete,
    )


@dataclass(frozen=True, slots=True, eq=False)
class _Scene:
    """All segments, with their hyperedges and radii (s,), and what may be in their way."""

    points: Floats
    owners: Indices
    radii: Floats
    around: ItemsAround

    @classmethod
    def of(cls, routing: Routing, placement: Placement, clearance: float) -> _Scene:
        owners = np.repeat(np.arange(len(routing.radii)), np.diff(routing.segment_starts))
        return cls(
            np.ascontiguousarray(routing.control_points),
            owners,
            routing.radii[owners],
            ItemsAround.of(placement, obstacles_of(placement).bodies, clearance),
        )

    def conflicts(self, clearance: float, check: Callable[[], None]) -> tuple[Conflicts, bool]:
        """What is not proven to be clear, and whether that is all."""
        beside = self.around.near(self.points, self.owners, self.radii, clearance)
        parts: list[tuple[Indices, Gaps]] = []
        complete = True
        try:
            for pairs, found in close_parts(
                self.points, self.owners, self.radii, clearance, check=check
            ):
                parts.append(self._nearest(pairs, found))
                if sum(len(part) for part, _ in parts) > MOST_CONFLICTS:
                    parts = [self._nearest(*joined(parts))]
                    complete = len(parts[0][0]) <= MOST_CONFLICTS
                    if not complete:
                        break
        except StoppedError:
            complete = False
        tubes, found = joined(parts)
        items = obstacle_gaps(
            beside.points, beside.radii, self.around.obstacles, beside.pairs, clearance
        )
        everything = Gaps(
            np.concatenate([found.lower, items.lower]),
            np.concatenate([found.upper, items.upper]),
            np.concatenate([found.at, items.at]),
            np.concatenate([found.places, items.places]),
        )
        near = _Near(beside.points, beside.owners, beside.radii, tubes, beside.pairs)
        contacts = near.contacts(self.around.obstacles, everything)
        return once(contacts, everything.lower < clearance), complete

    def _nearest(self, pairs: Indices, found: Gaps) -> tuple[Indices, Gaps]:
        """Of the ``pairs`` (m, 2) of segments the nearest one for each pair of hyperedges."""
        owners = self.owners[pairs]
        order = np.lexsort((pairs[:, 1], pairs[:, 0], found.lower, owners[:, 1], owners[:, 0]))
        owners = owners[order]
        new = np.ones(len(order), dtype=np.bool_)
        new[1:] = (owners[1:] != owners[:-1]).any(axis=1)
        rows = order[new]
        least = Gaps(found.lower[rows], found.upper[rows], found.at[rows], found.places[rows])
        return pairs[rows], least

    def near(self, reach: float) -> _Near:
        """What may be nearer than ``reach``."""
        tubes = near_pairs(self.points, self.owners, self.radii, reach)
        beside = self.around.near(self.points, self.owners, self.radii, reach)
        return _Near(beside.points, beside.owners, beside.radii, tubes, beside.pairs)


@dataclass(frozen=True, slots=True, eq=False)
class _Near:
    """Pairs (m, 2) of curves, ``tubes``, and of a curve and an obstacle, ``items``.

    Curves are all segments, then what of some is beyond the balls about their attachments.
    """

    points: Floats
    owners: Indices
    radii: Floats
    tubes: Indices
    items: Indices

    def part(self, begin: int, end: int) -> _Near:
        """Some of the pairs of either kind."""
        return replace(self, tubes=self.tubes[begin:end], items=self.items[begin:end])

    def measured(self, obstacles: Obstacles, enough: float) -> Gaps:
        """The gaps of both kinds of pairs."""
        tubes = gaps(self.points, self.radii, self.tubes, enough)
        items = obstacle_gaps(self.points, self.radii, obstacles, self.items, enough)
        return Gaps(
            np.concatenate([tubes.lower, items.lower]),
            np.concatenate([tubes.upper, items.upper]),
            np.concatenate([tubes.at, items.at]),
            np.concatenate([tubes.places, items.places]),
        )

    def contacts(self, obstacles: Obstacles, found: Gaps) -> Conflicts:
        """The pairs by name."""
        tubes, items = self.tubes, self.items
        with_items = np.repeat([False, True], [len(tubes), len(items)])
        first = self.owners[np.concatenate([tubes[:, 0], items[:, 0]])]
        second = np.concatenate([self.owners[tubes[:, 1]], obstacles.items[items[:, 1]]])
        return Conflicts(with_items, first, second, found.places, found.lower, found.upper)


def _refuse_infinite(routing: Routing, placement: Placement) -> None:
    for numbers in (
        routing.control_points,
        routing.radii,
        placement.centers,
        placement.rotations,
        placement.sizes,
    ):
        if not np.isfinite(numbers).all():
            raise ValueError("Only what is at finite places can be certified.")


def _look_ahead(near: _Near, obstacles: Obstacles, reach: float) -> tuple[float, Contact | None]:
    """The smallest distance of pairs of segments, and of segments and boxes, below ``reach``.

    Whatever is farther apart than the nearest so far is left as soon as that is known.
    """
    lowest, enough = reach, reach
    nearest: Contact | None = None
    for begin in range(0, max(len(near.tubes), len(near.items)), AT_ONCE):
        some = near.part(begin, begin + AT_ONCE)
        found = some.measured(obstacles, enough)
        lowest = min(lowest, float(found.lower.min()))
        if found.upper.min() < enough:
            # What was left early is not the nearest: its lower bound is above another's upper.
            rows = np.flatnonzero(found.upper < enough)
            row = rows[[int(found.upper[rows].argmin())]]
            nearest = nearest_of(kept(some.contacts(obstacles, found), row))
            enough = nearest.upper
    return lowest, nearest
