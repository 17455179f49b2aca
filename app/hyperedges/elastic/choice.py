"""Routing by relaxation or in planes, whichever comes out better."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from app.arrays import Floats
from app.hyperedges.clearance.certificate import certify
from app.hyperedges.elastic.route import route_elastic
from app.hyperedges.pinches import find_pinches
from app.hyperedges.routing import Routing
from app.hyperedges.woven import Previous, weave_all
from app.placement.placement import Placement

Progress = Callable[[float], None]


def route_clear(
    placement: Placement,
    clearance: float,
    join_heights: Floats,
    previous: Previous | None = None,
    progress: Progress = lambda _share: None,
) -> Routing:
    """Curves by relaxation where they are proven clear, without pinches and own contacts.

    Else in planes, or by relaxation where planes leave more of these faults. Where any of
    ``join_heights`` (h,) is given, and not NaN, in planes: there heights mean something.
    """
    if not np.isnan(join_heights).all():
        return weave_all(placement, clearance, join_heights, previous, progress)
    elastic = route_elastic(
        placement, clearance, join_heights, previous, lambda share: progress(0.5 * share)
    )
    faults = _faults(elastic, placement, clearance)
    if faults == 0:
        return elastic
    planes = weave_all(
        placement, clearance, join_heights, previous, lambda share: progress(0.5 + 0.5 * share)
    )
    return elastic if faults < _faults(planes, placement, clearance) else planes


def _faults(routing: Routing, placement: Placement, clearance: float) -> int:
    found = certify(routing, placement, clearance)
    pinches = find_pinches(routing)
    return len(found.conflicts) + len(pinches.segments) + len(found.own.hyperedges)
