"""Pictures that are refused before anything is read, for their pixels or the memory they need."""

from __future__ import annotations

from app.answers import RenderOptions
from app.errors import OutOfMemory, PictureTooLarge
from app.output.media import SceneFormat
from app.output.memory_needs import MIB, PAGE_PIXEL, WORKER, draft_bytes, final_bytes
from app.settings import Settings

CELLS = 6
"""Of a sheet; of a sweep it is a guess, and each cell is asked about again when it is drawn."""


def refuse_too_large(options: RenderOptions, settings: Settings) -> None:
    """Raise `PictureTooLarge` for too many pixels, `OutOfMemory` for what cannot be drawn.

    The same is always refused, whatever this process has drawn before.
    """
    pixels = options.width * options.height
    if pixels > settings.max_pixels:
        raise PictureTooLarge(
            f"{options.width} by {options.height} pixels are more than the "
            f"{settings.max_pixels} that this service draws."
        )
    if options.format.is_animated and pixels * options.frames > settings.max_film_pixels:
        raise PictureTooLarge(
            f"{options.frames} frames of {options.width} by {options.height} pixels are more than "
            f"the {settings.max_film_pixels} pixels that an animation may have here."
        )
    most = settings.max_worker_bytes
    if is_drawn(options) and picture_bytes(options, options.width, options.height) > most:
        raise OutOfMemory(
            f"A {options.quality} picture with width={options.width} and height={options.height} "
            f"takes more than the {in_gib(most)} of memory that a worker may take. "
            f"{advice(options, most)}"
        )


def is_drawn(options: RenderOptions) -> bool:
    """Whether the answer has pixels."""
    return options.format is SceneFormat.PNG or options.format.is_animated


def picture_bytes(options: RenderOptions, width: int, height: int) -> int:
    """What a picture of that size takes at most, in a worker that has drawn nothing yet."""
    page = 0
    if options.sheet or options.sweep:
        page = PAGE_PIXEL * width * height
        height = max(height // CELLS, 1)
    if options.quality == "final":
        drawn = final_bytes(width, height, denoise=options.effort.denoise)
    else:
        drawn = draft_bytes(width, height)
    return WORKER + page + drawn


def largest_size(options: RenderOptions, most: int) -> tuple[int, int] | None:
    """Width and height, in the proportion asked for, of the largest picture that takes no more.

    >>> largest_size(RenderOptions(SceneFormat.PNG, 4096, 4096, "final"), 4 << 30)
    (4096, 4096)
    """
    low, high = 0, 1025
    while high - low > 1:
        middle = (low + high) // 2
        size = _scaled(options, middle / 1024)
        low, high = (middle, high) if picture_bytes(options, *size) <= most else (low, middle)
    return _scaled(options, low / 1024) if low else None


def advice(options: RenderOptions, most: int, total: int | None = None) -> str:
    """Which size would do with that much memory, or how much memory for the size asked for.

    ``total`` is what this scene needs for it, if that is known.
    """
    usual = picture_bytes(options, options.width, options.height)
    needed = total or usual
    if needed <= most:
        more = f"TUBELOOM_MAX_WORKER_BYTES={2 * most}"
        return f"Half the width and height or a smaller document may do, or {more}."
    ways = f"TUBELOOM_MAX_WORKER_BYTES={-(-needed // (64 * MIB)) * 64 * MIB}"
    if (size := largest_size(options, most - max(needed - usual, 0))) is None:
        return f"No such picture fits; {ways} would do."
    return f"width={size[0]} and height={size[1]} would do, or {ways}."


def in_gib(size: int) -> str:
    """The size, to read.

    >>> in_gib(512 << 20)
    '0.5 GiB'
    """
    return f"{size / 1024**3:.3g} GiB"


def _scaled(options: RenderOptions, share: float) -> tuple[int, int]:
    return max(int(options.width * share), 1), max(int(options.height * share), 1)
