"""Pixels as PNG."""

from __future__ import annotations

import io

import numpy as np
import pytest
from PIL import Image

from app.output.png import encode_png


@pytest.mark.parametrize("mode", ["RGB", "RGBA"])
def test_pixels_come_back_as_they_were(mode: str) -> None:
    random = np.random.default_rng(3)
    picture = Image.frombytes(mode, (17, 9), random.bytes(17 * 9 * len(mode)))
    back = Image.open(io.BytesIO(encode_png(picture)))
    assert back.mode == mode
    assert back.tobytes() == picture.tobytes()


def test_the_same_pixels_give_the_same_bytes() -> None:
    picture = Image.new("RGB", (30, 20), "#d55e00")
    assert encode_png(picture) == encode_png(picture.copy())
