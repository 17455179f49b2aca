from __future__ import annotations

from io import BytesIO

import numpy as np
import pytest
from PIL import Image

from app.output.gltf_textures import MEDIA_TYPE, texture_file
from app.scene.scene import TextureName
from app.scene.textures import texture


@pytest.mark.parametrize("name", ["wood", "stone"])
def test_a_texture_file_is_small_and_shows_the_texture(name: TextureName) -> None:
    content = texture_file(name)
    assert len(content) < 150_000
    with Image.open(BytesIO(content)) as image:
        assert Image.MIME[image.format or ""] == MEDIA_TYPE
        found = np.asarray(image).astype(np.float64)
    there = texture(name).astype(np.float64)
    assert found.shape == there.shape
    assert np.sqrt(((found - there) ** 2).mean()) < 5
    assert found.mean(axis=(0, 1)) == pytest.approx(there.mean(axis=(0, 1)), abs=0.5)
    for axis in (0, 1):
        rim = (found - there).take([0, -1], axis=axis)
        assert np.sqrt((rim**2).mean()) < 6, "the rims as well: they meet"


def test_texture_files_are_made_once() -> None:
    assert texture_file("wood") is texture_file("wood")
