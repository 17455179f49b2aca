"""Wood and stone where OpenGL has them at hand."""

from __future__ import annotations

from OpenGL import GL
from OpenGL.GL.EXT.texture_filter_anisotropic import GL_TEXTURE_MAX_ANISOTROPY_EXT

from app.output.gl_buffers import filtered
from app.scene.scene import TextureName
from app.scene.textures import texture

SLANTED = 4.0
"""How much more finely a texture is read along a surface that is seen at an angle."""


class Grains:
    """Textures, made and given to OpenGL where one is first asked for."""

    def __init__(self) -> None:
        self._textures: dict[TextureName, int] = {}

    def bind(self, name: TextureName | None, unit: int) -> None:
        """Put it, if any, on a unit. In shaders its colours are linear."""
        if name is None:
            return
        GL.glActiveTexture(GL.GL_TEXTURE0 + unit)
        if name not in self._textures:
            self._textures[name] = _made(name)
        GL.glBindTexture(GL.GL_TEXTURE_2D, self._textures[name])


def _made(name: TextureName) -> int:
    pixels = texture(name)
    side = len(pixels)
    number = int(GL.glGenTextures(1))
    GL.glBindTexture(GL.GL_TEXTURE_2D, number)
    size = (GL.GL_TEXTURE_2D, 0, GL.GL_SRGB8, side, side, 0)
    GL.glPixelStorei(GL.GL_UNPACK_ALIGNMENT, 1)
    GL.glTexImage2D(*size, GL.GL_RGB, GL.GL_UNSIGNED_BYTE, pixels)
    GL.glGenerateMipmap(GL.GL_TEXTURE_2D)
    filtered(GL.GL_REPEAT, least=GL.GL_LINEAR_MIPMAP_LINEAR)
    GL.glTexParameterf(GL.GL_TEXTURE_2D, GL_TEXTURE_MAX_ANISOTROPY_EXT, SLANTED)
    return number
