"""Pictures as AV1, by the encoder that Pillow has for AVIF (libaom, under a permissive licence).

An AVIF with several pictures is a film already, but for its wrapping: `app.output.mp4` wraps it
anew. Encoders of H.264 are under the GPL, and patented.
"""

from __future__ import annotations

import io
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from struct import unpack_from

from PIL import Image, features

from app.errors import RendererUnavailable

QUALITY, SPEED = 70, 8
"""As near to the frames as WebP's 80, in the time of some two drafts."""

THREADS = 2
"""A number of its own: the bytes must not depend on how many processors there are."""


@dataclass(frozen=True, slots=True)
class Clip:
    """Frames as AV1 in ``samples``; those numbered in ``keys`` need no other.

    ``description`` are the boxes (av1C, colr) that tell players what to expect.
    """

    samples: tuple[bytes, ...]
    keys: tuple[int, ...]
    description: bytes


def encode_av1(frames: Sequence[Image.Image]) -> Clip:
    """The frames, all RGB and of one size with even sides; the first is a key.

    Raises `RendererUnavailable` where Pillow was built without AVIF.
    """
    if not features.check("avif"):
        raise RendererUnavailable("MP4 needs a Pillow with AVIF, as its wheels are.")
    buffer = io.BytesIO()
    frames[0].save(
        buffer,
        "AVIF",
        save_all=True,
        # A single frame would be wrapped otherwise.
        append_images=frames[1:] or frames,
        quality=QUALITY,
        speed=SPEED,
        max_threads=THREADS,
        autotiling=False,
        subsampling="4:2:0",
        range="limited",
        codec="aom",
    )
    data = buffer.getvalue()
    table = _inside(data, b"moov", b"trak", b"mdia", b"minf", b"stbl")
    boxes = dict(_boxes(table))
    samples = _samples(data, boxes)[: len(frames)]
    keys = unpack_from(f">{unpack_from('>I', boxes[b'stss'], 4)[0]}I", boxes[b"stss"], 8)
    return Clip(
        samples,
        tuple(key - 1 for key in keys if key <= len(frames)),
        _description(boxes[b"stsd"]),
    )


def _samples(data: bytes, boxes: dict[bytes, bytes]) -> tuple[bytes, ...]:
    """All lie in one chunk, one after the other."""
    count = unpack_from(">I", boxes[b"stsz"], 8)[0]
    (place,) = unpack_from(">I", boxes[b"stco"], 8)
    found = []
    for size in unpack_from(f">{count}I", boxes[b"stsz"], 12):
        found.append(data[place : place + size])
        place += size
    return tuple(found)


def _description(table: bytes) -> bytes:
    """Of the one sample entry: 8 bytes of the table, 8 of the entry's box, 78 of its fields."""
    inside = _boxes(table[8 + 8 + 78 :])
    return b"".join(
        (8 + len(content)).to_bytes(4, "big") + name + content
        for name, content in inside
        if name in {b"av1C", b"colr"}
    )


def _inside(data: bytes, *way: bytes) -> bytes:
    for name in way:
        data = next(content for found, content in _boxes(data) if found == name)
    return data


def _boxes(data: bytes) -> Iterator[tuple[bytes, bytes]]:
    """Name and content of each box (ISO/IEC 14496-12, 4.2)."""
    place = 0
    while place < len(data):
        length, name = unpack_from(">I4s", data, place)
        yield name, data[place + 8 : place + length]
        place += length
