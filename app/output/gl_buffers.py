"""What OpenGL draws from, draws into, and reads back.

As everything that imports OpenGL: only on the thread that owns the context.
"""

from __future__ import annotations

import ctypes
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from OpenGL import GL

from app.arrays import Faces, Floats, Singles

SPARE = 15
"""The unit on which textures are made, so that those in use stay where they are."""


class Vertices:
    """Arrays of vertices, and triangles among them, where OpenGL has them at hand."""

    def __init__(self, attributes: Sequence[Singles | Faces | None], faces: Faces) -> None:
        """``attributes`` (v, n) or (v,) in the order of their numbers; ``faces`` (f, 3)."""
        self._array = int(GL.glGenVertexArrays(1))
        self._buffers: list[int] = []
        GL.glBindVertexArray(self._array)
        for number, values in enumerate(attributes):
            if values is None:
                continue
            self._fill(GL.GL_ARRAY_BUFFER, values)
            GL.glEnableVertexAttribArray(number)
            width = values.shape[1] if values.ndim > 1 else 1
            if values.dtype == np.uint32:
                GL.glVertexAttribIPointer(number, width, GL.GL_UNSIGNED_INT, 0, None)
            else:
                GL.glVertexAttribPointer(number, width, GL.GL_FLOAT, False, 0, None)
        self._fill(GL.GL_ELEMENT_ARRAY_BUFFER, faces)
        GL.glBindVertexArray(0)

    def draw(self, first: int, count: int) -> None:
        """So many triangles, from the first on."""
        GL.glBindVertexArray(self._array)
        start = ctypes.c_void_p(12 * first)
        GL.glDrawElements(GL.GL_TRIANGLES, 3 * count, GL.GL_UNSIGNED_INT, start)

    def delete(self) -> None:
        """Give the memory back."""
        GL.glDeleteVertexArrays(1, [self._array])
        GL.glDeleteBuffers(len(self._buffers), self._buffers)

    def _fill(self, kind: int, values: NDArray[Any]) -> None:
        buffer = int(GL.glGenBuffers(1))
        self._buffers.append(buffer)
        GL.glBindBuffer(kind, buffer)
        values = np.ascontiguousarray(values)
        GL.glBufferData(kind, values.nbytes, values, GL.GL_STATIC_DRAW)


class Table:
    """Rows of numbers that shaders look up."""

    def __init__(self, values: Singles) -> None:
        """``values`` (…, 4)."""
        self._buffer, self._texture = int(GL.glGenBuffers(1)), int(GL.glGenTextures(1))
        GL.glBindBuffer(GL.GL_TEXTURE_BUFFER, self._buffer)
        GL.glBufferData(GL.GL_TEXTURE_BUFFER, values.nbytes, values, GL.GL_STATIC_DRAW)
        GL.glActiveTexture(GL.GL_TEXTURE0 + SPARE)
        GL.glBindTexture(GL.GL_TEXTURE_BUFFER, self._texture)
        GL.glTexBuffer(GL.GL_TEXTURE_BUFFER, GL.GL_RGBA32F, self._buffer)

    def bind(self, unit: int) -> int:
        """Put it on a unit, and say which."""
        GL.glActiveTexture(GL.GL_TEXTURE0 + unit)
        GL.glBindTexture(GL.GL_TEXTURE_BUFFER, self._texture)
        return unit

    def delete(self) -> None:
        """Give the memory back."""
        GL.glDeleteTextures([self._texture])
        GL.glDeleteBuffers(1, [self._buffer])


@dataclass(frozen=True, slots=True)
class Shape:
    """Size and formats of a target; ``samples`` are 0 for usual textures."""

    width: int
    height: int
    colors: tuple[int, ...]
    depth: int | None = None
    samples: int = 0


