from __future__ import annotations

import copy

import numpy as np

from benchmarks.random_programs import random_program
from tests.hyperedges.layouts import assert_clear, ids, laid, same

DOCUMENT = random_program(40, 0, "local").document()


def test_one_hyperedge_more_leaves_the_others_as_they_are() -> None:
    fewer = copy.deepcopy(DOCUMENT)
    del fewer["hyperedges"][17]
    before = laid(fewer)
    after = laid(DOCUMENT, before)
    assert_clear(after)
    assert len(same(before, after)) >= 20, "only those that are in its way move"
    assert [hyperedge.id for hyperedge in after.program.hyperedges] == ids(DOCUMENT)
    counts = [len(hyperedge.attachments) for hyperedge in after.program.hyperedges]
    assert after.routing.attachment_counts.tolist() == counts


def test_one_hyperedge_less_leaves_all_others_as_they_are() -> None:
    before = laid(DOCUMENT)
    fewer = copy.deepcopy(DOCUMENT)
    del fewer["hyperedges"][5]
    after = laid(fewer, before)
    assert same(before, after) == set(ids(fewer))


def test_nothing_new_changes_nothing() -> None:
    before = laid(DOCUMENT)
    after = laid(DOCUMENT, before)
    assert same(before, after) == set(ids(DOCUMENT))
    np.testing.assert_array_equal(before.routing.join_tangents, after.routing.join_tangents)


def test_only_what_attaches_to_a_moved_item_moves() -> None:
    before = laid(DOCUMENT)
    moved = copy.deepcopy(DOCUMENT)
    item = moved["items"][3]
    item["position"][2] += 0.05
    after = laid(moved, before)
    attached = {
        hyperedge["id"]
        for hyperedge in moved["hyperedges"]
        if any(end["item"] == item["id"] for end in hyperedge["attachments"])
    }
    still = same(before, after)
    assert not still & attached
    assert len(still) >= len(ids(moved)) - len(attached) - 2


def test_an_item_dropped_into_a_tube_moves_that_tube() -> None:
    before = laid(DOCUMENT)
    hit = int(np.flatnonzero(before.routing.attachment_counts > 2)[0])
    middle = before.routing.join_positions[before.routing.join_starts[hit]]
    dropped = copy.deepcopy(DOCUMENT)
    dropped["items"].append(
        {
            "id": "dropped",
            "position": middle.tolist(),
            "shape": {"type": "box", "size": [0.3, 0.3, 0.3]},
        }
    )
    after = laid(dropped, before)
    assert_clear(after)
    assert ids(DOCUMENT)[hit] not in same(before, after)
    assert len(same(before, after)) >= 20


def test_other_wishes_for_the_layout_begin_anew() -> None:
    before = laid(DOCUMENT)
    wider = {**DOCUMENT, "layout": {**DOCUMENT.get("layout", {}), "clearance": 0.08}}
    assert same(before, laid(wider, before)) == same(before, laid(wider))
