"""Frames of a film on their way from whoever draws them to whoever encodes them.

Each is a PNG behind its length, so that nothing is lost; stretches of frames are joined by putting
one behind the other.
"""

from __future__ import annotations

import io
import struct
from collections.abc import Iterable, Iterator

from PIL import Image

from app.output.png import encode_png

_LENGTH = struct.Struct("!Q")


def pack_frames(frames: Iterable[Image.Image]) -> bytes:
    """The frames, RGB or RGBA, as bytes."""
    pieces = []
    for frame in frames:
        picture = encode_png(frame)
        pieces += [_LENGTH.pack(len(picture)), picture]
    return b"".join(pieces)


def unpack_frames(data: bytes) -> Iterator[Image.Image]:
    """The frames that `pack_frames` packed, one at a time."""
    view, place = memoryview(data), 0
    while place < len(data):
        (length,) = _LENGTH.unpack_from(view, place)
        place += _LENGTH.size
        with Image.open(io.BytesIO(view[place : place + length])) as picture:
            picture.load()
            yield picture
        place += length
