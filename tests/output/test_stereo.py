from __future__ import annotations

import itertools

import numpy as np
import pytest
from colorspacious import cspace_convert
from numpy.typing import NDArray
from PIL import Image

from app.output.stereo import anaglyph, side_by_side
from app.scene.palette import palette

Values = NDArray[np.float64]


def patch(*colors: tuple[int, ...]) -> Image.Image:
    """One pixel of each colour."""
    pixels = np.array([colors], dtype=np.uint8)
    return Image.fromarray(pixels)


def values(picture: Image.Image) -> Values:
    found: Values = np.asarray(picture, dtype=np.float64)[0]
    return found


def lightness_by_eye(srgb: Values) -> tuple[Values, Values]:
    """CIE L* of what red and cyan glasses let through, white being 100 for each eye."""
    linear = np.where(srgb <= 10.3, srgb / 255 / 12.92, ((srgb / 255 + 0.055) / 1.055) ** 2.4)
    left, right = linear[:, 0], (linear[:, 1:] @ [0.7152, 0.0722]) / 0.7874
    return 116 * np.cbrt(left) - 16, 116 * np.cbrt(right) - 16


def usual_colors() -> Image.Image:
    colors = palette("glasbey").colors[:10]
    return patch(*(tuple(bytes.fromhex(color[1:])) for color in colors))


def test_side_by_side_has_the_left_eye_on_the_left() -> None:
    joined = side_by_side(patch((255, 0, 0)), patch((0, 0, 255)))
    assert joined.size == (2, 1)
    assert values(joined).tolist() == [[255, 0, 0], [0, 0, 255]]


def test_each_eye_sees_its_picture_and_hardly_the_other() -> None:
    black, white = patch((0, 0, 0)), patch((255, 255, 255))
    red, cyan = values(anaglyph(white, black))[0], values(anaglyph(black, white))[0]
    assert red[0] > 250
    assert red[1:].max() < 1
    assert cyan[1:].min() > 250
    assert cyan[0] < 1


@pytest.mark.parametrize("grey", [0, 1, 40, 128, 200, 254, 255])
def test_grey_stays_grey(grey: int) -> None:
    picture = patch((grey, grey, grey))
    assert np.abs(values(anaglyph(picture, picture)) - grey).max() <= 2


def test_the_palettes_colours_are_as_light_to_one_eye_as_to_the_other() -> None:
    picture = usual_colors()
    left, right = lightness_by_eye(values(anaglyph(picture, picture)))
    assert np.abs(left - right).mean() < 5
    # As they are, they would not be.
    left, right = lightness_by_eye(values(picture))
    assert np.abs(left - right).mean() > 20


def test_the_palettes_colours_stay_apart() -> None:
    picture = usual_colors()
    seen = cspace_convert(values(anaglyph(picture, picture)) / 255, "sRGB1", "CAM02-UCS")
    apart = [np.linalg.norm(one - other) for one, other in itertools.combinations(seen, 2)]
    assert min(apart) > 10


def test_transparent_is_what_both_leave_transparent() -> None:
    left = patch((0, 0, 0, 0), (90, 90, 90, 255), (0, 0, 0, 0))
    right = patch((0, 0, 0, 0), (90, 90, 90, 255), (200, 200, 200, 255))
    found = values(anaglyph(left, right))
    assert found[:, 3].tolist() == [0, 255, 255]
    assert found[1, :3] == pytest.approx([90, 90, 90], abs=2)
    assert found[2, 0] < 1
    assert found[2, 2] > 190


def test_half_transparent_keeps_its_colour() -> None:
    picture = patch((120, 120, 120, 128))
    assert values(anaglyph(picture, picture))[0] == pytest.approx([120, 120, 120, 128], abs=2)
