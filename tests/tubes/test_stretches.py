from __future__ import annotations

from typing import TypeAlias

import numpy as np
import pytest

from app.hyperedges.routing import Routing
from app.tubes.stretches import Stretches
from app.tubes.unions import plan_unions
from tests.tubes.routings import random_routing, segments, smallest_bend

Curve: TypeAlias = list[list[float]]

GENTLE: Curve = [[0, 0, 0], [1, 0, 0], [2, 0, 1], [3, 0, 1]]
ARCH: Curve = [[0, 0, 0], [0, 0, 3], [4, 0, 3], [4, 0, 0]]
HAIRPIN: Curve = [[0, 0, 0], [2, 0, 0], [2, 0.05, 0], [0, 0.05, 0]]
LOOP: Curve = [[0, 0, 0], [4, 2, 0.02], [-3, 2, 0.05], [1, 0, 0.07]]


def cut(routing: Routing) -> Stretches:
    return plan_unions(routing, 0.002).stretches


@pytest.mark.parametrize("curve", [GENTLE, ARCH])
def test_a_gentle_tube_is_one_stretch(curve: Curve) -> None:
    assert cut(segments(curve)).open.tolist() == [True]


def test_a_tight_bend_lies_between_stretches() -> None:
    found = cut(segments(HAIRPIN)).open.tolist()
    assert found[0]
    assert found[-1]
    assert not all(found)


def test_a_tube_that_comes_back_to_itself_is_cut_though_it_bends_gently() -> None:
    assert smallest_bend(np.array([LOOP], dtype=float)).min() > 0.2
    found = cut(segments(LOOP)).open
    assert found.all()
    assert len(found) > 1


def test_no_tube_is_swept_where_it_bends_too_tightly() -> None:
    routing = segments(*random_routing(1, 40, 5, spread=2.0).control_points.tolist())
    tight = smallest_bend(routing.control_points) < 0.09
    stretches = cut(routing)
    swept = np.logical_and.reduceat(stretches.open, stretches.starts[:-1])
    assert tight.any()
    assert not swept[tight].any()


def test_stretches_follow_each_other_from_end_to_end() -> None:
    plan = plan_unions(random_routing(1, 20, 5, spread=2.0), 0.002)
    found = plan.stretches
    for k, count in enumerate(plan.rings.counts):
        own = slice(found.starts[k], found.starts[k + 1])
        first, last = found.first[own], found.last[own]
        assert (first[0], last[-1]) == (0, count - 1)
        np.testing.assert_array_equal(first[1:], last[:-1])
        assert (first < last).all()
