from __future__ import annotations

import numpy as np
import pytest

from app.notations.loader import load_notation
from app.scene.color import hexes_of, srgb_of
from app.scene.hyperedge_colors import background_of, hyperedge_colors
from app.scene.palette import palette
from tests.scene.hand_built import program_of, three_items

PALETTE = palette("glasbey").colors


def test_colours_are_as_drawn_and_follow_the_hues() -> None:
    program = three_items()
    notation = load_notation(program.notation)
    assert hexes_of(hyperedge_colors(program, notation, None)) == list(PALETTE[:2])
    hues = np.array([4, 1])
    chosen = hyperedge_colors(program, notation, None, hues)
    assert hexes_of(chosen) == [PALETTE[4], PALETTE[1]]


def test_a_program_without_hyperedges_has_no_colours() -> None:
    program = program_of(items=[{"id": "x"}])
    chosen = hyperedge_colors(program, load_notation(program.notation), None)
    assert chosen.shape == (0, 3)
    assert hexes_of(chosen) == []


def test_a_transparent_background_is_none() -> None:
    assert background_of(three_items(style={"background": "transparent"})) is None
    given = background_of(three_items(style={"background": "#e69f00"}))
    assert given == pytest.approx(srgb_of("#e69f00"))
