import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import linprog

from app.arrays import Indices
from app.placement.layers.simplex import solve

ENOUGH = 10**9


@st.composite
def graphs(draw: st.DrawFn) -> tuple[int, Indices]:
    """Nodes, and edges (e, 4) that go to nodes of larger numbers and join all of them."""
    count = draw(st.integers(2, 9))
    edges = [(draw(st.integers(0, head - 1)), head) for head in range(1, count)]
    for _ in range(draw(st.integers(0, 12))):
        head = draw(st.integers(1, count - 1))
        edges.append((draw(st.integers(0, head - 1)), head))
    numbers = st.integers(-3, 4), st.integers(0, 9)
    return count, np.array([(*edge, *(draw(number) for number in numbers)) for edge in edges])


@given(graphs())
def test_the_sum_is_as_small_as_a_linear_program_makes_it(graph: tuple[int, Indices]) -> None:
    count, edges = graph
    tails, heads, lengths, weights = edges.T
    found = solve(count, tails, heads, lengths, weights, ENOUGH)
    assert (found[heads] - found[tails] >= lengths).all()
    rows = np.zeros((len(edges), count))
    np.add.at(rows, (np.arange(len(edges)), heads), -1.0)
    np.add.at(rows, (np.arange(len(edges)), tails), 1.0)
    cost = -(weights @ rows)
    best = linprog(cost, A_ub=rows, b_ub=-lengths, bounds=(None, None))
    assert cost @ found == pytest.approx(best.fun)


def test_what_goes_round_has_no_solution() -> None:
    edges = np.array([[0, 1, 1, 1], [1, 0, 1, 1]]).T
    with pytest.raises(ValueError, match="circle"):
        solve(2, edges[0], edges[1], edges[2], edges[3], ENOUGH)


def test_what_is_in_two_parts_has_no_solution() -> None:
    edges = np.array([[0, 1, 1, 1]]).T
    with pytest.raises(ValueError, match="do not join"):
        solve(3, edges[0], edges[1], edges[2], edges[3], ENOUGH)
