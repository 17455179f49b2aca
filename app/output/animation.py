"""Frames as a film, each encoded as soon as it is drawn."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from typing import TypeAlias

from PIL import Image

from app.output.mp4 import TICKS, encode_mp4
from app.output.webp import encode_webp

Progress: TypeAlias = Callable[[str, float], None]

PAPER = (255, 255, 255)
"""What lies behind transparent frames in a film that cannot be transparent."""


def _silent(_stage: str, _share: float) -> None:
    pass


def write_webp(
    frames: Iterable[Image.Image], count: int, seconds: float, progress: Progress = _silent
) -> bytes:
    """``count`` frames of one size as a WebP that goes round in so many seconds, for ever.

    Transparent frames (RGBA) stay so. ``progress`` is told the share of the frames that are there,
    after each, and may raise to end the work. Raises `PictureTooLarge` beyond 16,383 pixels a side.
    """
    ends = [round(1000 * seconds * (number + 1) / count) for number in range(count)]
    durations = [end - start for start, end in zip([0, *ends], ends, strict=False)]
    return encode_webp(_counted(frames, count, progress), durations)


def write_mp4(
    frames: Iterable[Image.Image], count: int, seconds: float, progress: Progress = _silent
) -> bytes:
    """``count`` frames of one size as an MP4 of so many seconds, in AV1, without sound.

    All else as in `write_webp`, but films are not transparent, nor do they go round by themselves.
    Raises `RendererUnavailable` where Pillow has no encoder.
    """
    told = _counted(frames, count, progress)
    return encode_mp4(map(_opaque, told), max(round(TICKS * seconds / count), 1))


def _counted(
    frames: Iterable[Image.Image], count: int, progress: Progress
) -> Iterator[Image.Image]:
    for number, frame in enumerate(frames, start=1):
        yield frame
        progress("encoding", min(number / count, 1.0))


def _opaque(frame: Image.Image) -> Image.Image:
    if frame.mode != "RGBA":
        return frame.convert("RGB")
    paper = Image.new("RGB", frame.size, PAPER)
    paper.paste(frame, mask=frame.getchannel("A"))
    return paper
