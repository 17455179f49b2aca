"""Two eyes' pictures as one."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from app.arrays import Singles

# Linear sRGB of the anaglyph from that of the left and of the right picture. These come nearest
# (least squares over what each eye sees of the colours) through common glasses on common screens:
# E. Dubois, A projection method to generate anaglyph stereo images, ICASSP 2001; the figures are of
# his Conversion of a stereo pair to anaglyph with the least-squares projection method, 2009. There
# each eye's part is clipped before they are added; that would tint what is grey by up to 13 shades.
_LEFT = np.array(
    [[0.437, 0.449, 0.164], [-0.062, -0.062, -0.024], [-0.048, -0.050, -0.017]], dtype=np.float32
)
_RIGHT = np.array(
    [[-0.011, -0.032, -0.007], [0.377, 0.761, 0.009], [-0.026, -0.093, 1.234]], dtype=np.float32
)

PIXELS_AT_ONCE = 1 << 18
"""Joined at once: it takes some 60 bytes for each."""

_STEPS = 4095
"""Of linear light, to look sRGB up in: black is less than half a shade off."""


def side_by_side(left: Image.Image, right: Image.Image) -> Image.Image:
    """Both pictures, of one size, the left eye's on the left: for who looks straight ahead."""
    joined = Image.new(left.mode, (left.width + right.width, left.height))
    joined.paste(left, (0, 0))
    joined.paste(right, (left.width, 0))
    return joined


def anaglyph(left: Image.Image, right: Image.Image) -> Image.Image:
    """Both pictures, of one size, in one: for glasses that are red on the left, cyan on the right.

    Colours stay as far apart as glasses allow (Dubois): taking red from the one picture and the
    rest from the other would show a red tube to one eye alone, and a blue one to the other.
    Where one of the pictures is transparent, the other is seen.
    """
    ours, theirs = np.asarray(left), np.asarray(right)
    joined = np.empty_like(ours)
    rows = max(PIXELS_AT_ONCE // left.width, 1)
    for top in range(0, left.height, rows):
        part = slice(top, top + rows)
        joined[part] = _joined(ours[part], theirs[part])
    return Image.fromarray(joined, left.mode)


def _joined(left: NDArray[np.uint8], right: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """Rows of both pictures, (h, w, 3) or with opacity (h, w, 4), in one."""
    light = _seen(left, _LEFT) + _seen(right, _RIGHT)
    if left.shape[2] == 3:
        return _encoded(light)
    opacity = np.maximum(left[..., 3], right[..., 3])
    light /= np.maximum(opacity, 1)[..., None] / np.float32(255)
    return np.dstack([_encoded(light), opacity])


def _seen(pixels: NDArray[np.uint8], eye: Singles) -> Singles:
    """What of the light is for an eye, times its opacity: (h, w, 3), linear."""
    light = _LINEAR[pixels[..., :3]]
    if pixels.shape[2] == 4:
        light *= pixels[..., 3:] / np.float32(255)
    seen: Singles = light @ eye.T
    return seen


def _encoded(light: Singles) -> NDArray[np.uint8]:
    return _SRGB[np.round(np.clip(light, 0.0, 1.0) * _STEPS).astype(np.int16)]


def _linear_table() -> Singles:
    srgb = np.arange(256) / 255
    linear = np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)
    return linear.astype(np.float32)


def _srgb_table() -> NDArray[np.uint8]:
    linear = np.arange(_STEPS + 1) / _STEPS
    srgb = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
    return np.round(srgb * 255).astype(np.uint8)


_LINEAR, _SRGB = _linear_table(), _srgb_table()
