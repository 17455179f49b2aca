from __future__ import annotations

import numpy as np
import pytest
from colorspacious import cspace_convert

from app.arrays import Floats
from app.errors import UnknownName
from app.scene.color import difference, hex_of, srgb_of
from app.scene.palette import VANISHING, colors, palette, palette_names, palettes
from tools.palettes import glasbey_colors

BACKGROUNDS = ("#ffffff", "#000000", "#111827", "#f3f0e8", "#808080", "#4c7ddd")


def smallest_distance(srgb: Floats, vision: str | None) -> float:
    """Between any two of the colours (c, 3), as seen by someone, in CAM02-UCS."""
    if vision is not None:
        space = {"name": "sRGB1+CVD", "cvd_type": vision, "severity": 100}
        srgb = np.clip(cspace_convert(srgb, space, "sRGB1"), 0, 1)
    places = cspace_convert(srgb, "sRGB1", "CAM02-UCS")
    one, other = np.triu_indices(len(places), 1)
    return float(np.linalg.norm(places[one] - places[other], axis=1).min())


def test_the_default_palette_comes_first() -> None:
    assert palette_names()[0] == "glasbey"
    assert all(entry.title and entry.description for entry in palettes())


def test_the_file_is_what_the_tool_computes() -> None:
    count = 40
    assert palette("glasbey").colors[:count] == tuple(glasbey_colors(count))


@pytest.mark.parametrize(
    ("count", "vision", "least"),
    [
        # 10 is a glance's difference; names of distinct colours are some 20 apart.
        (8, None, 24),
        (8, "deuteranomaly", 12),
        (8, "protanomaly", 19),
        (8, "tritanomaly", 8),
        (16, None, 17),
        (16, "deuteranomaly", 10),
        (16, "protanomaly", 10),
        (256, None, 3.4),
        (256, "deuteranomaly", 1.9),
        (256, "protanomaly", 1.9),
    ],
)
def test_everybody_can_tell_the_first_colours_apart(
    count: int, vision: str | None, least: float
) -> None:
    assert smallest_distance(colors("glasbey", count, None), vision) >= least


@pytest.mark.parametrize("background", BACKGROUNDS)
@pytest.mark.parametrize("name", palette_names())
def test_no_colour_vanishes_on_the_background(name: str, background: str) -> None:
    found = colors(name, 600, srgb_of(background))
    assert found.shape == (600, 3)
    assert float(difference(found, srgb_of(background)).min()) >= VANISHING


def test_yellow_vanishes_on_white_and_black_on_black() -> None:
    white = {hex_of(color) for color in colors("okabe-ito", 7, srgb_of("#ffffff"))}
    black = {hex_of(color) for color in colors("okabe-ito", 7, srgb_of("#000000"))}
    everything = set(palette("okabe-ito").colors)
    assert everything - white == {"#f0e442"}
    assert everything - black == {"#000000"}


def test_the_first_colours_do_not_depend_on_how_many_there_are() -> None:
    white = srgb_of("#ffffff")
    assert np.array_equal(colors("glasbey", 5000, white)[:9], colors("glasbey", 9, white))


def test_every_hyperedge_of_a_large_program_has_its_own_colour() -> None:
    found = colors("glasbey", 2000, srgb_of("#ffffff"))
    assert len(np.unique(found, axis=0)) == 2000


def test_further_colours_are_the_first_ones_lighter_and_darker() -> None:
    first, darker, lighter = colors("okabe-ito", 24, None).reshape(3, 8, 3)[:, :7]
    assert (darker.sum(axis=1) < first.sum(axis=1)).all()
    assert (lighter.sum(axis=1) > first.sum(axis=1)).all()


def test_no_hyperedges_need_no_colours() -> None:
    assert colors("glasbey", 0, srgb_of("#ffffff")).shape == (0, 3)


def test_an_unknown_palette_is_named_with_those_that_are_known() -> None:
    with pytest.raises(UnknownName, match="no palette 'rainbow'; known are glasbey, okabe-ito"):
        colors("rainbow", 3, None)
