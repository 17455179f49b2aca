"""What OpenGL draws into and reads from, as far as pyrender has nothing that fits.

As everything that imports OpenGL: only on the thread that owns the context.
"""

from __future__ import annotations

import numpy as np
from OpenGL import GL

from app.arrays import Floats, Singles
from app.output.draft_view import Pixels


def smooth_texture() -> int:
    """A texture that is read between its texels, and goes on beyond its rim as it is there."""
    texture = int(GL.glGenTextures(1))
    GL.glBindTexture(GL.GL_TEXTURE_2D, texture)
    for name, value in (
        (GL.GL_TEXTURE_MAG_FILTER, GL.GL_LINEAR),
        (GL.GL_TEXTURE_MIN_FILTER, GL.GL_LINEAR),
        (GL.GL_TEXTURE_WRAP_S, GL.GL_CLAMP_TO_EDGE),
        (GL.GL_TEXTURE_WRAP_T, GL.GL_CLAMP_TO_EDGE),
    ):
        GL.glTexParameteri(GL.GL_TEXTURE_2D, name, value)
    return texture


def framebuffer(size: tuple[int, int], samples: int) -> tuple[int, int, int]:
    """A framebuffer, its colours and its depths; one sample means none in particular."""
    framebuffer = int(GL.glGenFramebuffers(1))
    GL.glBindFramebuffer(GL.GL_FRAMEBUFFER, framebuffer)
    buffers = []
    for attachment, kind in (
        (GL.GL_COLOR_ATTACHMENT0, GL.GL_RGBA8),
        (GL.GL_DEPTH_ATTACHMENT, GL.GL_DEPTH_COMPONENT24),
    ):
        buffer = int(GL.glGenRenderbuffers(1))
        GL.glBindRenderbuffer(GL.GL_RENDERBUFFER, buffer)
        GL.glRenderbufferStorageMultisample(
            GL.GL_RENDERBUFFER, samples if samples > 1 else 0, kind, *size
        )
        GL.glFramebufferRenderbuffer(GL.GL_FRAMEBUFFER, attachment, GL.GL_RENDERBUFFER, buffer)
        buffers.append(buffer)
    return framebuffer, buffers[0], buffers[1]


def read_pixels(framebuffer: int, width: int, height: int) -> Pixels:
    """The colours of a framebuffer of one sample, from top to bottom."""
    GL.glBindFramebuffer(GL.GL_READ_FRAMEBUFFER, framebuffer)
    pixels = GL.glReadPixels(0, 0, width, height, GL.GL_RGBA, GL.GL_UNSIGNED_BYTE)
    return np.frombuffer(pixels, dtype=np.uint8).reshape(height, width, 4)[::-1]


def read_depths(side: int) -> Singles:
    """Depths from 0 to 1 of what is bound, (side, side), row 0 being the lowest."""
    depths = GL.glReadPixels(0, 0, side, side, GL.GL_DEPTH_COMPONENT, GL.GL_FLOAT)
    return np.frombuffer(depths, dtype=np.float32).reshape(side, side)


def fill_texture(texture: int, values: Floats | Singles) -> None:
    """Two numbers for each texel, (height, width, 2), row 0 being the lowest."""
    height, width, _ = values.shape
    GL.glBindTexture(GL.GL_TEXTURE_2D, texture)
    GL.glTexImage2D(
        GL.GL_TEXTURE_2D,
        0,
        GL.GL_RG32F,
        width,
        height,
        0,
        GL.GL_RG,
        GL.GL_FLOAT,
        np.ascontiguousarray(values, dtype=np.float32),
    )
