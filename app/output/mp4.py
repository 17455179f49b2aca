"""MP4 films of AV1: the boxes of ISO/IEC 14496-12 around coded frames.

What tells about the frames comes first, so that a film plays while it is being loaded.
"""

from __future__ import annotations

import struct
from collections.abc import Iterable, Iterator, Sequence
from itertools import accumulate

from PIL import Image

from app.output.av1 import Clip, encode_av1

TICKS = 90_000
"""To a second, as usual."""

MOST_TOGETHER, MOST_BYTES = 24, 1 << 28
"""Frames from one key to the next, and what they take uncompressed: whoever looks for a place in
the film has to decode so many."""

_IDENTITY = struct.pack(">9I", 1 << 16, 0, 0, 0, 1 << 16, 0, 0, 0, 1 << 30)


def encode_mp4(frames: Iterable[Image.Image], ticks: int) -> bytes:
    """The frames, RGB and of one size, each shown for so many `TICKS`.

    Odd sides are made even, as players want them: the last row or column is given twice.
    Raises `RendererUnavailable` where there is no encoder.
    """
    size = (2, 2)
    clips: list[Clip] = []
    for group in _groups(_even(frame) for frame in frames):
        size = group[0].size
        clips.append(encode_av1(group))
    samples = [sample for clip in clips for sample in clip.samples]
    starts = accumulate((len(clip.samples) for clip in clips), initial=0)
    keys = [start + key for start, clip in zip(starts, clips, strict=False) for key in clip.keys]
    kind = _box(b"ftyp", b"isom", struct.pack(">I", 0x200), b"isom", b"iso6", b"av01", b"mp41")
    head = b""
    for _ in range(2):  # where the samples are depends on the length of what says so
        head = kind + _movie(size, ticks, samples, keys, clips[0].description, len(head) + 16)
    length = 16 + sum(map(len, samples))
    return b"".join([head, struct.pack(">I4sQ", 1, b"mdat", length), *samples])


def _movie(
    size: tuple[int, int],
    ticks: int,
    samples: Sequence[bytes],
    keys: Sequence[int],
    description: bytes,
    place: int,
) -> bytes:
    """The samples lie at ``place`` in the file, one after the other."""
    duration = ticks * len(samples)
    header = struct.pack(">QQIQ", 0, 0, TICKS, duration)
    return _box(
        b"moov",
        _full(
            b"mvhd",
            header,
            struct.pack(">IH10x", 1 << 16, 1 << 8),
            _IDENTITY,
            struct.pack(">24xI", 2),
            version=1,
        ),
        _box(
            b"trak",
            _full(
                b"tkhd",
                struct.pack(">QQI4xQ8x8x", 0, 0, 1, duration),
                _IDENTITY,
                struct.pack(">II", size[0] << 16, size[1] << 16),
                version=1,
                flags=3,
            ),
            _box(
                b"mdia",
                _full(b"mdhd", header, struct.pack(">HH", _language("und"), 0), version=1),
                _full(b"hdlr", struct.pack(">4x4s12x", b"vide"), b"Tubeloom\0"),
                _box(
                    b"minf",
                    _full(b"vmhd", bytes(8), flags=1),
                    _box(
                        b"dinf",
                        _full(b"dref", struct.pack(">I", 1), _full(b"url ", flags=1)),
                    ),
                    _table(size, ticks, samples, keys, description, place),
                ),
            ),
        ),
    )


def _table(
    size: tuple[int, int],
    ticks: int,
    samples: Sequence[bytes],
    keys: Sequence[int],
    description: bytes,
    place: int,
) -> bytes:
    count = len(samples)
    resolution = struct.pack(">II", 72 << 16, 72 << 16)
    entry = _box(
        b"av01",
        struct.pack(">6xH16xHH", 1, *size),
        resolution,
        struct.pack(">4xH32xHh", 1, 24, -1),
        description,
    )
    return _box(
        b"stbl",
        _full(b"stsd", struct.pack(">I", 1), entry),
        _full(b"stts", struct.pack(">III", 1, count, ticks)),
        _full(b"stsc", struct.pack(">IIII", 1, 1, count, 1)),
        _full(b"stsz", struct.pack(f">II{count}I", 0, count, *map(len, samples))),
        _full(b"stss", struct.pack(f">I{len(keys)}I", len(keys), *(key + 1 for key in keys))),
        _full(b"co64", struct.pack(">IQ", 1, place)),
    )


def _even(frame: Image.Image) -> Image.Image:
    width, height = frame.size
    if width % 2 == 0 and height % 2 == 0:
        return frame
    padded = Image.new("RGB", (width + width % 2, height + height % 2))
    for place in ((width % 2, height % 2), (0, height % 2), (width % 2, 0), (0, 0)):
        padded.paste(frame, place)
    return padded


def _groups(frames: Iterable[Image.Image]) -> Iterator[list[Image.Image]]:
    """Frames that are encoded together."""
    group: list[Image.Image] = []
    for frame in frames:
        group.append(frame)
        taken = 3 * frame.width * frame.height * len(group)
        if len(group) == MOST_TOGETHER or taken >= MOST_BYTES:
            yield group
            group = []
    if group:
        yield group


def _box(name: bytes, *content: bytes) -> bytes:
    inside = b"".join(content)
    return struct.pack(">I4s", 8 + len(inside), name) + inside


def _full(name: bytes, *content: bytes, version: int = 0, flags: int = 0) -> bytes:
    return _box(name, struct.pack(">I", version << 24 | flags), *content)


def _language(code: str) -> int:
    """Three letters of five bits (ISO 639-2)."""
    first, second, third = (ord(letter) - 0x60 for letter in code)
    return first << 10 | second << 5 | third