class Target:
    """Textures to draw into, and to look up afterwards."""

    def __init__(self, shape: Shape) -> None:
        self.shape = shape
        self.textures: list[int] = []
        self._kind = GL.GL_TEXTURE_2D_MULTISAMPLE if shape.samples else GL.GL_TEXTURE_2D
        self._number = int(GL.glGenFramebuffers(1))
        GL.glBindFramebuffer(GL.GL_FRAMEBUFFER, self._number)
        places = [GL.GL_COLOR_ATTACHMENT0 + number for number in range(len(shape.colors))]
        for place, color in zip(places, shape.colors, strict=True):
            self._attach(place, color)
        if shape.depth is not None:
            self._attach(GL.GL_DEPTH_ATTACHMENT, shape.depth)
        GL.glDrawBuffers(len(places), places)
        if not places:
            GL.glReadBuffer(GL.GL_NONE)
        status = GL.glCheckFramebufferStatus(GL.GL_FRAMEBUFFER)
        if status == GL.GL_FRAMEBUFFER_INCOMPLETE_ATTACHMENT:
            # The formats are fixed, and work: a texture has got no memory.
            raise MemoryError(f"OpenGL has no memory for {shape}")
        if status != GL.GL_FRAMEBUFFER_COMPLETE:
            raise RuntimeError(f"OpenGL does not draw into {shape}: {status}")

    def begin(self) -> None:
        """Draw into it from now on."""
        GL.glBindFramebuffer(GL.GL_FRAMEBUFFER, self._number)
        GL.glViewport(0, 0, self.shape.width, self.shape.height)

    def bind(self, number: int, unit: int) -> int:
        """Put one of its textures, depth being the last, on a unit, and say which."""
        GL.glActiveTexture(GL.GL_TEXTURE0 + unit)
        GL.glBindTexture(self._kind, self.textures[number])
        return unit

    def delete(self) -> None:
        """Give the memory back."""
        GL.glDeleteFramebuffers(1, [self._number])
        GL.glDeleteTextures(self.textures)

    def _attach(self, place: int, kind: int) -> None:
        texture = int(GL.glGenTextures(1))
        self.textures.append(texture)
        GL.glActiveTexture(GL.GL_TEXTURE0 + SPARE)
        GL.glBindTexture(self._kind, texture)
        size = self.shape.width, self.shape.height
        if self.shape.samples:
            GL.glTexImage2DMultisample(self._kind, self.shape.samples, kind, *size, True)
        else:
            GL.glTexStorage2D(self._kind, 1, kind, *size)
            for name in (GL.GL_TEXTURE_MAG_FILTER, GL.GL_TEXTURE_MIN_FILTER):
                GL.glTexParameteri(self._kind, name, GL.GL_NEAREST)
        GL.glFramebufferTexture2D(GL.GL_FRAMEBUFFER, place, self._kind, texture, 0)


def begin_depth() -> None:
    """Draw from now on what is nearest, its front alone, into a target with nothing in it yet."""
    GL.glEnable(GL.GL_DEPTH_TEST)
    GL.glDepthFunc(GL.GL_LESS)
    GL.glDisable(GL.GL_BLEND)
    GL.glEnable(GL.GL_CULL_FACE)
    GL.glCullFace(GL.GL_BACK)
    GL.glClearDepth(1.0)
    GL.glClear(GL.GL_DEPTH_BUFFER_BIT)


def filtered(wrap: int, **more: int) -> None:
    """Have the texture that is bound read between its texels, and beyond its rim as ``wrap``."""
    for name, value in (
        (GL.GL_TEXTURE_MAG_FILTER, GL.GL_LINEAR),
        (GL.GL_TEXTURE_MIN_FILTER, more.get("least", GL.GL_LINEAR)),
        (GL.GL_TEXTURE_WRAP_S, wrap),
        (GL.GL_TEXTURE_WRAP_T, wrap),
    ):
        GL.glTexParameteri(GL.GL_TEXTURE_2D, name, value)


def read_pixels(width: int, height: int) -> NDArray[np.uint8]:
    """The colours of what is drawn into, (height, width, 4), row 0 being the lowest."""
    pixels = np.empty((height, width, 4), dtype=np.uint8)
    GL.glReadPixels(0, 0, width, height, GL.GL_RGBA, GL.GL_UNSIGNED_BYTE, pixels)
    return pixels


def read_depths(width: int, height: int) -> Singles:
    """Depths from 0 to 1 of what is drawn into, (height, width), row 0 being the lowest."""
    depths = np.empty((height, width), dtype=np.float32)
    GL.glReadPixels(0, 0, width, height, GL.GL_DEPTH_COMPONENT, GL.GL_FLOAT, depths)
    return depths


def fill_texture(texture: int, values: Floats | Singles) -> None:
    """Two numbers for each texel, (height, width, 2), row 0 being the lowest."""
    height, width, _ = values.shape
    GL.glActiveTexture(GL.GL_TEXTURE0 + SPARE)
    GL.glBindTexture(GL.GL_TEXTURE_2D, texture)
    singles = np.ascontiguousarray(values, dtype=np.float32)
    size = (GL.GL_TEXTURE_2D, 0, GL.GL_RG32F, width, height, 0)
    GL.glTexImage2D(*size, GL.GL_RG, GL.GL_FLOAT, singles)
