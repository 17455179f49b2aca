from __future__ import annotations

import numpy as np
import pytest
from PIL import Image

from app.output.animation import write_webp
from app.output.frames import pack_frames, unpack_frames


def noise(mode: str, number: int) -> list[Image.Image]:
    """Frames in which any loss would show."""
    random = np.random.default_rng(number)
    shape = (9, 14, len(mode))
    return [Image.fromarray(random.integers(0, 256, shape, dtype=np.uint8)) for _ in range(number)]


@pytest.mark.parametrize("mode", ["RGB", "RGBA"])
def test_frames_arrive_as_they_were_sent(mode: str) -> None:
    frames = noise(mode, 3)
    arrived = list(unpack_frames(pack_frames(frames)))
    assert [frame.mode for frame in arrived] == [mode] * 3
    for frame, sent in zip(arrived, frames, strict=True):
        assert frame.tobytes() == sent.tobytes()


def test_a_film_of_stretches_is_the_film_of_its_frames() -> None:
    frames = noise("RGB", 5)
    stretches = pack_frames(frames[:2]) + pack_frames(frames[2:])
    assert write_webp(unpack_frames(stretches), 5, 1.0) == write_webp(frames, 5, 1.0)
