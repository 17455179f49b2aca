"""Routing after an edit: hyperedges keep their curves unless these are in the way of what is new.

How curves are found is a router's business (`app.hyperedges.woven`,
`app.hyperedges.elastic.route`).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from app.arrays import Flags, Floats, Indices
from app.hyperedges.clearance.near_items import ItemsAround
from app.hyperedges.clearance.obstacles import obstacles_of
from app.hyperedges.elastic.faults import Curves, find_faults
from app.hyperedges.elastic.fixed import curves_of
from app.hyperedges.fault_count import NONE, UNKNOWN, Count
from app.hyperedges.joining import merge
from app.hyperedges.previous import Previous, keepable
from app.hyperedges.router import Progress, Router
from app.hyperedges.routing import Routing
from app.hyperedges.stopping import Allowance, StoppedError
from app.placement.placement import Placement

HITS = 3
"""How often hyperedges that an edit hits are routed anew with it, before all are, if that helps."""

ROOM = 12.0
"""How near to a conflict hyperedges leave little room for others, over the largest radius."""

FOR_FIRST = 0.5
"""Share of the time after which the first of two routers ends, so that the other has some, too."""


def reroute(
    placement: Placement,
    clearance: float,
    join_heights: Floats,
    routers: Sequence[Router],
    previous: Previous | None = None,
    progress: Progress = lambda _share: None,
    allowance: Allowance | None = None,
) -> Routing:
    """Curves of all hyperedges, by the first of ``routers`` that leaves no faults.

    Else by the one that leaves the fewest. Hyperedges of a ``previous`` layout keep their curves to
    the last bit, whichever router made them, unless their attachments moved, or they are in the way
    of what is new; what that comes too near to is routed anew with it. The router that made the
    previous layout comes first then. ``join_heights`` (h,) are join planes that are asked for, NaN
    where none is.

    Where conflicts are left at last, all hyperedges are routed anew, if that leaves fewer; by
    another router than that of the previous layout only if it leaves none.

    Of the time that ``allowance`` has, the first of several routers takes half at most. Where
    ``progress`` raises `StoppedError`, the best so far is what comes of it; no other router begins.
    """
    allowance = allowance or Allowance()
    kept = np.zeros(len(placement.radii), dtype=np.bool_)
    if previous is not None:
        kept = keepable(placement, clearance, join_heights, previous)
        if kept.all():
            return previous.routing.part(previous.numbers)
    if previous is None or not kept.any():
        work = _Routing(placement, clearance, tuple(routers), None, progress, allowance)
        return work.best(kept).routing
    is_elastic = previous.routing.is_elastic
    by_kind = tuple(sorted(routers, key=lambda router: router.is_elastic != is_elastic))
    work = _Routing(placement, clearance, by_kind, previous, progress, allowance)
    best = latest = work.best(kept)
    for attempt in range(1, HITS + 1):
        if not latest.freed.any() or work.is_over(0.0):
            break
        kept = latest.kept & ~latest.freed
        is_last = attempt == HITS or not kept.any()
        latest = work.whole(best.faults) if is_last else work.best(kept)
        # What had faults for long is no reason to move: fewer must be left than the edit alone has.
        if latest.faults < best.faults:
            best = latest
    return best.routing if not best.kept.any() else work.with_kept(best)


def _end_together(placement: Placement, pairs: Indices) -> Flags:
    """Which pairs (m, 2) of hyperedges end at one place.

    They touch there however they run.
    """
    starts = placement.attachment_starts
    places = np.ascontiguousarray(placement.attachment_positions).view("V24").ravel()
    found = np.zeros(len(pairs), dtype=np.bool_)
    for row, (first, second) in enumerate(pairs.tolist()):
        one, other = (places[starts[number] : starts[number + 1]] for number in (first, second))
        found[row] = np.isin(one, other).any()
    return found


@dataclass(frozen=True, slots=True, eq=False)
class _Made:
    """Curves of all hyperedges but those ``kept`` (h,), and their faults.

    ``freed`` (h,): those kept that they come too near to; or, where there are none but other
    conflicts, those that leave little room there. ``others`` are the curves of those kept.
    ``was_stopped``: there was no time to find good curves.
    """

    routing: Routing
    others: Routing
    kept: Flags
    faults: Count
    freed: Flags
    was_stopped: bool

    def is_worse_than(self, later: _Made) -> bool:
        """Whether what was made ``later`` is to be taken."""
        return later.faults < self.faults or (self.was_stopped and later.faults == self.faults)


@dataclass(frozen=True, slots=True, eq=False)
class _Routing:
    """What is routed, and how."""

    placement: Placement
    clearance: float
    routers: tuple[Router, ...]
    previous: Previous | None
    progress: Progress
    allowance: Allowance

    def is_over(self, share: float) -> bool:
        """Whether there is no time left, with so large a ``share`` of the work done."""
        try:
            self.progress(share)
        except StoppedError:
            return True
        return False

    def best(self, kept: Flags) -> _Made:
        """The best curves that a router finds beside those ``kept`` (h,)."""
        best: _Made | None = None
        for number in range(len(self.routers)):
            if best is not None and self.is_over(number / len(self.routers)):
                break
            made = self._made(number, kept)
            if best is None or best.is_worse_than(made):
                best = made
            if best.faults == NONE:
                break
        assert best is not None, "there is one router at least"  # noqa: S101
        return best

    def whole(self, least: Count) -> _Made:
        """Curves of all hyperedges, by the first router, or by another that leaves no conflicts.

        ``least`` are the faults without that.
        """
        kept = np.zeros(len(self.placement.radii), dtype=np.bool_)
        best = self._made(0, kept)
        for number in range(1, len(self.routers)):
            if min(best.faults, least).conflicts == 0 or self.is_over(number / len(self.routers)):
                break
            made = self._made(number, kept)
            if made.faults.conflicts == 0:
                best = made
        return best

    def with_kept(self, made: _Made) -> Routing:
        """What was made and what is kept, in the order of their numbers."""
        order = np.concatenate([np.flatnonzero(made.kept), np.flatnonzero(~made.kept)])
        return merge(made.others, made.routing, order)

    def _made(self, number: int, kept: Flags) -> _Made:
        router = self.routers[number]
        chosen, others = np.flatnonzero(~kept), self._old(np.flatnonzero(kept))

        def progress(share: float) -> None:
            self.progress((number + share) / len(self.routers))
            if number == 0 and len(self.routers) > 1:
                self.allowance.check(FOR_FIRST)

        routed = router.route(chosen, others, progress)
        routing = replace(routed.routing, is_elastic=router.is_elastic)
        faults, freed = NONE, np.zeros_like(kept)
        if not routed.is_proven and (self.previous is not None or len(self.routers) > 1):
            check = partial(self.progress, (number + 1) / len(self.routers))
            try:
                faults, freed = self._faults(kept, routing, others, check)
            except StoppedError:
                faults = UNKNOWN
        return _Made(routing, others, kept, faults, freed, routed.was_stopped)

    def _old(self, hyperedges: Indices) -> Routing:
        if self.previous is None:
            return Routing.nothing()
        return self.previous.routing.part(self.previous.numbers[hyperedges])

    def _faults(
        self, kept: Flags, routing: Routing, others: Routing, check: Callable[[], None]
    ) -> tuple[Count, Flags]:
        """What is wrong with curves beside the ``others``, and which of those ``kept`` to free.

        ``check`` may raise to end it.
        """
        hyperedges = np.flatnonzero(~kept)
        part = self.placement.of_hyperedges(hyperedges)
        around = ItemsAround.of(part, obstacles_of(self.placement).bodies, self.clearance)
        curves = curves_of(others, len(hyperedges))
        active = np.ones(len(hyperedges), dtype=np.bool_)
        found = find_faults(routing, curves, around, self.clearance, active, check)
        owners = np.repeat(np.arange(len(hyperedges)), np.diff(routing.segment_starts))
        owners = np.concatenate([owners, curves.owners])
        numbers = np.concatenate([hyperedges, np.flatnonzero(kept)])
        first = numbers[owners[found.segments]]
        with_item = found.others < 0
        second = np.where(with_item, -1 - found.items, numbers[owners[found.others]])
        pairs, rows = np.unique(np.stack([first, second], axis=1), axis=0, return_inverse=True)
        wrong = np.ones(len(pairs), dtype=np.bool_)
        two = np.flatnonzero(pairs[:, 1] >= 0)
        wrong[two] = ~_end_together(self.placement, pairs[two])
        second = pairs[wrong, 1]
        freed = np.zeros_like(kept)
        freed[second[second >= 0]] = True
        freed &= kept
        if not freed.any():
            near = _near_places(curves, found.places[wrong[rows.ravel()]])
            freed[numbers[curves.owners[near]]] = True
        return Count(int(wrong.sum()), len(found.pinched) + len(found.own)), freed


def _near_places(curves: Curves, places: Floats) -> Indices:
    """Which ``curves`` come near to ``places`` (n, 3)."""
    found = np.zeros(len(curves.owners), dtype=np.bool_)
    reach = ROOM * float(curves.radii.max(initial=0.0))
    for place in places:
        meets = (curves.boxes[:, :3] <= place + reach) & (curves.boxes[:, 4:7] >= place - reach)
        found |= meets.all(axis=1)
    return np.flatnonzero(found)
