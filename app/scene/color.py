"""Colours: as documents write them (sRGB), as light adds up (linear), as eyes compare (Oklab)."""

from __future__ import annotations

import numpy as np

from app.arrays import Floats

# Björn Ottosson (2020), "A perceptual color space for image processing".
_TO_CONES = np.array(
    [
        [0.4122214708, 0.5363325363, 0.0514459929],
        [0.2119034982, 0.6806995451, 0.1073969566],
        [0.0883024619, 0.2817188376, 0.6299787005],
    ]
)
_TO_OKLAB = np.array(
    [
        [0.2104542553, 0.7936177850, -0.0040720468],
        [1.9779984951, -2.4285922050, 0.4505937099],
        [0.0259040371, 0.7827717662, -0.8086757660],
    ]
)
_FROM_CONES = np.linalg.inv(_TO_CONES)
_FROM_OKLAB = np.linalg.inv(_TO_OKLAB)


def srgb_of(color: str) -> Floats:
    """The colour ``#rgb`` or ``#rrggbb`` as sRGB (3,), 0 to 1.

    >>> srgb_of("#f80").round(3).tolist()
    [1.0, 0.533, 0.0]
    """
    digits = color.removeprefix("#")
    if len(digits) == 3:
        digits = "".join(digit * 2 for digit in digits)
    return np.frombuffer(bytes.fromhex(digits), dtype=np.uint8) / 255.0


def hex_of(srgb: Floats) -> str:
    """The nearest colour ``#rrggbb`` to sRGB (3,).

    >>> hex_of(srgb_of("#48c"))
    '#4488cc'
    """
    return hexes_of(srgb)[0]


def hexes_of(srgb: Floats) -> list[str]:
    """The nearest colours ``#rrggbb`` to sRGB (n, 3)."""
    digits = np.round(np.clip(srgb, 0, 1) * 255).astype(np.uint8).tobytes().hex()
    return [f"#{digits[start : start + 6]}" for start in range(0, len(digits), 6)]


def linear_of(srgb: Floats) -> Floats:
    """Linear RGB of sRGB, both (…, 3) and 0 to 1 (IEC 61966-2-1)."""
    return np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)


def srgb_from_linear(linear: Floats) -> Floats:
    """Colours in sRGB of linear RGB, both (…, 3) and 0 to 1."""
    above = np.maximum(linear, 0.0031308)
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * above ** (1 / 2.4) - 0.055)


def oklab_of(srgb: Floats) -> Floats:
    """Oklab (…, 3) of sRGB (…, 3): lightness 0 to 1, and two axes of hue.

    Distances in it are about as large as they seem.

    >>> oklab_of(srgb_of("#ffffff")).round(6).tolist()[0]
    1.0
    """
    return np.asarray(np.cbrt(linear_of(srgb) @ _TO_CONES.T) @ _TO_OKLAB.T)


def srgb_from_oklab(oklab: Floats) -> Floats:
    """Colours in sRGB (…, 3) of Oklab (…, 3), clipped to what a screen can show."""
    linear = (oklab @ _FROM_OKLAB.T) ** 3 @ _FROM_CONES.T
    return srgb_from_linear(np.clip(linear, 0, 1))


def difference(one: Floats, other: Floats) -> Floats:
    """How different sRGB colours (…, 3) look: their distance in Oklab, (…).

    >>> round(float(difference(srgb_of("#000"), srgb_of("#fff"))), 6)
    1.0
    """
    return np.asarray(np.linalg.norm(oklab_of(one) - oklab_of(other), axis=-1))
