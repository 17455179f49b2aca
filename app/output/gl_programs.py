"""Shaders: read, compiled once for each set of definitions, and given their numbers.

As everything that imports OpenGL: only on the thread that owns the context.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path

import numpy as np
from OpenGL import GL

from app.output.draft_view import Uniform

_SHADERS = Path(__file__).with_name("shaders")
_VERSION = "#version 430 core\n"


class Program:
    """A vertex and a fragment shader, linked; each is made of files, one after another."""

    def __init__(self, vertex: str, fragment: str, defines: tuple[tuple[str, int], ...]) -> None:
        self._number = int(GL.glCreateProgram())
        for kind, files in (
            (GL.GL_VERTEX_SHADER, vertex),
            (GL.GL_FRAGMENT_SHADER, fragment),
        ):
            GL.glAttachShader(self._number, _compiled(kind, files, defines))
        GL.glLinkProgram(self._number)
        if not GL.glGetProgramiv(self._number, GL.GL_LINK_STATUS):
            raise RuntimeError(GL.glGetProgramInfoLog(self._number))
        self._places: dict[str, int] = {}

    def use(self, numbers: Mapping[str, Uniform]) -> None:
        """Draw with it from now on; uniforms that it does not have are left out.

        Matrices are (4, 4), lists of vectors (n, 3), vectors (4,).
        """
        GL.glUseProgram(self._number)
        for name, value in numbers.items():
            place = self._places.get(name)
            if place is None:
                place = self._places[name] = int(GL.glGetUniformLocation(self._number, name))
            if place >= 0:
                _set(place, value)


def program(vertex: str, fragment: str, **defines: int) -> Program:
    """The program of these files, their names joined by ``+``; compiled at its first use."""
    return _program(vertex, fragment, tuple(sorted(defines.items())))


_program = lru_cache(maxsize=128)(Program)


def _compiled(kind: int, files: str, defines: tuple[tuple[str, int], ...]) -> int:
    head = "".join(f"#define {name} {value}\n" for name, value in defines)
    body = "\n".join((_SHADERS / file).read_text() for file in files.split("+"))
    shader = int(GL.glCreateShader(kind))
    GL.glShaderSource(shader, _VERSION + head + body)
    GL.glCompileShader(shader)
    if not GL.glGetShaderiv(shader, GL.GL_COMPILE_STATUS):
        raise RuntimeError(f"{files}: {GL.glGetShaderInfoLog(shader)}")
    return shader


def _set(place: int, value: Uniform) -> None:
    if isinstance(value, int):
        GL.glUniform1i(place, value)
    elif isinstance(value, float):
        GL.glUniform1f(place, value)
    else:
        singles = np.ascontiguousarray(value, dtype=np.float32)
        match singles.shape:
            case (4, 4):
                GL.glUniformMatrix4fv(place, 1, True, singles)
            case (count, 3):
                GL.glUniform3fv(place, count, singles)
            case (3,):
                GL.glUniform3fv(place, 1, singles)
            case (4,):
                GL.glUniform4fv(place, 1, singles)
            case shape:
                raise ValueError(f"No uniform has the shape {shape}.")
