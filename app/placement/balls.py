"""Ends on balls: each where its hyperedge goes, as far from each other as tubes need."""

from __future__ import annotations

import numpy as np
from numba import njit

from app.arrays import Flags, Floats, Indices

ROUNDS, DRAWN = 400, 60
"""Of pushing ends apart, at most, and the first ones, in which something draws them back."""

FEW = 64
"""Items of a hyperedge that are looked at pair by pair."""

BACK = 0.1
"""How far ends are drawn to where they are wanted in a round, over what they are away."""

FRONT = -0.2
"""How far to the front ends of labelled balls are, at most, over the radius."""

ABOVE_LABEL = 0.3
"""But for those so high, over the radius: the label stands before the lower part of a ball."""


@njit(cache=True, error_model="numpy")
def towards(places: Floats, starts: Indices) -> Floats:
    """Where each of the ``places`` (a, 3) of hyperedges' items wants to lead (a, 3), any length.

    To the others of its hyperedge, to near ones more: as a short tree does. Those of hyperedge k
    are ``starts[k]`` to ``starts[k + 1]`` (h + 1,); where they are more than `FEW`, to their
    middle.
    """
    found = np.zeros_like(places)
    for number in range(len(starts) - 1):
        begin, end = starts[number], starts[number + 1]
        if end - begin > FEW:
            middle = np.zeros(3)
            for i in range(begin, end):
                middle += places[i]
            middle /= end - begin
            for i in range(begin, end):
                found[i] = middle - places[i]
            continue
        for i in range(begin, end):
            for j in range(begin, end):
                square = 0.0
                for axis in range(3):
                    square += (places[j, axis] - places[i, axis]) ** 2
                if square > 1e-18:
                    for axis in range(3):
                        found[i, axis] += (places[j, axis] - places[i, axis]) / square
    return found


@njit(cache=True, error_model="numpy")
def spread_on_balls(
    wanted: Floats, starts: Indices, needs: Floats, held: Flags, labelled: Flags
) -> Floats:
    """Unit directions (e, 3) of ends near those ``wanted`` (e, 3), also unit, on each of b balls.

    The ends of ball k are ``starts[k]`` to ``starts[k + 1]`` (b + 1,). Two of them are ``needs[k]``
    (b,) apart, over the radius, where there is room. Those that are ``held`` (e,) stay; others keep
    clear of the label before the lower part of a ball, where there is one, ``labelled`` (b,).
    """
    found = wanted.copy()
    steps, counts = np.zeros_like(found), np.zeros(len(found))
    for ball in range(len(needs)):
        begin, end = starts[ball], starts[ball + 1]
        need = needs[ball]
        for step in range(ROUNDS):
            worst = _push(found, begin, end, need, held, steps, counts)
            if worst < 1e-3 * need and step >= min(DRAWN, 2 * (end - begin)):
                for i in range(begin, end):
                    steps[i] = 0.0
                    counts[i] = 0.0
                break
            draw = BACK * max(0.0, 1.0 - step / DRAWN)
            for i in range(begin, end):
                if not held[i]:
                    share = 1.0 / np.sqrt(max(counts[i], 1.0))
                    for axis in range(3):
                        found[i, axis] += share * steps[i, axis]
                        found[i, axis] += draw * (wanted[i, axis] - found[i, axis])
                    _keep_clear(found, i, labelled[ball])
                steps[i] = 0.0
                counts[i] = 0.0
    return found


@njit(cache=True, error_model="numpy")
def _push(
    found: Floats, begin: int, end: int, need: float, held: Flags, steps: Floats, counts: Floats
) -> float:
    """Add to ``steps`` (e, 3) what moves ends of a ball apart; how much is lacking at most."""
    worst = 0.0
    for i in range(begin, end):
        for j in range(begin, i):
            square = 0.0
            for axis in range(3):
                square += (found[i, axis] - found[j, axis]) ** 2
            far = np.sqrt(square)
            shares = (0.0 if held[i] else 1.0) + (0.0 if held[j] else 1.0)
            if far >= need or shares == 0.0:
                continue
            worst = max(worst, need - far)
            for axis in range(3):
                way = (found[i, axis] - found[j, axis]) / far if far > 1e-9 else 0.0
                if far <= 1e-9 and axis == (i + j) % 3:
                    way = 1.0
                way *= (need - far) / shares
                if not held[i]:
                    steps[i, axis] += way
                if not held[j]:
                    steps[j, axis] -= way
            counts[i] += 1.0
            counts[j] += 1.0
    return worst


@njit(cache=True, error_model="numpy")
def _keep_clear(found: Floats, i: int, labelled: bool) -> None:
    """Make a direction a unit one again, in place, that does not lead into a label."""
    length = np.sqrt(found[i, 0] ** 2 + found[i, 1] ** 2 + found[i, 2] ** 2)
    for axis in range(3):
        found[i, axis] /= length
    if not labelled or found[i, 1] >= FRONT or found[i, 2] >= ABOVE_LABEL:
        return
    across = np.hypot(found[i, 0], found[i, 2])
    side = np.sqrt(1.0 - FRONT**2)
    found[i, 1] = FRONT
    if across < 1e-9:
        found[i, 0], found[i, 2] = 0.0, side
        return
    found[i, 0] *= side / across
    found[i, 2] *= side / across
