"""How long a render takes, by what is asked and by the size of the document: a rough guess.

Measured on one core of a server of 2024; within a factor of three of what it takes there.
"""

from __future__ import annotations

from app.answers import RenderOptions
from app.output.media import SceneFormat

USUAL_SAMPLES = 16
"""Of each pixel of a final picture, where nothing is said."""

SECONDS_FOR_ANY = 0.02
SECONDS_FOR_BYTE = 12e-6
"""Of the document: reading, placing, routing with clearance."""

SECONDS_FOR_DRAFT, SECONDS_FOR_DRAFT_PIXEL = 0.03, 0.1e-6
SECONDS_FOR_FINAL, SECONDS_FOR_SAMPLE, SECONDS_FOR_FINISHING = 0.5, 0.25e-6, 2.5e-6
"""Of one picture, of a sample of a pixel, and of denoising a pixel."""

SECONDS_FOR_ENCODED = 0.1e-6
"""Of a pixel of a film."""

CELLS = 6
"""Of a sheet; of a sweep it is a guess."""


def estimate(options: RenderOptions, document_bytes: int) -> float:
    """Seconds of one core.

    >>> estimate(RenderOptions(SceneFormat.GLB), 10_000) < 1
    True
    >>> estimate(RenderOptions(SceneFormat.MP4, quality="final"), 10_000) > 60
    True
    """
    pixels = options.width * options.height
    seconds = SECONDS_FOR_ANY + SECONDS_FOR_BYTE * document_bytes
    if options.format.is_animated:
        pictures = options.frames
        seconds += pictures * pixels * SECONDS_FOR_ENCODED
    elif options.format is SceneFormat.PNG:
        pictures = 1
        if options.sheet or options.sweep:
            pictures, pixels = CELLS, pixels // CELLS
    else:
        return seconds
    if options.sweep:
        seconds *= CELLS
    return seconds + pictures * _picture(options, pixels)


def _picture(options: RenderOptions, pixels: int) -> float:
    if options.quality == "draft":
        return SECONDS_FOR_DRAFT + pixels * SECONDS_FOR_DRAFT_PIXEL
    samples = options.effort.samples or USUAL_SAMPLES
    traced = SECONDS_FOR_FINAL + pixels * samples * SECONDS_FOR_SAMPLE
    if options.effort.time_limit is not None:
        traced = min(traced, options.effort.time_limit)
    return traced + pixels * SECONDS_FOR_FINISHING
