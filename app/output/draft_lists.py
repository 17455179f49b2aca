"""Room for the lists of what is translucent, one for each pixel.

As all that imports OpenGL: only on the thread that owns the context.
"""

from __future__ import annotations

import numpy as np
from OpenGL import GL

from app.output.gl_buffers import Shape, Target

USUAL = 1 << 19
"""Nodes that there is room for at first: 8 MB."""

_NODE = 16
"""Bytes of a node, and of what comes before the first."""


class Lists:
    """Heads of lists, one for each pixel, and their nodes."""

    def __init__(self) -> None:
        self._buffer = 0
        self._room = 0
        self._target: Target | None = None
        self._without = int(GL.glGenFramebuffers(1))

    def begin(self, size: tuple[int, int], samples: int, room: int) -> None:
        """Make all lists empty, with room for so many nodes, and draw without a target."""
        shape = Shape(*size, (GL.GL_R32UI,))
        if self._target is None or self._target.shape != shape:
            if self._target is not None:
                self._target.delete()
            self._target = Target(shape)
        self._make_room(room)
        self._target.begin()
        GL.glClearBufferuiv(GL.GL_COLOR, 0, np.zeros(4, dtype=np.uint32))
        GL.glBindFramebuffer(GL.GL_FRAMEBUFFER, self._without)
        for name, value in (
            (GL.GL_FRAMEBUFFER_DEFAULT_WIDTH, size[0]),
            (GL.GL_FRAMEBUFFER_DEFAULT_HEIGHT, size[1]),
            (GL.GL_FRAMEBUFFER_DEFAULT_SAMPLES, samples),
        ):
            GL.glFramebufferParameteri(GL.GL_FRAMEBUFFER, name, value)
        heads = self._target.textures[0]
        GL.glBindImageTexture(0, heads, 0, False, 0, GL.GL_READ_WRITE, GL.GL_R32UI)
        GL.glBindBufferBase(GL.GL_SHADER_STORAGE_BUFFER, 0, self._buffer)

    def end(self) -> int:
        """How many nodes there are, or would be if there were room."""
        GL.glMemoryBarrier(GL.GL_ALL_BARRIER_BITS)
        GL.glBindBuffer(GL.GL_SHADER_STORAGE_BUFFER, self._buffer)
        count = GL.glGetBufferSubData(GL.GL_SHADER_STORAGE_BUFFER, 0, 4)
        return int(np.frombuffer(count, dtype=np.uint32)[0])

    @property
    def room(self) -> int:
        """How many nodes there is room for."""
        return self._room

    def bind(self, unit: int) -> None:
        """Put the heads on a unit."""
        if self._target is not None:
            self._target.bind(0, unit)

    def _make_room(self, room: int) -> None:
        if not self._buffer:
            self._buffer = int(GL.glGenBuffers(1))
        GL.glBindBuffer(GL.GL_SHADER_STORAGE_BUFFER, self._buffer)
        if room > self._room:
            self._room = room
            size = _NODE * (1 + room)
            GL.glBufferData(GL.GL_SHADER_STORAGE_BUFFER, size, None, GL.GL_DYNAMIC_DRAW)
        head = np.array([0, self._room, 0, 0], dtype=np.uint32)
        GL.glBufferSubData(GL.GL_SHADER_STORAGE_BUFFER, 0, head.nbytes, head)
