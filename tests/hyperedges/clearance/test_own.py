from __future__ import annotations

import numpy as np
import pytest

from app.arrays import Floats
from app.hyperedges.clearance.own import own_contacts
from tests.hyperedges.clearance.furniture import routed


def line(start: list[float], end: list[float]) -> Floats:
    return np.linspace(start, end, 4)


def arc(radius: float, first: float, last: float) -> Floats:
    """Part of a circle in the plane, angles in quarter turns."""
    a, b = first * np.pi / 2, last * np.pi / 2
    handle = 4 / 3 * np.tan((b - a) / 4)
    at = [np.array([np.cos(angle), np.sin(angle), 0.0]) for angle in (a, b)]
    along = [np.array([-np.sin(angle), np.cos(angle), 0.0]) for angle in (a, b)]
    return radius * np.array([at[0], at[0] + handle * along[0], at[1] - handle * along[1], at[1]])


def test_a_straight_tube_does_not_touch_itself() -> None:
    chain = [line([k, 0, 0], [k + 1, 0, 0]) for k in range(5)]
    assert len(own_contacts(routed([chain]), 0.05).hyperedges) == 0


@pytest.mark.parametrize("radius", [0.11, 0.15, 1.0])
def test_a_bend_that_a_tube_can_follow_is_no_contact(radius: float) -> None:
    turn = [line([radius, -3, 0], [radius, 0, 0]), arc(radius, 0, 1), arc(radius, 1, 2)]
    back = [line([-radius, 0, 0], [-radius, -3, 0])]
    found = own_contacts(routed([turn + back], radius=0.1))
    assert len(found.hyperedges) == 0


def test_a_turn_too_tight_for_its_tube_is_a_contact() -> None:
    turn = [line([0.05, -3, 0], [0.05, 0, 0]), arc(0.05, 0, 1), arc(0.05, 1, 2)]
    back = [line([-0.05, 0, 0], [-0.05, -3, 0])]
    found = own_contacts(routed([turn + back], radius=0.1))
    assert found.hyperedges.tolist() == [0]
    assert found.lower[0] == pytest.approx(-0.1, abs=0.02)


def test_a_loop_that_comes_back_to_itself_is_found_once_where_it_is_nearest() -> None:
    loop = [
        line([-5, 0, 0], [0, 0, 0]),
        line([0, 0, 0], [3, 3, 0]),
        line([3, 3, 0], [3, -3, 0.15]),
        line([3, -3, 0.15], [-2, 2, 0.15]),
    ]
    straight = [line([0, 50, 0], [9, 50, 0])]
    found = own_contacts(routed([straight, loop]))
    assert found.hyperedges.tolist() == [1]
    assert found.lower[0] <= -0.05 <= found.upper[0]
    np.testing.assert_allclose(found.places[0], [0, 0, 0.075], atol=0.2)


def test_one_curve_that_loops_touches_itself() -> None:
    loop = np.array([[0, 0, 0], [4, 3, 0], [-3, 3, 0], [1, 0, 0.0]])
    assert own_contacts(routed([[loop]])).hyperedges.tolist() == [0]


def star(middle: list[float], arms: list[Floats]) -> tuple[list[Floats], list[tuple[int, int]]]:
    assert all((arm[0] == middle).all() for arm in arms)
    return arms, [(3, k) for k in range(3)]


def test_arms_may_part_slowly_at_a_join_but_not_meet_again() -> None:
    middle = [0.0, 0, 0]
    stem = line(middle, [-5, 0, 0])
    left = np.array([middle, [2, 0, 0], [3, 0.5, 0], [4, 2, 0]])
    right = left * [1, -1, 1]
    arms, ends = star(middle, [stem, left, right])
    assert len(own_contacts(routed([arms], ends=[ends], joins=[1])).hyperedges) == 0
    meeting = np.array([middle, [2, 0, 0], [5, 6, 0], [4.1, 2.1, 0]])
    arms, ends = star(middle, [stem, left, meeting])
    found = own_contacts(routed([arms], ends=[ends], joins=[1]))
    assert found.hyperedges.tolist() == [0]
    np.testing.assert_allclose(found.places[0], [4, 2, 0], atol=0.3)


def test_arms_may_part_slowly_over_many_bends() -> None:
    middle = [0.0, 0, 0]
    stem = line(middle, [-5, 0, 0])
    count, ends = 12, [(3, 0)]
    arms = [stem]
    for side, tip in ((1, 1), (-1, 2)):
        stops = [[0.3 * k, side * 0.002 * k**2, 0.0] for k in range(count + 1)]
        arms += [line(stops[k], stops[k + 1]) for k in range(count)]
        bends = [4 + (count - 1) * (tip - 1) + k for k in range(count - 1)]
        ends += list(zip([3, *bends], [*bends, tip], strict=True))
    slowly = routed([arms], ends=[ends], joins=[1 + 2 * (count - 1)])
    assert len(own_contacts(slowly).hyperedges) == 0
    # Tips that come back to each other are a contact, though the arms touch at the join too.
    arms[count] = line(arms[count][0].tolist(), [3.45, -0.24, 0])
    back = routed([arms], ends=[ends], joins=[1 + 2 * (count - 1)], radius=0.05)
    found = own_contacts(back)
    assert found.hyperedges.tolist() == [0]
    assert found.places[0, 0] > 3


def test_no_hyperedges_have_no_contacts() -> None:
    assert len(own_contacts(routed([])).hyperedges) == 0
