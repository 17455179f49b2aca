import numpy as np

from app.placement.layers.layered import layered
from app.placement.layers.order import order, spaces_of
from app.placement.layers.parts import in_parts
from app.placement.layers.ranks import ranks
from app.placement.layers.terminals import LANE, terminals
from app.placement.layers.tracks import tracks
from tests.placement.layers.graphs import graph_of

CROSSED = [[0, 3], [1, 2], [0, 3], [4, 0, 1]]
"""Two items after each other's partner: in the document's order their nets cross."""


def test_a_lane_stands_in_each_rank_that_a_net_passes() -> None:
    graph = graph_of(4, [[0, 1], [1, 2], [2, 3], [0, 3]])
    found = terminals(graph, ranks(graph))
    lanes = found.object_nets != LANE
    assert found.object_nets[lanes].tolist() == [3, 3]
    assert found.object_ranks[lanes].tolist() == [1, 2]
    # Each net has an end on either side of every channel that it runs through.
    assert (found.group_starts[:-1] < found.group_middles).all()
    assert (found.group_middles < found.group_starts[1:]).all()


def test_sweeps_and_exchanges_undo_crossings() -> None:
    graph = graph_of(5, CROSSED)
    between = terminals(graph, ranks(graph))
    start = np.arange(len(between.object_ranks))
    spaces = spaces_of(between)
    assert order(between, start, 0, spaces)[1] > 0
    assert order(between, start, 24, spaces)[1] == 0


def test_objects_of_a_rank_keep_apart_and_nets_run_straight_where_they_can() -> None:
    plan = layered(graph_of(3, [[0, 1], [1, 2]]), 0.05)
    assert np.isnan(plan.trunks).all()
    assert len(set(plan.items[:, 1].tolist())) == 1
    assert (np.diff(plan.items[:, 0]) > 1.0).all()


def test_a_trunk_stands_left_of_another_whose_end_is_level_with_its_own() -> None:
    # One channel: net 0 from row 0 on the left to row 2, net 1 from row 5 to row 0.
    starts, middles = np.array([0, 2, 4]), np.array([1, 3])
    found, dodges, _ = tracks(np.array([0, 2]), starts, middles, np.array([0.0, 2.0, 5.0, 0.0]))
    assert found[0] < found[1]
    assert not dodges.any()


def test_where_two_trunks_would_each_be_left_of_the_other_one_dodges() -> None:
    starts, middles = np.array([0, 2, 4]), np.array([1, 3])
    found, dodges, _ = tracks(np.array([0, 2]), starts, middles, np.array([0.0, 5.0, 5.0, 0.0]))
    assert sorted(dodges.tolist()) == [0, 1]
    assert found[0] != found[1]


def test_parts_stand_below_each_other_and_what_joins_nothing_at_the_bottom() -> None:
    origins, layers = in_parts(graph_of(6, [[0, 1], [2, 3], [3, 4]]), 0.05)
    assert [nets.tolist() for nets in layers.nets] == [[1, 2], [0]]
    assert origins[[2, 3, 4], 1].max() < origins[[0, 1], 1].min()
    assert origins[5, 1] > origins[:5, 1].max()


def test_a_long_chain_is_folded_into_lines_that_are_read_from_left_to_right() -> None:
    links = [[number, number + 1] for number in range(39)]
    plan = layered(graph_of(40, links), 0.05)
    x, v = plan.items.T
    assert np.ptp(x) < 4.0 * np.ptp(v)
    ends = np.flatnonzero(np.diff(x) < 0.0)
    assert len(ends) == len(plan.turning) >= 2
    # Only from line to line it goes back, and down.
    assert (np.diff(v)[ends] > 1.0).all()
    assert (plan.turns[:, 1] > v[ends]).all()
    assert (plan.turns[:, 1] < v[ends + 1]).all()
