"""How much of tubes and of labels is hidden in a picture (Numba)."""

from __future__ import annotations

import numpy as np
from numba import njit

from app.arrays import Floats, Indices
from app.readability.picture import NOTHING, Picture
from app.readability.projection import Seen


def hidden_shares(
    picture: Picture, begins: Seen, ends: Seen, lengths: Floats, owners: Indices, hyperedges: int
) -> Floats:
    """The share of each hyperedge's length that is behind something else, (``hyperedges``,).

    Straight lines between ``begins`` and ``ends`` are the middles of tubes, ``lengths`` (s,) long
    in space, which the picture shows as ``owners`` (s,). Each is looked at once for each pixel.
    What is behind its own hyperedge is not hidden; nor is what has no length.
    """
    hidden = _hidden(
        picture.numbers,
        picture.pixels(begins.places),
        picture.pixels(ends.places),
        owners,
    )
    totals = np.bincount(owners, weights=lengths, minlength=hyperedges)
    found = np.bincount(owners, weights=hidden * lengths, minlength=hyperedges)
    return np.asarray(found / np.where(totals > 0.0, totals, 1.0))


def covered_shares(
    picture: Picture, middles: Seen, sizes: Floats, nearness: Floats, numbers: Indices
) -> Floats:
    """Which share of each label is covered, (l,).

    A label counts as a rectangle that faces the reader, of ``sizes`` (l, 2), width and height, in
    document units, about a place of ``middles``. It is covered by what is nearer than ``nearness``
    (l,), unless the picture shows that as one of ``numbers`` (l,): the label's own item.
    """
    halves = 0.5 * picture.scale * sizes * middles.scales[:, None]
    return _covered(
        picture.numbers,
        picture.nearness,
        picture.pixels(middles.places),
        halves,
        nearness,
        numbers,
    )


@njit(cache=True, error_model="numpy", inline="always")
def _pixel(place: float, count: int) -> int:
    return int(min(max(np.floor(place), 0.0), count - 1.0))


@njit(cache=True, error_model="numpy", nogil=True)
def _hidden(seen: Indices, begins: Floats, ends: Floats, owners: Indices) -> Floats:
    """The hidden share of each line, (s,)."""
    rows, columns = seen.shape
    found = np.zeros(len(owners))
    for k in range(len(owners)):
        x, y = ends[k, 0] - begins[k, 0], ends[k, 1] - begins[k, 1]
        steps = max(int(np.ceil(max(abs(x), abs(y)))), 1)
        hidden = 0
        for step in range(steps):
            share = (step + 0.5) / steps
            column = _pixel(begins[k, 0] + share * x, columns)
            row = _pixel(begins[k, 1] + share * y, rows)
            if seen[row, column] != owners[k]:
                hidden += 1
        found[k] = hidden / steps
    return found


@njit(cache=True, error_model="numpy", nogil=True)
def _covered(
    seen: Indices,
    nearness: Floats,
    middles: Floats,
    halves: Floats,
    least: Floats,
    numbers: Indices,
) -> Floats:
    rows, columns = seen.shape
    found = np.zeros(len(numbers))
    for k in range(len(numbers)):
        left = _pixel(middles[k, 0] - halves[k, 0] + 0.5, columns)
        right = max(_pixel(middles[k, 0] + halves[k, 0] - 0.5, columns), left)
        bottom = _pixel(middles[k, 1] - halves[k, 1] + 0.5, rows)
        top = max(_pixel(middles[k, 1] + halves[k, 1] - 0.5, rows), bottom)
        covered = 0
        for row in range(bottom, top + 1):
            for column in range(left, right + 1):
                number = seen[row, column]
                if number not in (NOTHING, numbers[k]) and nearness[row, column] > least[k]:
                    covered += 1
        found[k] = covered / ((right + 1 - left) * (top + 1 - bottom))
    return found
