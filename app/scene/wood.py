"""Polished wood, from its growth rings down to its pores."""

from __future__ import annotations

import numpy as np

from app.arrays import Floats, Singles
from app.scene.noise import noise

RINGS = 12
"""Growth rings across one texture."""

# Linear RGB that multiplies the wood's colour, where it grew in spring and in late summer, and in
# a pore. Late wood is darker and redder.
_EARLY = np.array([1.0, 1.0, 1.0], dtype=np.float32)
_LATE = np.array([0.40, 0.28, 0.19], dtype=np.float32)
_PORE = np.array([0.42, 0.34, 0.28], dtype=np.float32)

_SPRING = 0.16  # the share of a ring in which late wood ends


def wood(size: int) -> Singles:
    """Linear RGB (size, size, 3), not normalised: rings and fibres run along rows."""
    generator = np.random.default_rng(1873)
    phase = _phase(generator, size)
    ring = np.floor(phase).astype(np.int64) % RINGS
    place = phase - np.floor(phase)
    # Summer wood darkens slowly and ends at once: the next spring begins.
    strength = generator.uniform(0.4, 1.0, RINGS).astype(np.float32)[ring]
    late = np.where(place < 1 - _SPRING, (place / (1 - _SPRING)) ** 2.2, (1 - place) / _SPRING)
    fibres = (
        0.50 * noise(generator, size, size // 2, 9)
        + 0.45 * noise(generator, size, size // 4, 5)
        + 0.40 * noise(generator, size, size // 10, 3)
    )
    clouds = 0.7 * noise(generator, size, 4, 5) + 0.5 * noise(generator, size, 3, 11)
    darkness = np.clip(0.16 + 0.62 * late * strength + 0.105 * fibres + 0.05 * clouds, 0.0, 1.0)
    color = _EARLY + darkness[..., None] * (_LATE - _EARLY)
    pores = _pores(generator, size, place)
    color += pores[..., None] * (_PORE - color)
    return np.asarray(color, dtype=np.float32)


def _phase(generator: np.random.Generator, size: int) -> Floats:
    """Number of the ring, and how far through it: rings of unequal width, gently waving."""
    across = np.arange(size)[:, None] * (RINGS / size)
    widths = 0.35 * noise(generator, size, RINGS // 2, 1)
    waves = 0.36 * noise(generator, size, 3, 2) + 0.05 * noise(generator, size, 12, 7)
    return np.asarray(across + widths + waves, dtype=np.float64)


def _pores(generator: np.random.Generator, size: int, place: Floats) -> Singles:
    """How much of a pore there is: short dark dashes, most of them in early wood."""
    dashes = noise(generator, size, size // 2, size // 16)
    wanted = 1.5 + 1.3 * place
    return np.asarray(0.5 * np.clip((dashes - wanted) / 0.7, 0.0, 1.0), dtype=np.float32)
