"""Segments of different hyperedges that are near each other, and how near."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from numba import njit
from numpy.typing import NDArray

from app.arrays import Floats, Indices
from app.hyperedges.clearance.box_tree import meeting, plant
from app.hyperedges.clearance.distance import search
from app.hyperedges.clearance.few_boxes import FEW, meeting_among
from app.hyperedges.clearance.parallel import in_parts
from app.hyperedges.clearance.search import workspace
from app.hyperedges.stopping import unchecked

FINEST = 1e-3
"""Of the tubes' radii: to so much times the tolerance surfaces that just touch are measured."""

ASKED_AT_ONCE, MANY = 1024, 1_000_000
"""Segments whose pairs are measured at once, at first; half as many where that makes many pairs."""

ROUNDING = 1e-14
"""Of the largest coordinate: boxes are wider by this, so that rounding loses no pair."""


@dataclass(frozen=True, slots=True, eq=False)
class Gaps:
    """Distances between the surfaces of m pairs.

    ``lower`` and ``upper`` (m,): proven bounds, in document units; negative where tubes pass
    through each other, by how deep. ``at`` (m, 2): the parameters of the places at distance
    ``upper`` on the two cubics; ``places`` (m, 3): halfway between the surfaces there.
    """

    lower: Floats
    upper: Floats
    at: Floats
    places: Floats


def boxes(control_points: Floats, margins: Floats, layers: Indices | None = None) -> Floats:
    """Boxes (s, 8) along the axes, ``margins`` (s,) around the hulls of cubics (s, 4, 3).

    In ``layers`` (s,), or all in one (`app.hyperedges.clearance.box_tree`).
    """
    found = np.zeros((len(control_points), 8))
    around = margins + ROUNDING * float(np.abs(control_points).max(initial=0.0))
    a, b, c, d = (control_points[:, k] for k in range(4))
    found[:, :3] = np.minimum(np.minimum(a, b), np.minimum(c, d)) - around[:, None]
    found[:, 4:7] = np.maximum(np.maximum(a, b), np.maximum(c, d)) + around[:, None]
    if layers is not None:
        found[:, 3] = found[:, 7] = layers
    return found


def near_pairs(
    control_points: Floats,
    owners: Indices,
    radii: Floats,
    clearance: float,
    active: NDArray[np.bool_] | None = None,
) -> Indices:
    """Pairs (m, 2) of segments of different owners that may be nearer than ``clearance``.

    ``control_points`` (s, 4, 3), ``owners`` and ``radii`` (s,) of the segments. These are all pairs
    whose hulls have boxes that come nearer than both radii and the clearance along each axis. With
    ``active`` (s,) those alone of which one is active or both. Smaller number first, sorted.

    >>> line = np.array([[0.0, 0, 0], [1, 0, 0], [2, 0, 0], [3, 0, 0]])
    >>> lines = np.stack([line, line + [0, 0.5, 0], line + [0, 9, 0]])
    >>> near_pairs(lines, np.array([0, 1, 2]), np.full(3, 0.2), 0.2).tolist()
    [[0, 1]]
    """
    if len(control_points) < 2:
        return np.zeros((0, 2), dtype=np.int64)
    around = boxes(control_points, radii + 0.5 * clearance)
    asked = np.ones(len(owners), dtype=np.bool_) if active is None else active
    if len(around) ** 2 <= 2 * FEW:
        return meeting_among(around, owners, asked)
    tree = plant(around)
    # In the tree's order, because neighbours look through the same nodes.
    asking = tree.order[asked[tree.order]]
    return meeting(tree, around, asking, (owners, owners), asked)


def close_pairs(
    control_points: Floats,
    owners: Indices,
    radii: Floats,
    clearance: float,
    active: NDArray[np.bool_] | None = None,
    tolerance: float = 0.01,
    check: Callable[[], None] = unchecked,
) -> tuple[Indices, Gaps]:
    """The `near_pairs` (m, 2) whose tubes are not proven ``clearance`` apart, and their `gaps`.

    ``check`` is called now and then, and may raise to end it.
    """
    parts = close_parts(control_points, owners, radii, clearance, active, tolerance, check)
    return joined(list(parts))


