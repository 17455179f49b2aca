"""The typefaces that labels are set in, from installed packages: the same on every machine."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from types import MappingProxyType

import fontpkg
import uharfbuzz as hb

WEIGHT = 600
"""Semi-bold: thin strokes are lost first when letters are small or seen at an angle."""

FEATURES: Mapping[str, Mapping[str, bool]] = MappingProxyType(
    {
        # Inter's contextual alternates turn -> into an arrow and 4x4 into a product; a label must
        # read as it was written. Its fifth variant is an l with a tail, unlike I and 1.
        "inter": MappingProxyType({"calt": False, "cv05": True}),
        "noto-sans": MappingProxyType({}),
        "fira-code": MappingProxyType({"calt": False}),
    }
)
"""Families in the order in which they are asked for a character, with their OpenType features."""


@dataclass(frozen=True, slots=True, eq=False)
class Typeface:
    """A font at its weight: ``coverage`` are its characters, ``capital`` is the height of its H.

    ``capital`` is in the font's own units. Letters of every typeface are scaled to capitals of the
    same height, so that a character from another font does not stand out.
    """

    name: str
    font: hb.Font
    coverage: frozenset[int]
    capital: float
    features: Mapping[str, bool]


@lru_cache(maxsize=1)
def typefaces() -> tuple[Typeface, ...]:
    """All typefaces; the first that has a character shows it. Raises `fontpkg.FontpkgError`."""
    return tuple(_load(name, features) for name, features in FEATURES.items())


def _load(name: str, features: Mapping[str, bool]) -> Typeface:
    blob = hb.Blob.from_file_path(str(fontpkg.path(name, weight=WEIGHT)))
    face = hb.Face(blob)
    font = hb.Font(face)
    font.set_variations({"wght": WEIGHT})
    capital = font.get_glyph_extents(font.get_nominal_glyph(ord("H"))).y_bearing
    return Typeface(name, font, frozenset(face.unicodes), float(capital), features)
