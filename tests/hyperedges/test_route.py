from dataclasses import replace

import numpy as np
import pytest

from app.hyperedges.route import route
from app.notations.loader import load_notation
from app.placement.place import place
from app.placement.placement import Placement
from app.program.model import Program


@pytest.fixture
def placement() -> Placement:
    program = Program.model_validate(
        {
            "items": [{"id": name} for name in "abcdef"],
            "hyperedges": [
                {"id": "x", "attachments": [{"item": name} for name in "abcd"]},
                {"id": "y", "attachments": [{"item": name} for name in "ef"]},
            ],
        }
    )
    return place(program, load_notation("plain"))


def test_segments_and_joins_of_each_hyperedge_lie_together(placement: Placement) -> None:
    routing = route(placement)
    assert routing.segment_starts.tolist() == [0, 5, 6]
    assert routing.join_starts.tolist() == [0, 2, 2]
    assert routing.control_points.shape == (6, 4, 3)


def test_a_join_height_of_the_document_is_kept(placement: Placement) -> None:
    routing = route(placement, join_heights=np.array([7.0, np.nan]))
    assert routing.join_planes[0] == 7.0
    assert (routing.join_positions[:, 2] == 7.0).all()
    assert routing.join_planes[1] == route(placement).join_planes[1]


def test_best_fidelity_leaves_items_squarely_and_paper_does_not(placement: Placement) -> None:
    best = route(placement).control_points[0]
    paper = route(placement, fidelity="paper").control_points[0]
    assert (best[1, :2] == best[0, :2]).all()
    assert (paper[1, :2] != paper[0, :2]).any()


def test_the_same_placement_gives_the_same_bytes(placement: Placement) -> None:
    again = replace(placement)
    assert route(placement).control_points.tobytes() == route(again).control_points.tobytes()
