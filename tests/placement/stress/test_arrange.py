from __future__ import annotations

import hashlib
import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.placement.stress.arrange import Hypergraph, arranged
from app.placement.stress.boxes import are_near
from tests.placement.stress.graphs import hypergraph, hypergraphs

FLAT = hypergraphs(2)
either = st.one_of(FLAT, hypergraphs(3))


@settings(max_examples=40)
@given(either)
def test_no_two_are_nearer_than_the_gaps(graph: Hypergraph) -> None:
    x = arranged(graph)
    assert np.isfinite(x).all()
    assert not are_near(x, graph.boxes).any()


@settings(max_examples=40)
@given(either, st.integers(0, 1000))
def test_what_is_held_stays_to_the_bit_and_others_keep_clear_of_it(
    graph: Hypergraph, seed: int
) -> None:
    before = arranged(graph)
    chance = np.random.default_rng(seed)
    held = chance.random(len(before)) < 0.7
    known = replace(graph, places=before, placed=held, held=held)
    after = arranged(known)
    assert (after[held] == before[held]).all()
    near = are_near(after, graph.boxes)
    assert not near.any()


def test_what_is_joined_stands_nearer_than_what_is_not() -> None:
    # A chain, whose items are numbered at random.
    order = np.random.default_rng(3).permutation(24)
    pairs = np.sort(np.column_stack([order[:-1], order[1:]]), axis=1)
    graph = replace(hypergraph(24, 0, 2, 1), starts=np.arange(0, 47, 2), members=pairs.reshape(-1))
    x = arranged(graph)
    apart = np.linalg.norm(x[:, None] - x[None], axis=2)
    neighbours = apart[pairs[:, 0], pairs[:, 1]]
    assert neighbours.mean() < 0.4 * apart[np.triu_indices(24, 1)].mean()


def test_components_stand_side_by_side() -> None:
    graph = hypergraph(30, 0, 2, 5)
    members = np.concatenate([[k, k + 1, k + 2] for k in range(0, 30, 3)])
    graph = replace(graph, starts=np.arange(0, 31, 3), members=members)
    x = arranged(graph)
    for one in range(0, 30, 3):
        for other in range(0, one, 3):
            low, high = x[one : one + 3].min(axis=0), x[one : one + 3].max(axis=0)
            below, above = x[other : other + 3].min(axis=0), x[other : other + 3].max(axis=0)
            assert (low > above).any() or (below > high).any()


def test_many_are_placed_with_pivots() -> None:
    graph = hypergraph(900, 900, 2, 7)
    x = arranged(graph)
    assert not are_near(x, graph.boxes).any()
    # Members of one hyperedge are nearer to each other than chance would have them.
    apart = [
        np.linalg.norm(np.ptp(x[graph.members[a:b]], axis=0))
        for a, b in zip(graph.starts[:-1], graph.starts[1:], strict=True)
    ]
    assert np.mean(apart) < 0.7 * np.linalg.norm(np.ptp(x, axis=0))


def test_work_can_be_ended() -> None:
    class EndedError(Exception):
        pass

    def end() -> None:
        raise EndedError

    with pytest.raises(EndedError):
        arranged(hypergraph(20, 20, 2, 1), end)


DIGEST = """
import hashlib
from app.placement.stress.arrange import arranged
from tests.placement.stress.graphs import hypergraph
print(hashlib.sha256(b"".join(
    arranged(hypergraph(40, 40, dimensions, 11)).tobytes() for dimensions in (2, 3)
)).hexdigest())
"""


def test_another_process_finds_the_same_bits() -> None:
    here = b"".join(arranged(hypergraph(40, 40, size, 11)).tobytes() for size in (2, 3))
    there = subprocess.run(
        [sys.executable, "-c", DIGEST], capture_output=True, text=True, check=True
    )
    assert there.stdout.strip() == hashlib.sha256(here).hexdigest()
