"""Palettes: every hyperedge its own colour, in the order of the document."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache
from importlib.resources import files

import numpy as np

from app.arrays import Floats
from app.errors import UnknownName
from app.scene.color import difference, oklab_of, srgb_from_oklab, srgb_of

VANISHING = 0.22
"""Difference (in Oklab) to the background below which a colour is left out: on white it takes
pale yellows and lavenders, and leaves the sky blue and the amber of our palettes."""

SPREAD = 0.3
"""How far lightness (in Oklab) is varied where there are more hyperedges than colours."""


@dataclass(frozen=True, slots=True)
class Palette:
    """Named colours (``#rrggbb``), those that should be used first in front."""

    name: str
    title: str
    description: str
    colors: tuple[str, ...]


@lru_cache(maxsize=1)
def palettes() -> tuple[Palette, ...]:
    """All palettes, the default one first. `tools/palettes.py` computes them."""
    found = json.loads(files("app.scene").joinpath("palettes.json").read_text(encoding="utf-8"))
    return tuple(Palette(**{**entry, "colors": tuple(entry["colors"])}) for entry in found)


def palette_names() -> tuple[str, ...]:
    """The names of all palettes, the default one first."""
    return tuple(palette.name for palette in palettes())


def palette(name: str) -> Palette:
    """The palette called ``name``. Raises `UnknownName` where there is none."""
    for candidate in palettes():
        if candidate.name == name:
            return candidate
    raise UnknownName("palette", name, palette_names())


def colors(name: str, count: int, background: Floats | None) -> Floats:
    """The first ``count`` colours of a palette, sRGB (count, 3), none that vanishes.

    ``background`` is sRGB (3,), or ``None`` where it is not known. Where there are not enough
    colours the palette comes again and again, lighter or darker each time. The first colours
    are the same whatever the count. Raises `UnknownName` for an unknown palette.
    """
    blocks: list[Floats] = []
    found = 0
    for block in _rounds(_base(name)):
        kept = block if background is None else block[difference(block, background) >= VANISHING]
        blocks.append(kept)
        found += len(kept)
        if found >= count:
            break
    return np.concatenate(blocks)[:count]


@lru_cache(maxsize=16)
def _base(name: str) -> Floats:
    base = np.array([srgb_of(color) for color in palette(name).colors])
    base.flags.writeable = False
    return base


def _rounds(base: Floats) -> Iterator[Floats]:
    """The palette (p, 3), and then variations of it without end."""
    yield base
    oklab = oklab_of(base)
    number = 1
    while True:
        shifted = oklab.copy()
        shifted[:, 0] = np.clip(oklab[:, 0] + _shift(number), 0.2, 0.95)
        # As documents write colours: nobody sees the difference, and names stay true.
        yield np.round(srgb_from_oklab(shifted) * 255) / 255
        number += 1


def _shift(number: int) -> float:
    """A lightness for each round, far from those before: van der Corput's sequence in base 2."""
    share, digit = 0.0, 0.5
    rest = number + 1  # its first member is one half, which would be no shift
    while rest:
        share += digit * (rest & 1)
        rest >>= 1
        digit /= 2
    return SPREAD * (share - 0.5)
