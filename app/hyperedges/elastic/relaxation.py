"""Steps that straighten chains of beads and let them push each other apart (Numba).

Each step is one of Jacobi's: all beads move at once, by what the places before say. Chains are
drawn straight by the Laplacian and the biharmonic operator along them, as splines are (Unser 1999:
their second and fourth differences); what is too near is moved apart by position-based corrections
that are averaged at each bead (Macklin, Müller and Chentanez 2016, without its multipliers).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from app.arrays import Floats, Indices
from app.hyperedges.elastic.bending import TINY, distance, keep_long, straighten, unbend
from app.hyperedges.elastic.capsules import separate
from app.hyperedges.elastic.rounded_boxes import Boxes, repel

OVER = 1.2
"""Corrections are lengthened by this, because those of neighbours are averaged."""

FARTHEST = 0.6
"""Longest correction in one step, over the tube's radius."""


FEWEST = 3
"""Steps that are taken even where beads go far: what is overlooked is seen afterwards."""


class Rates(NamedTuple):
    """How strongly chains are straightened.

    ``laplacian`` and ``biharmonic`` are shares of what is missing that are made up in one step.
    Tubes grow from the share ``begin`` of their distances to ``end``, in ``growth`` steps.
    """

    laplacian: float
    biharmonic: float
    begin: float = 1.0
    end: float = 1.0
    growth: int = 1


class Near(NamedTuple):
    """What may come too near to what.

    ``pairs`` (m, 2) of segments; ``boxes`` (n, 2): a segment and an item's box; ``exempt`` (n, 4):
    a place and a radius within which the box does not count, 0 where it always does. ``apart``
    (k, 2): beads that are to be ``distances`` (k,) apart.
    """

    pairs: Indices
    boxes: Indices
    exempt: Floats
    apart: Indices
    distances: Floats


@njit(cache=True, error_model="numpy")
def relax(
    x: Floats,
    links: Indices,
    degrees: Indices,
    stems: Indices,
    free: Floats,
    thickness: Floats,
    bends: Floats,
    spans: Floats,
    lows: Floats,
    highs: Floats,
    lifts: Floats,
    segments: Indices,
    rooms: Floats,
    half: float,
    moving: Indices,
    around: Indices,
    near: Near,
    boxes: Boxes,
    rates: Rates,
    first: int,
    last: int,
    skin: float,
) -> int:
    """Take steps ``first`` to ``last`` of a run; the number of the next one.

    It ends before, but not before `FEWEST` steps, where a bead has gone half of ``skin``, which is
    in radii of its tube: other things may be near it then.

    ``x`` (b, 3) and what is beside it as `app.hyperedges.elastic.beads.Beads` has it; ``stems``
    (j,): which link of a join is its stem; ``bends`` (b,): least radii of curvature; ``spans``
    (b,): least distances from neighbours. ``rooms`` (s,): half of what a segment keeps from others,
    its tube with it; ``half`` is half of the clearance. Only the beads ``moving`` (m,) move, which
    with their neighbours are those ``around`` (n,).
    """
    start = x.copy()
    laps, tangents = np.zeros_like(x), np.zeros((len(stems), 3))
    sums, weights = np.zeros_like(x), np.zeros(len(x))
    beside, steps = np.zeros(len(x)), np.empty_like(x)
    step = first
    while step < last:
        size = rates.begin + (rates.end - rates.begin) * min(1.0, step / rates.growth)
        straighten(
            x,
            links,
            degrees,
            stems,
            thickness,
            lifts,
            moving,
            around,
            rates.laplacian,
            rates.biharmonic,
            laps,
            tangents,
            beside,
            steps,
        )
        separate(x, segments, near.pairs, rooms, beside, free, size, sums, weights)
        repel(
            x,
            segments,
            near.boxes,
            near.exempt,
            boxes,
            rooms,
            half,
            beside,
            free,
            size,
            sums,
            weights,
        )
        unbend(x, links, degrees, bends, free, around, sums, weights)
        keep_long(x, links, degrees, spans, free, around, sums, weights)
        spread(x, near.apart, near.distances, free, sums, weights)
        farthest = move(x, start, moving, thickness, lows, highs, sums, weights)
        step += 1
        if farthest > 0.5 * skin and step - first >= FEWEST:
            break
    return step


@njit(cache=True, error_model="numpy")
def spread(
    x: Floats, apart: Indices, distances: Floats, free: Floats, sums: Floats, weights: Floats
) -> None:
    """Add what moves pairs of beads ``apart`` (k, 2) to ``distances`` (k,)."""
    for k in range(len(apart)):
        i, j = apart[k, 0], apart[k, 1]
        length = distance(x, i, j)
        shares = free[i] + free[j]
        if length >= distances[k] or length < TINY or shares == 0.0:
            continue
        push = (distances[k] - length) / (length * shares)
        for axis in range(3):
            way = push * (x[i, axis] - x[j, axis])
            sums[i, axis] += free[i] * way
            sums[j, axis] -= free[j] * way
        weights[i] += 1.0
        weights[j] += 1.0


@njit(cache=True, error_model="numpy")
def move(
    x: Floats,
    start: Floats,
    moving: Indices,
    thickness: Floats,
    lows: Floats,
    highs: Floats,
    sums: Floats,
    weights: Floats,
) -> float:
    """Move beads by the mean of their corrections.

    Gives how far one is from its ``start``, at most, in radii of its tube. Clears their ``sums``
    (b, 3) and ``weights`` (b,); those of all other beads are 0.
    """
    farthest = 0.0
    for i in moving:
        if weights[i] > 0.0:
            share = OVER / max(1.0, weights[i])
            length = share * np.sqrt(sums[i, 0] ** 2 + sums[i, 1] ** 2 + sums[i, 2] ** 2)
            if length > FARTHEST * thickness[i]:
                share *= FARTHEST * thickness[i] / length
            for axis in range(3):
                x[i, axis] += share * sums[i, axis]
        x[i, 2] = min(max(x[i, 2], lows[i]), highs[i])
        square = 0.0
        for axis in range(3):
            square += (x[i, axis] - start[i, axis]) ** 2
        farthest = max(farthest, square / thickness[i] ** 2)
        sums[i] = 0.0
        weights[i] = 0.0
    return float(np.sqrt(farthest))
