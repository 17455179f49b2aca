"""Heights of items around each place."""

from __future__ import annotations

import numpy as np
import pytest

from app.output.draft_heights import TEXELS, Heights, heights
from app.output.draft_scene import Normalization, draft_scene
from app.scene.scene import Scene
from tests.output.scenes import box, matte, node, scene


def around(shown: Scene) -> tuple[Heights, Normalization]:
    move = Normalization.of(shown)
    found = heights(draft_scene(shown, move))
    assert found is not None
    return found, move


def at(found: Heights, move: Normalization, x: float, y: float) -> np.ndarray:
    """Heights, near and wide, over a place of the document, in its units."""
    place = found.matrix[:2] @ [*move.points(np.array([x, y, 0.0])), 1.0]
    column, row = np.clip((place * TEXELS).astype(int), 0, TEXELS - 1)
    return np.asarray(found.values[row, column] * move.size + move.center[2])


def test_over_a_broad_item_they_are_its_own_and_far_away_the_ground() -> None:
    wide = node("wide", box(4, 2, 1), 0, (0.0, 0.0, 0.5))
    found, move = around(scene([wide], [matte("#ffffff")]))
    np.testing.assert_allclose(at(found, move, 0, 0), 1.0, atol=0.1)
    np.testing.assert_allclose(at(found, move, 3.7, 0), 0.0, atol=0.02)
    near, far = at(found, move, 2.3, 0)
    assert 0.0 < near < far < 0.5


def test_x_and_y_are_not_mixed_up() -> None:
    items = [
        node("low", box(1, 1, 1), 0, (0.0, 0.0, 0.5)),
        node("high", box(1, 1, 3), 0, (0.0, 4.0, 1.5)),
    ]
    found, move = around(scene(items, [matte("#ffffff")]))
    assert at(found, move, 0, 4)[0] == pytest.approx(3.0, abs=0.3)
    assert at(found, move, 0, 0)[0] == pytest.approx(1.0, abs=0.2)


def test_without_items_there_are_none() -> None:
    tube = node("tube", box(1, 1, 1), 0, shows="hyperedge")
    shown = scene([tube], [matte("#ffffff")])
    assert heights(draft_scene(shown, Normalization.of(shown))) is None


def test_what_stands_one_above_another_darkens_nothing() -> None:
    items = [
        node(f"{x} {z}", box(1, 0.5, 1), 0, (2.0 * x, 0.0, 2.0 * z))
        for x in range(4)
        for z in range(4)
    ]
    shown = scene(items, [matte("#ffffff")])
    assert heights(draft_scene(shown, Normalization.of(shown))) is None
