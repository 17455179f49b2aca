"""Hyperedges between items that are placed by stress."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from app.layout import judge, lay_out
from app.program.model import Program


def random_document(items: int, hyperedges: int, mode: str, seed: int) -> dict[str, Any]:
    """Blocks and balls with labels; hyperedges of two to six of them."""
    chance = np.random.default_rng(seed)
    joined = [chance.choice(items, int(chance.integers(2, 7)), False) for _ in range(hyperedges)]
    balls = {"shape": {"type": "sphere"}}
    return {
        "items": [
            {"id": f"i{k}", "label": f"n{k}"} | (balls if k % 2 else {}) for k in range(items)
        ],
        "hyperedges": [
            {"id": f"h{k}", "attachments": [{"item": f"i{item}"} for item in each]}
            for k, each in enumerate(joined)
        ],
        "layout": {"placement": mode},
    }


@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize("mode", ["ground", "sheet", "space"])
def test_random_hypergraphs_are_certified(mode: str, seed: int) -> None:
    made = lay_out(Program.model_validate(random_document(20, 16, mode, seed)))
    verdict = judge(made)
    assert verdict is not None
    assert verdict.certificate.certified
    assert len(verdict.pinches.segments) == 0


def test_tubes_pass_before_and_behind_a_sheet() -> None:
    made = lay_out(Program.model_validate(random_document(20, 16, "sheet", 5)))
    depths = made.routing.control_points[:, :, 1]
    assert depths.min() < -0.3
    assert depths.max() > 0.3


@pytest.mark.parametrize("mode", ["ground", "sheet", "space"])
def test_an_edit_moves_no_item_and_few_hyperedges(mode: str) -> None:
    document = random_document(20, 16, mode, 3)
    before = lay_out(Program.model_validate(document))
    document["items"].append({"id": "new"})
    ends = [{"item": "new"}, {"item": "i4"}]
    document["hyperedges"].append({"id": "n", "attachments": ends})
    after = lay_out(Program.model_validate(document), before)
    assert (after.placement.centers[:20] == before.placement.centers).all()
    same = 0
    for number in range(16):
        old, new = (made.routing.part(np.array([number])) for made in (before, after))
        same += np.array_equal(old.control_points, new.control_points)
    assert same >= 10
    verdict = judge(after)
    assert verdict is not None
    assert verdict.certificate.certified