def close_parts(
    control_points: Floats,
    owners: Indices,
    radii: Floats,
    clearance: float,
    active: NDArray[np.bool_] | None = None,
    tolerance: float = 0.01,
    check: Callable[[], None] = unchecked,
) -> Iterator[tuple[Indices, Gaps]]:
    """The same part by part: all pairs that are near at once may be more than memory holds."""
    check()
    if len(control_points) ** 2 <= 2 * FEW:
        pairs = near_pairs(control_points, owners, radii, clearance, active)
        yield _close(control_points, radii, pairs, clearance, tolerance)
        return
    around = boxes(control_points, radii + 0.5 * clearance)
    asked = np.ones(len(owners), dtype=np.bool_) if active is None else active
    tree = plant(around)
    asking = tree.order[asked[tree.order]]
    begin, size = 0, ASKED_AT_ONCE
    while begin < len(asking):
        check()
        some = asking[begin : begin + size]
        pairs = meeting(tree, around, some, (owners, owners), asked)
        yield _close(control_points, radii, pairs, clearance, tolerance)
        begin += size
        size = max(size // 2, 1) if len(pairs) > MANY else 2 * size


def joined(parts: list[tuple[Indices, Gaps]]) -> tuple[Indices, Gaps]:
    """Parts of pairs and their gaps as one, sorted by the pairs."""
    pairs = np.concatenate([np.zeros((0, 2), dtype=np.int64), *(pairs for pairs, _ in parts)])
    order = np.lexsort((pairs[:, 1], pairs[:, 0]))
    gaps_ = [gaps for _, gaps in parts]
    return pairs[order], Gaps(
        np.concatenate([np.zeros(0), *(each.lower for each in gaps_)])[order],
        np.concatenate([np.zeros(0), *(each.upper for each in gaps_)])[order],
        np.concatenate([np.zeros((0, 2)), *(each.at for each in gaps_)])[order],
        np.concatenate([np.zeros((0, 3)), *(each.places for each in gaps_)])[order],
    )


def _close(
    control_points: Floats, radii: Floats, pairs: Indices, clearance: float, tolerance: float
) -> tuple[Indices, Gaps]:
    """Those of the ``pairs`` (m, 2) that are too near, and their gaps."""
    found = gaps(control_points, radii, pairs, clearance, tolerance)
    close = found.lower < clearance
    return pairs[close], Gaps(
        found.lower[close], found.upper[close], found.at[close], found.places[close]
    )


def gaps(
    control_points: Floats, radii: Floats, pairs: Indices, enough: float, tolerance: float = 0.01
) -> Gaps:
    """How far the tubes of ``pairs`` (m, 2) of segments (s, 4, 3) of ``radii`` (s,) are apart.

    A pair is left at a lower bound of ``enough`` or more. The bounds of any other are no farther
    from each other than ``tolerance`` times the distance, or than a thousandth of that times both
    radii, but where curves lie on each other over some length: there the lower bound is looser.
    """
    count = len(pairs)
    found = Gaps(np.empty(count), np.empty(count), np.empty((count, 2)), np.empty((count, 3)))
    in_parts(
        count,
        lambda begin, end: _measure(
            control_points,
            radii,
            pairs[begin:end],
            enough,
            tolerance,
            found.lower[begin:end],
            found.upper[begin:end],
            found.at[begin:end],
            found.places[begin:end],
        ),
    )
    return found


@njit(cache=True, error_model="numpy", nogil=True)
def _measure(
    control_points: Floats,
    radii: Floats,
    pairs: Indices,
    enough: float,
    tolerance: float,
    lower: Floats,
    upper: Floats,
    at: Floats,
    places: Floats,
) -> None:
    rows, keys, heap, free = workspace()
    for k in range(len(pairs)):
        i, j = pairs[k, 0], pairs[k, 1]
        thickness = radii[i] + radii[j]
        near, far, u, v = search(
            control_points[i],
            control_points[j],
            enough + thickness,
            thickness,
            tolerance,
            FINEST * tolerance * thickness,
            rows,
            keys,
            heap,
            free,
        )
        lower[k], upper[k] = near - thickness, far - thickness
        at[k, 0], at[k, 1] = u, v
        # From the first curve over its radius and half the gap.
        share = (radii[i] + 0.5 * (far - thickness)) / far if far > 0.0 else 0.5
        for axis in range(3):
            here = bezier(control_points, i, axis, u)
            places[k, axis] = here + share * (bezier(control_points, j, axis, v) - here)


@njit(cache=True, error_model="numpy")
def bezier(control_points: Floats, segment: int, axis: int, t: float) -> float:
    """One coordinate of a segment's point at ``t``."""
    r = 1.0 - t
    return float(
        r * r * r * control_points[segment, 0, axis]
        + 3.0 * r * r * t * control_points[segment, 1, axis]
        + 3.0 * r * t * t * control_points[segment, 2, axis]
        + t * t * t * control_points[segment, 3, axis]
    )
