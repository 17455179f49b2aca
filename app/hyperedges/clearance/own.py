"""Where a hyperedge comes near itself."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit
from numpy.typing import NDArray

from app.arrays import Floats, Indices
from app.hyperedges.clearance.box_tree import meeting, plant
from app.hyperedges.clearance.pairs import boxes, gaps
from app.hyperedges.clearance.pieces import TURN, cut
from app.hyperedges.clearance.ways import Ways, walk, ways_of
from app.hyperedges.routing import Routing


@dataclass(frozen=True, slots=True, eq=False)
class OwnContacts:
    """Hyperedges that come near themselves, each once, at the nearest place.

    ``hyperedges`` (k,), ascending; ``lower`` and ``upper`` (k,): bounds of the distance between the
    surfaces, negative where they pass through each other; ``places`` (k, 3).
    """

    hyperedges: Indices
    lower: Floats
    upper: Floats
    places: Floats


def own_contacts(routing: Routing, enough: float = 0.0, tolerance: float = 0.01) -> OwnContacts:
    """Hyperedges whose own tubes are not proven to be ``enough`` apart, beyond their joins.

    Segments are taken in pieces (`app.hyperedges.clearance.pieces`). Two pieces of one hyperedge
    are measured against each other if the way between them along the tree, by the chords of the
    pieces passed, is longer than half a turn as tight as the tube, pi times the radius. The bounds
    are those of `app.hyperedges.clearance.pairs.gaps`.

    Arms leave a join as slowly as it is smooth. So they count as one there until they have parted:
    where the way between two pieces passes a join of three, they are in contact only if between
    there and here lie pieces on either side that are ``enough`` apart.
    """
    if len(routing.control_points) == 0:
        nothing = np.zeros(0)
        return OwnContacts(np.zeros(0, dtype=np.int64), nothing, nothing, np.zeros((0, 3)))
    segment_owners = np.repeat(np.arange(len(routing.radii)), np.diff(routing.segment_starts))
    pieces = cut(routing.control_points, routing.radii[segment_owners])
    owners = segment_owners[pieces.segments]
    radii = routing.radii[owners]
    limits = TURN * radii
    around = boxes(pieces.curves, radii + 0.5 * enough, layers=owners)
    tree = plant(around)
    numbers, everyone = np.arange(len(owners)), np.ones(len(owners), dtype=np.bool_)
    near = meeting(tree, around, tree.order, (numbers, numbers), everyone)
    ways = ways_of(routing, pieces)
    near = near[_far_along(near, ways, limits)]
    found = gaps(pieces.curves, radii, near, enough, tolerance)
    close = np.flatnonzero(found.lower < enough)
    close = close[~_not_parted(near[close], ways, limits)]
    close = close[np.lexsort((found.lower[close], owners[near[close, 0]]))]
    hyperedges, firsts = np.unique(owners[near[close, 0]], return_index=True)
    nearest = close[firsts]
    return OwnContacts(
        hyperedges, found.lower[nearest], found.upper[nearest], found.places[nearest]
    )


@njit(cache=True, error_model="numpy")
def _far_along(pairs: Indices, ways: Ways, limits: Floats) -> NDArray[np.bool_]:
    """Which pairs (m, 2) of pieces are farther from each other along the tree than ``limits``."""
    far = np.zeros(len(pairs), np.bool_)
    for k in range(len(pairs)):
        limit = limits[pairs[k, 0]]
        far[k] = walk(pairs[k, 0], pairs[k, 1], ways, limit).length > limit
    return far


@njit(cache=True, error_model="numpy")
def _not_parted(pairs: Indices, ways: Ways, limits: Floats) -> NDArray[np.bool_]:
    """Which of the close pairs (m, 2), sorted, are so without a break from a join of three on."""
    count = len(ways.parents)
    keys = pairs[:, 0] * count + pairs[:, 1]
    steps = np.empty(len(pairs), np.int64)
    for k in range(len(pairs)):
        steps[k] = walk(pairs[k, 0], pairs[k, 1], ways, np.inf).steps
    together = np.zeros(len(pairs), np.bool_)
    # Whatever is nearer to the join along the way is decided before.
    for pair in np.argsort(steps, kind="mergesort"):
        a, b = pairs[pair, 0], pairs[pair, 1]
        way = walk(a, b, ways, np.inf)
        if not way.forked:
            continue
        for first, second in ((way.after, b), (a, way.before), (way.after, way.before)):
            low, high = min(first, second), max(first, second)
            row = int(np.searchsorted(keys, low * count + high))
            if row < len(keys) and keys[row] == low * count + high:
                together[pair] |= together[row]
            else:
                within = walk(low, high, ways, limits[low])
                together[pair] |= within.forked and within.length <= limits[low]
    return together
