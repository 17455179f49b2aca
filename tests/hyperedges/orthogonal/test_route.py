import numpy as np
import pytest

from app.hyperedges.orthogonal.route import route_in_layers
from app.hyperedges.routing import Routing
from app.placement.layers.parts import in_parts
from tests.placement.layers.graphs import graph_of


def routed(nets: list[list[int]]) -> Routing:
    items = 1 + max(map(max, nets))
    graph = graph_of(items, nets)
    _, layers = in_parts(graph, 0.05)
    return route_in_layers(layers, graph.net_starts, graph.radii)


NETS = [
    [[0, 1]],
    [[0, 1, 2, 3]],
    [[0, 1], [1, 2], [2, 3], [0, 3], [3, 0]],
    [[0, 1], [2, 3, 4], [1, 0, 1]],
]


@pytest.mark.parametrize("nets", NETS)
def test_each_net_is_a_tree_of_its_ends(nets: list[list[int]]) -> None:
    routing = routed(nets)
    assert routing.attachment_counts.tolist() == [len(net) for net in nets]
    for k, net in enumerate(nets):
        ends = routing.segment_ends[routing.segment_starts[k] : routing.segment_starts[k + 1]]
        degrees = np.bincount(ends.ravel())
        assert (degrees[: len(net)] == 1).all()
        assert (degrees[len(net) : 2 * len(net) - 2] == 3).all()
        assert (degrees[2 * len(net) - 2 :] == 2).all()


@pytest.mark.parametrize("nets", NETS)
def test_segments_meet_with_their_joins_tangent(nets: list[list[int]]) -> None:
    routing = routed(nets)
    for k, net in enumerate(nets):
        first = routing.join_starts[k]
        for s in range(routing.segment_starts[k], routing.segment_starts[k + 1]):
            curve = routing.control_points[s]
            for end, at, along in (
                (routing.segment_ends[s, 0], curve[0], curve[1] - curve[0]),
                (routing.segment_ends[s, 1], curve[3], curve[3] - curve[2]),
            ):
                heading = along / np.linalg.norm(along)
                if end < len(net):
                    assert abs(heading[0]) == pytest.approx(1.0)
                    continue
                join = first + end - len(net)
                assert at == pytest.approx(routing.join_positions[join])
                assert abs(heading @ routing.join_tangents[join]) == pytest.approx(1.0)


def test_level_ways_are_before_upright_ones() -> None:
    curves = routed([[0, 1, 2], [0, 2], [1, 2]]).control_points
    ways = curves[:, 3] - curves[:, 0]
    level = (np.abs(ways[:, 0]) > 0.0) & (np.abs(ways[:, 2]) == 0.0)
    upright = (ways[:, 0] == 0.0) & (np.abs(ways[:, 2]) > 0.0)
    assert level.any()
    assert upright.any()
    assert (curves[level][:, :, 1] == 0.0).all()
    assert (curves[upright][:, :, 1] > 0.0).all()
