"""Textures of wood and stone: pictures that repeat in both directions, made once.

A texture is multiplied by a material's colour. Being no brighter than white, it would darken that
colour; so its mean is `MEAN` in linear light, and `tint` gives the colour to multiply it by.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from app.arrays import Singles
from app.scene.color import srgb_from_linear
from app.scene.scene import TextureName
from app.scene.stone import stone
from app.scene.wood import wood

SIZE = 512
"""Rows and columns of a texture."""

MEAN = 0.75
"""Of a texture, in each channel and in linear light."""


_LEVELS = 4095  # of linear light: the darkest steps of sRGB are about so fine


@lru_cache(maxsize=2)
def texture(name: TextureName) -> NDArray[np.uint8]:
    """Colours (SIZE, SIZE, 3) in sRGB, read-only; the same array each time.

    Rows run along u of `app.solids.mesh.Mesh.coordinates` and the first is at v = 0, as in glTF.
    """
    linear = wood(SIZE) if name == "wood" else stone(SIZE)
    found = _encoded(linear * (MEAN / linear.mean(axis=(0, 1))))
    found.flags.writeable = False
    return found


def tint(color: tuple[float, float, float]) -> tuple[float, float, float]:
    """What to multiply a texture by so that its mean is ``color``, both linear.

    Colours too bright for that keep their hue, and get as bright as they can.

    >>> tint((0.375, 0.1875, 0.0))
    (0.5, 0.25, 0.0)
    >>> tint((1.0, 0.5, 0.0))
    (1.0, 0.5, 0.0)
    """
    factor = min(1 / MEAN, 1 / max(*color, MEAN))
    red, green, blue = color
    return red * factor, green * factor, blue * factor


def _encoded(linear: Singles) -> NDArray[np.uint8]:
    """Linear light (…) as sRGB in 255ths."""
    levels = np.arange(_LEVELS + 1) / _LEVELS
    table = np.round(255 * srgb_from_linear(levels)).astype(np.uint8)
    steps = np.clip(linear * _LEVELS + 0.5, 0, _LEVELS).astype(np.int64)
    return np.asarray(table[steps])
