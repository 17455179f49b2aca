from graphlib import CycleError, TopologicalSorter

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from app.placement.layers.ranks import feedback, ranks
from tests.placement.layers.graphs import graph_of


def goes_nowhere_round(edges: list[tuple[int, int]]) -> bool:
    sorter: TopologicalSorter[int] = TopologicalSorter()
    for tail, head in edges:
        sorter.add(head, tail)
    try:
        sorter.prepare()
    except CycleError:
        return False
    return True


@given(
    st.lists(st.tuples(st.integers(0, 7), st.integers(0, 7)).filter(lambda e: e[0] != e[1])),
    st.lists(st.booleans(), min_size=8, max_size=8),
)
def test_without_feedback_nothing_goes_round(
    edges: list[tuple[int, int]], states: list[bool]
) -> None:
    ends = np.array(edges, dtype=np.int64).reshape(-1, 2)
    back = feedback(8, ends[:, 0], ends[:, 1], np.array(states))
    assert goes_nowhere_round(ends[~back].tolist())
    if goes_nowhere_round(edges):
        assert not back.any()


def test_cycles_begin_at_what_stores() -> None:
    tails, heads = np.array([0, 1, 2]), np.array([1, 2, 0])
    assert feedback(3, tails, heads, np.array([False, True, False])).tolist() == [
        False,
        True,
        False,
    ]


def test_nets_go_right_and_outputs_share_the_last_rank() -> None:
    # 0 -> 1 -> 2, 0 -> 3; 2 and 3 are outputs.
    graph = graph_of(4, [[0, 1], [1, 2], [0, 3]], last=(2, 3))
    assert ranks(graph).tolist() == [0, 1, 2, 2]


def test_what_all_goes_round_is_cut_in_a_few_rounds() -> None:
    dice = np.random.default_rng(0)
    tails, heads = dice.integers(0, 300, (2, 5000))
    keep = tails != heads
    tails, heads = tails[keep], heads[keep]
    back = feedback(300, tails, heads, np.zeros(300, dtype=np.bool_))
    assert goes_nowhere_round(np.stack([tails, heads], 1)[~back].tolist())
