"""Tubes made a few at a time are those made at once."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.tubes.sweep import sweep
from app.tubes.unswept import UnsweptTubes
from tests.tubes.routings import routing_of

CHANCE = np.random.default_rng(5)
ROUTING = routing_of([CHANCE.uniform(0, 5, (count, 3)) for count in (2, 5, 3, 4, 2)])
TOLERANCES = np.array([0.002, 0.004, 0.05, 0.01, 0.03])


@given(st.lists(st.integers(0, 4), min_size=1, max_size=6))
def test_any_part_is_equal_to_the_bit(members: list[int]) -> None:
    whole = sweep(ROUTING, TOLERANCES)
    part = UnsweptTubes.of(ROUTING, TOLERANCES).swept(np.array(members))
    for place, member in enumerate(members):
        own, expected = part.mesh(place), whole.mesh(member)
        assert np.array_equal(own.vertices, expected.vertices)
        assert np.array_equal(own.normals, expected.normals)
        assert np.array_equal(own.faces, expected.faces)


@pytest.mark.parametrize("tolerance", [0.0005, 0.02, TOLERANCES], ids=str)
def test_vertices_are_counted_beforehand(tolerance: float) -> None:
    whole = sweep(ROUTING, tolerance)
    counts = UnsweptTubes.of(ROUTING, tolerance).vertex_counts
    assert np.array_equal(counts, np.diff(whole.vertex_starts))


def test_a_part_of_a_routing_keeps_its_joins() -> None:
    part = ROUTING.part(np.array([3, 1]))
    assert part.attachment_counts.tolist() == [4, 5]
    joins = ROUTING.join_starts
    assert np.array_equal(part.join_positions[:2], ROUTING.join_positions[joins[3] : joins[4]])
    assert np.array_equal(part.join_positions[2:], ROUTING.join_positions[joins[1] : joins[2]])


def test_a_tolerance_must_be_positive() -> None:
    with pytest.raises(ValueError, match="positive"):
        UnsweptTubes.of(ROUTING, np.array([1.0, 1.0, 0.0, 1.0, 1.0]))
