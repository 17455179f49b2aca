"""Labels as letters in a row: which glyph of which typeface stands where."""

from __future__ import annotations

import unicodedata
from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache
from itertools import groupby

import numpy as np
import uharfbuzz as hb

from app.arrays import Floats, Indices
from app.solids.fonts import Typeface, typefaces
from app.solids.glyphs import glyph

BOX = "\N{WHITE SQUARE}"
"""Stands for a character that no typeface has."""

LONGEST_KEPT = 256
"""Characters. Longer labels are laid out anew each time, so that the cache stays small."""

LONGEST_CLUSTER = 32
"""A character and its marks; more are set as if they followed. Composing takes time by the square
of their number, and HarfBuzz orders no more than these either."""


@dataclass(frozen=True, slots=True)
class TextExtent:
    """The box of a label's ink, its baseline being 0; all zero where nothing is to be seen."""

    width: float
    top: float
    bottom: float


@dataclass(frozen=True, slots=True, eq=False)
class Lettering:
    """The g glyphs of a label that have ink, in heights of a capital.

    ``typefaces`` (g,) are places in `app.solids.fonts.typefaces`, ``glyphs`` (g,) numbers in
    these; ``origins`` (g, 2) are where they stand, the first near 0 on the baseline. ``bounds``
    (2, 2) are the lowest and highest x and y of the ink, zeros where there is none.
    """

    typefaces: Indices
    glyphs: Indices
    origins: Floats
    bounds: Floats


def extent(text: str, height: float) -> TextExtent:
    """How much room ``text`` takes where a capital letter is ``height`` high.

    Any string will do: line breaks and tabs are blanks, other control characters nothing, and a
    character that no typeface has is a box.

    >>> extent("H", 2.0).top
    2.0
    >>> extent(" ", 2.0)
    TextExtent(width=0.0, top=0.0, bottom=0.0)
    """
    (left, bottom), (right, top) = (lettering(text).bounds * height).tolist()
    return TextExtent(width=right - left, top=top, bottom=bottom)


def lettering(text: str) -> Lettering:
    """``text`` as glyphs on one line, with the typefaces' kerning."""
    return _kept(text) if len(text) <= LONGEST_KEPT else _set(text)


@lru_cache(maxsize=4096)
def _kept(text: str) -> Lettering:
    return _set(text)


def _set(text: str) -> Lettering:
    pen = 0.0
    faces: list[Indices] = []
    numbers: list[Indices] = []
    origins: list[Floats] = []
    for face, run in runs(text):
        shaped, places, advance = _shaped(run, typefaces()[face])
        faces.append(np.full(len(shaped), face))
        numbers.append(shaped)
        origins.append(places + np.array([pen, 0.0]))
        pen += advance
    if not faces:
        return _NOTHING
    return _inked(np.concatenate(faces), np.concatenate(numbers), np.concatenate(origins))


_NOTHING = Lettering(
    np.zeros(0, dtype=np.int64), np.zeros(0, dtype=np.int64), np.zeros((0, 2)), np.zeros((2, 2))
)


def _inked(faces: Indices, numbers: Indices, origins: Floats) -> Lettering:
    """The glyphs that are to be seen, and the box around them."""
    boxes = [glyph(face, number).bounds for face, number in zip(faces, numbers, strict=True)]
    inked = np.array([box is not None for box in boxes], dtype=bool)
    if not inked.any():
        return _NOTHING
    ink = np.stack([box for box in boxes if box is not None]) + origins[inked][:, None]
    bounds = np.array([ink[:, 0].min(axis=0), ink[:, 1].max(axis=0)])
    return Lettering(faces[inked], numbers[inked], origins[inked], bounds)


def _shaped(run: str, face: Typeface) -> tuple[Indices, Floats, float]:
    """Glyphs (g,), where they stand (g, 2) and how far the pen moves, a capital being 1 high."""
    buffer = hb.Buffer()
    buffer.add_str(run)
    # Left alone, HarfBuzz takes the language from the machine's locale, and the letters' forms.
    buffer.language = "en"
    buffer.guess_segment_properties()
    hb.shape(face.font, buffer, dict(face.features))
    numbers = np.array([info.codepoint for info in buffer.glyph_infos], dtype=np.int64)
    moves = np.array([position.position for position in buffer.glyph_positions], dtype=np.float64)
    moves = moves.reshape(-1, 4) / face.capital
    offsets, advances = moves[:, :2], moves[:, 2:]
    before = np.cumsum(advances, axis=0) - advances
    return numbers, before + offsets, float(advances[:, 0].sum())


def runs(text: str) -> Iterator[tuple[int, str]]:
    """``text`` in pieces that are set in one typeface each, with its place in `typefaces`.

    >>> [(face, len(run)) for face, run in runs("f: A\N{RIGHTWARDS ARROW}\N{FOR ALL}")]
    [(0, 5), (2, 1)]
    """
    fitted = (part for cluster in _clusters(text) for part in _fitted(cluster))
    for face, parts in groupby(fitted, key=lambda part: part[0]):
        yield face, "".join(piece for _, piece in parts)


def _clusters(text: str) -> Iterator[str]:
    """Characters with the marks that belong to them, without control characters."""
    cluster = ""
    for character in text:
        category = unicodedata.category(character)
        belongs = category[0] == "M" or category == "Cf"
        if belongs and len(cluster) < LONGEST_CLUSTER:
            cluster += character
            continue
        if cluster:
            yield cluster
        cluster = _plain(character, category)
    if cluster:
        yield cluster


def _plain(character: str, category: str) -> str:
    """Any blank as a space, half a surrogate pair as U+FFFD, other controls as nothing."""
    if character.isspace():
        return " "
    if category == "Cc":
        return ""
    return "\N{REPLACEMENT CHARACTER}" if category == "Cs" else character


@lru_cache(maxsize=4096)
def _fitted(cluster: str) -> tuple[tuple[int, str], ...]:
    """The cluster in the first typeface that has all of it, else its characters one by one."""
    visible = [character for character in cluster if not _is_ignorable(character)]
    face = _covering(visible)
    if face is None:
        face = _covering(unicodedata.normalize("NFC", "".join(visible)))
    if face is not None:
        return ((face, cluster),)
    return tuple(
        (0, BOX) if single is None else (single, character)
        for character in visible
        for single in (_covering(character),)
    )


def _covering(characters: list[str] | str) -> int | None:
    """The first typeface that has all ``characters``."""
    codes = {ord(character) for character in characters}
    for place, face in enumerate(typefaces()):
        if codes <= face.coverage:
            return place
    return None


def _is_ignorable(character: str) -> bool:
    """Whether a character says only how its neighbours look: joiners, variation selectors."""
    code = ord(character)
    return (
        unicodedata.category(character) == "Cf"
        or 0xFE00 <= code <= 0xFE0F
        or 0xE0100 <= code <= 0xE01EF
    )
