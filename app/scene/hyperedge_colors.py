"""Which colours hyperedges have."""

from __future__ import annotations

import numpy as np

from app.arrays import Floats, Indices
from app.notations.notation import Notation
from app.program.model import Program
from app.scene.color import srgb_of
from app.scene.palette import colors


def background_of(program: Program) -> Floats | None:
    """The background as sRGB (3,), unless it is transparent."""
    background = program.style.background
    return None if background == "transparent" else srgb_of(background)


def hyperedge_colors(
    program: Program, notation: Notation, background: Floats | None, hues: Indices | None = None
) -> Floats:
    """As sRGB (h, 3): its own, or its kind's, or the palette's.

    Every hyperedge takes one from the palette, whether it shows it or not: so a colour given to
    one does not change the others'. ``hues`` (h,) say which; left out, they take one after another.
    """
    taken = np.arange(len(program.hyperedges)) if hues is None else hues
    chosen = colors(program.style.palette, int(taken.max(initial=-1)) + 1, background)[taken]
    for number, hyperedge in enumerate(program.hyperedges):
        given = hyperedge.color or notation.hyperedge_style(hyperedge.kind).color
        if given is not None:
            chosen[number] = srgb_of(given)
    return chosen
