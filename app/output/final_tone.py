"""From light to pixels: what is white, what is brighter, and where the ground ends."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from app.arrays import Floats, Singles
from app.scene.color import srgb_from_linear

UNSHADED = (0.9, 0.985)
"""Light on the ground, of what falls where nothing stands: between these it melts into the
background, and noise and the faintest shades with it."""

LEVELS = 1 << 14
"""Of linear light, evenly spaced in its square root: no step of sRGB is lost."""


def melted(light: Singles, bare: Singles, background: Floats) -> Singles:
    """The same picture (height, width, 3), whose ground is the ``background`` (3,) where it can.

    ``bare`` (height, width) is how much of each pixel shows the ground.
    """
    share = light.max(axis=2) / max(float(background.max()), 1e-3)
    low, high = UNSHADED
    rise = np.clip((share - low) / (high - low), 0.0, 1.0)
    # Only what is all ground: in the pixels of an edge the thing's own brightness would count.
    rise *= rise * (3.0 - 2.0 * rise) * (bare >= 1.0)
    return np.asarray(light + rise[..., None] * (background.astype(np.float32) - light))


def pixels(light: Singles) -> NDArray[np.uint8]:
    """Linear light as sRGB, both (height, width, 3); what is brighter than white pales toward it.

    >>> pixels(np.array([[[1, 1, 1], [2, 0.5, 0.5]]], dtype=np.float32)).tolist()
    [[[255, 255, 255], [255, 177, 177]]]
    """
    brightest = np.maximum(light.max(axis=2, keepdims=True), 1.0)
    paled = light / brightest
    # Twice as bright as white is a quarter of the way from a pure hue to white.
    paled += (1.0 - paled) * (1.0 - 1.0 / brightest) * 0.5
    steps = np.sqrt(np.clip(paled, 0.0, 1.0)) * (LEVELS - 1)
    return np.asarray(_SRGB[np.round(steps).astype(np.int32)])


def on_nothing(picture: NDArray[np.uint8], covered: Singles) -> NDArray[np.uint8]:
    """A picture drawn on white (height, width, 3) as RGBA, so that it looks the same on white.

    What is ``covered`` (height, width) hides what it is laid on; the rest are shadows.
    """
    seen = picture.astype(np.float32) / 255.0
    opacity = np.maximum(1.0 - seen.min(axis=2), np.clip(covered, 0.0, 1.0))
    opacity = np.round(opacity * 255.0) / 255.0
    own = 1.0 - (1.0 - seen) / np.maximum(opacity, 1e-6)[..., None]
    found = np.empty((*opacity.shape, 4), np.uint8)
    found[..., :3] = np.round(np.clip(own, 0.0, 1.0) * 255.0)
    found[..., 3] = np.round(opacity * 255.0)
    found[opacity == 0.0] = 0
    return found


def _srgb_levels() -> NDArray[np.uint8]:
    linear = (np.arange(LEVELS) / (LEVELS - 1)) ** 2
    return np.round(srgb_from_linear(linear) * 255).astype(np.uint8)


_SRGB = _srgb_levels()
