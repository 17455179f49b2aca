"""Textures as files within glTF."""

from __future__ import annotations

from functools import lru_cache
from io import BytesIO

from app.scene.scene import TextureName
from app.scene.textures import texture

QUALITY = 88
"""Of the JPEG: a texture of either kind is then some 100 kB or less, a third of its PNG."""

MEDIA_TYPE = "image/jpeg"


@lru_cache(maxsize=2)
def texture_file(name: TextureName) -> bytes:
    """The texture as JPEG, which repeats like the texture itself."""
    from PIL import Image

    stream = BytesIO()
    # No colour is stored more coarsely than light: speckles are small.
    Image.fromarray(texture(name)).save(
        stream, "JPEG", quality=QUALITY, subsampling=0, optimize=True
    )
    return stream.getvalue()
