from __future__ import annotations

import copy
from typing import Any

import numpy as np
import pytest

from app.hyperedges.pinches import find_pinches
from benchmarks.random_in_space import random_in_space
from benchmarks.random_programs import random_program
from tests.hyperedges.layouts import assert_clear, ids, laid, same

GROUND = random_program(40, 0, "local").document(routing="elastic")
SPACE = random_in_space(20, 0, "local").document(routing="elastic")


@pytest.mark.parametrize("document", [GROUND, SPACE], ids=["ground", "space"])
@pytest.mark.parametrize("number", [0, 11])
def test_one_hyperedge_more_leaves_others_as_they_are(
    document: dict[str, Any], number: int
) -> None:
    fewer = copy.deepcopy(document)
    del fewer["hyperedges"][number]
    before = laid(fewer)
    after = laid(document, before)
    assert_clear(after)
    assert len(find_pinches(after.routing).segments) == 0
    assert len(same(before, after)) >= len(fewer["hyperedges"]) - 4
    assert [hyperedge.id for hyperedge in after.program.hyperedges] == ids(document)


def test_one_hyperedge_less_leaves_all_others_as_they_are() -> None:
    before = laid(GROUND)
    fewer = copy.deepcopy(GROUND)
    del fewer["hyperedges"][5]
    assert same(before, laid(fewer, before)) == set(ids(fewer))


def test_an_item_dropped_into_a_tube_moves_that_tube() -> None:
    before = laid(GROUND)
    hit = int(np.flatnonzero(before.routing.attachment_counts > 2)[0])
    middle = before.routing.join_positions[before.routing.join_starts[hit]]
    dropped = copy.deepcopy(GROUND)
    dropped["items"].append(
        {
            "id": "dropped",
            "position": middle.tolist(),
            "shape": {"type": "box", "size": [0.3, 0.3, 0.3]},
        }
    )
    after = laid(dropped, before)
    assert_clear(after)
    assert ids(GROUND)[hit] not in same(before, after)
    assert len(same(before, after)) >= 30


def test_the_other_router_begins_anew() -> None:
    before = laid(GROUND)
    planes = {**GROUND, "layout": {**GROUND["layout"], "routing": "planes"}}
    assert same(before, laid(planes, before)) == same(before, laid(planes))
