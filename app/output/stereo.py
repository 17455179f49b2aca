"""Two eyes' pictures in one."""

from __future__ import annotations

import numpy as np
from PIL import Image

from app.arrays import Floats
from app.scene.color import linear_of, srgb_from_linear

LEFT = np.array([[0.437, 0.449, 0.164], [-0.062, -0.062, -0.024], [-0.048, -0.050, -0.017]])
RIGHT = np.array([[-0.011, -0.032, -0.007], [0.377, 0.761, 0.009], [-0.026, -0.093, 1.234]])
"""What each eye's linear RGB gives to the picture for red and cyan glasses: the projection that is
nearest, by least squares, to what both eyes should see (E. Dubois, "A projection method to generate
anaglyph stereo images", ICASSP 2001). Red things, which a plain swap of channels shows to one eye
alone, are seen by both."""


def side_by_side(left: Image.Image, right: Image.Image) -> Image.Image:
    """Both beside each other, the left eye's at the left."""
    both = Image.new(left.mode, (left.width + right.width, left.height))
    both.paste(left, (0, 0))
    both.paste(right, (left.width, 0))
    return both


def anaglyph(left: Image.Image, right: Image.Image) -> Image.Image:
    """One picture for glasses that are red at the left and cyan at the right.

    It is opaque where either eye sees something.
    """
    mixed = _linear(left) @ LEFT.T + _linear(right) @ RIGHT.T
    found = Image.fromarray(
        np.round(srgb_from_linear(np.clip(mixed, 0.0, 1.0)) * 255).astype(np.uint8)
    )
    if left.mode != "RGBA":
        return found
    opacity = np.maximum(np.asarray(left)[..., 3], np.asarray(right)[..., 3])
    found.putalpha(Image.fromarray(opacity))
    return found


def _linear(picture: Image.Image) -> Floats:
    return linear_of(np.asarray(picture.convert("RGB"), dtype=np.float64) / 255)
