"""Frames as files that move: animated WebP, and MP4."""

from __future__ import annotations

import io
from collections.abc import Iterable
from fractions import Fraction
from typing import cast

import numpy as np
from PIL import Image

WEBP_QUALITY = 80

WEBP_EFFORT = 2
"""0 to 6: more takes three times as long for a tenth less."""

CODEC = "libvpx-vp9"
"""Free of royalties, and played by every browser; the encoder's licence is BSD's."""

CODEC_OPTIONS = {"crf": "24", "b": "0", "deadline": "good", "cpu-used": "5", "row-mt": "1"}


def write_webp(frames: Iterable[Image.Image], count: int, seconds: float) -> bytes:
    """``count`` frames in ``seconds``, again and again."""
    pictures = list(frames)
    file = io.BytesIO()
    pictures[0].save(
        file,
        "WEBP",
        save_all=True,
        append_images=pictures[1:],
        duration=max(round(1000 * seconds / count), 1),
        loop=0,
        quality=WEBP_QUALITY,
        method=WEBP_EFFORT,
    )
    return file.getvalue()


def write_mp4(frames: Iterable[Image.Image], count: int, seconds: float) -> bytes:
    """``count`` frames in ``seconds``, as VP9. What is transparent turns white.

    A picture with an odd side is a pixel larger, for colours are kept for two by two pixels.
    """
    import av
    from av.video.reformatter import ColorRange, Colorspace
    from av.video.stream import VideoStream

    file = io.BytesIO()
    rate = Fraction(count / seconds).limit_denominator(1000)
    stream: VideoStream | None = None
    with av.open(file, "w", format="mp4") as container:
        for picture in frames:
            even = _even(picture)
            if stream is None:
                stream = cast("VideoStream", container.add_stream(CODEC, rate, CODEC_OPTIONS))
                stream.width, stream.height = even.size
                stream.pix_fmt = "yuv420p"
                stream.codec_context.colorspace = Colorspace.ITU709
                stream.codec_context.color_range = ColorRange.MPEG
            rgb = av.VideoFrame.from_ndarray(np.asarray(even), format="rgb24")
            frame = rgb.reformat(format="yuv420p", dst_colorspace=Colorspace.ITU709)
            container.mux(stream.encode(frame))
        if stream is not None:
            container.mux(stream.encode(None))
    return file.getvalue()


def _even(picture: Image.Image) -> Image.Image:
    if picture.mode == "RGBA":
        paper = Image.new("RGBA", picture.size, "white")
        picture = Image.alpha_composite(paper, picture).convert("RGB")
    width, height = (side + side % 2 for side in picture.size)
    if (width, height) == picture.size:
        return picture
    # The last row and column once more.
    found = Image.new("RGB", (width, height))
    found.paste(picture.crop((picture.width - 1, 0, picture.width, picture.height)), (width - 1, 0))
    found.paste(
        picture.crop((0, picture.height - 1, picture.width, picture.height)), (0, height - 1)
    )
    found.paste(picture, (0, 0))
    return found
