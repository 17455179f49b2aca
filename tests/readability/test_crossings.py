"""Crossings of lines in a picture."""

from __future__ import annotations

from fractions import Fraction
from random import Random

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.arrays import Floats, Indices
from app.readability.crossings import Crossings, count_crossings, find_crossings


def polylines(*lines: list[tuple[float, float]]) -> tuple[Floats, Floats, Indices]:
    """Straight pieces of polylines, each of an owner of its own."""
    begins = np.array([at for line in lines for at in line[:-1]], dtype=np.float64)
    ends = np.array([at for line in lines for at in line[1:]], dtype=np.float64)
    owners = np.repeat(np.arange(len(lines)), [len(line) - 1 for line in lines])
    return begins, ends, owners


def crossings(*lines: list[tuple[float, float]]) -> Crossings:
    return find_crossings(*polylines(*lines))


@pytest.mark.parametrize("degrees", [1.0, 19.9, 20.1, 45.0, 90.0])
def test_two_lines_cross_once_at_their_angle(degrees: float) -> None:
    angle = np.radians(degrees)
    way = (float(np.cos(angle)), float(np.sin(angle)))
    lines = polylines([(-2.0, 1.0), (2.0, 1.0)], [(-way[0], 1 - way[1]), (way[0], 1 + way[1])])
    found = find_crossings(*lines)
    assert found.lines.tolist() == [[0, 1]]
    assert np.allclose(found.places, [[0.0, 1.0]])
    assert np.allclose(found.angles, angle)
    assert count_crossings(*lines, np.radians(20.0)) == (1, int(degrees < 20.0))


def test_an_obtuse_angle_is_told_as_the_acute_one_beside_it() -> None:
    found = crossings([(0.0, 0.0), (4.0, 0.0)], [(4.0, 1.0), (0.0, -1.0)])
    assert np.allclose(found.angles, np.arctan2(1.0, 2.0))


def test_lines_of_one_hyperedge_do_not_count() -> None:
    begins, ends, _ = polylines([(-1.0, 0.0), (1.0, 0.0)], [(0.0, -1.0), (0.0, 1.0)])
    assert len(find_crossings(begins, ends, np.array([3, 3])).lines) == 0


@pytest.mark.parametrize(
    ("one", "other", "count"),
    [
        # Through a corner, along a side to either end, through a corner of both.
        ([(-1, 0), (1, 0)], [(-1, -1), (0, 0), (1, 1)], 1),
        ([(-1, 0), (1, 0)], [(-1, -1), (0, 0), (0.5, 0), (1, 1)], 1),
        ([(-1, 0), (0, 0), (1, 0)], [(0, -1), (0, 0), (0, 1)], 1),
        ([(-1, -1), (0, 0), (1, -1)], [(-1, 0), (0, 0), (1, 0)], None),  # touches: none, or two
        ([(0, 0), (1, 0)], [(0, 0), (1, 0)], 0),  # lies on it
        ([(0, 0), (1, 0)], [(2, 0), (3, 0)], 0),
        ([(0, 0), (1, 0)], [(0, 1), (1, 1)], 0),
    ],
)
def test_what_meets_at_corners(
    one: list[tuple[float, float]], other: list[tuple[float, float]], count: int | None
) -> None:
    # Turned by quarters, so that no direction is special, and listed both ways round.
    for turn in ([[1, 0], [0, 1]], [[0, -1], [1, 0]], [[-1, 0], [0, -1]], [[0, 1], [-1, 0]]):
        a, b = ([tuple(at) for at in (np.array(line) @ turn).tolist()] for line in (one, other))
        for lines in ((a, b), (b, a), (a[::-1], b), (a, b[::-1])):
            found = len(crossings(*lines).lines)
            assert found in (0, 2) if count is None else found == count


def test_upright_lines_behind_each_other_do_not_cross() -> None:
    # As those of tubes that stand in rows: on each other but for rounding.
    heights = np.linspace(0.0, 3.0, 40)
    lines = []
    for row in range(4):
        x = 0.1 * row * 3 - 0.3 * row + 1.7
        lines.append([(float(x), float(z + 0.013 * row)) for z in heights])
    assert len(crossings(*lines).lines) == 0


places = st.tuples(st.integers(-40, 40), st.integers(-40, 40))
programs = st.lists(st.lists(places, min_size=2, max_size=6), min_size=2, max_size=8)


@given(programs, st.randoms(use_true_random=False))
@settings(deadline=None)
def test_crossings_do_not_depend_on_the_order_of_hyperedges(
    program: list[list[tuple[int, int]]], chance: Random
) -> None:
    # Each hyperedge a little beside the grid, in its own way: no three points are on a line.
    lines = [
        [
            (x + 0.0123 * k + 0.00071 * n, y - 0.0217 * k * k + 0.00037 * n * n)
            for n, (x, y) in enumerate(line)
        ]
        for k, line in enumerate(program)
    ]
    order = list(range(len(lines)))
    chance.shuffle(order)
    here, there = crossings(*lines), crossings(*(lines[k] for k in order))
    assert len(here.lines) == len(there.lines)
    assert np.allclose(np.sort(here.angles), np.sort(there.angles))


@given(programs)
@settings(deadline=None)
def test_as_many_as_exact_numbers_say(program: list[list[tuple[int, int]]]) -> None:
    """Each hyperedge is moved by an infinitesimal way of its own: here 10⁻⁹ times its number."""
    lines = [[(float(x), float(y)) for x, y in line] for line in program]
    begins, ends, owners = polylines(*lines)
    moved = [
        [
            (x + k * Fraction(618033989, 10**18), y + k * Fraction(786151378, 10**18))
            for x, y in line
        ]
        for k, line in enumerate(program)
    ]
    expected = sum(
        _exactly(one[i], one[i + 1], other[j], other[j + 1])
        for k, one in enumerate(moved)
        for other in moved[k + 1 :]
        for i in range(len(one) - 1)
        for j in range(len(other) - 1)
    )
    found = find_crossings(begins, ends, owners)
    assert len(found.lines) == expected
    for acute in (0.3, np.pi / 2 + 1e-9):
        few = int((found.angles < acute).sum())
        assert count_crossings(begins, ends, owners, acute) == (expected, few)


def _exactly(
    a: tuple[Fraction, ...],
    b: tuple[Fraction, ...],
    c: tuple[Fraction, ...],
    d: tuple[Fraction, ...],
) -> bool:
    def side(p: tuple[Fraction, ...], q: tuple[Fraction, ...], r: tuple[Fraction, ...]) -> bool:
        return (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]) > 0

    return side(a, b, c) != side(a, b, d) and side(c, d, a) != side(c, d, b)


def test_no_lines_do_not_cross() -> None:
    none = np.zeros((0, 2))
    assert len(find_crossings(none, none, np.zeros(0, dtype=np.int64)).lines) == 0
    assert count_crossings(none, none, np.zeros(0, dtype=np.int64), 1.0) == (0, 0)


def test_more_than_are_looked_at_together() -> None:
    # A grid of 100 by 100 lines, each of 200 pieces.
    steps = np.linspace(-0.5, 99.5, 201)
    lines = [[(float(s), float(k)) for s in steps] for k in range(100)]
    lines += [[(float(k), float(s)) for s in steps] for k in range(100)]
    begins, ends, owners = polylines(*lines)
    assert count_crossings(begins, ends, owners, 1.0) == (10_000, 0)
