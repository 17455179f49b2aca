"""Views into glTF's binary buffer: rows of one kind of data, stored as they are or encoded."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, Literal, TypeAlias

import numpy as np
from numpy.typing import NDArray

MESHOPT = "EXT_meshopt_compression"

Mode: TypeAlias = Literal["ATTRIBUTES", "TRIANGLES"]
Filter: TypeAlias = Literal["OCTAHEDRAL", "EXPONENTIAL"]

_VERTICES, _TRIANGLES = 34962, 34963  # what a view is for, by OpenGL's numbers


@dataclass(frozen=True, slots=True, eq=False)
class View:
    """``count`` rows of ``stride`` bytes each.

    ``pieces`` (anything like bytes) are the rows, or, where there is a ``mode``, at last what the
    codec of that name makes of them; readers undo the ``filter`` after it.
    """

    pieces: Sequence[Any]
    count: int
    stride: int
    target: int | None
    mode: Mode | None = None
    filter: Filter | None = None

    @property
    def size(self) -> int:
        """Bytes of the rows."""
        return self.count * self.stride

    @property
    def length(self) -> int:
        """Bytes stored."""
        return sum(memoryview(piece).nbytes for piece in self.pieces)


def vertices(
    pieces: Sequence[NDArray[Any]], *, encode: bool, filtered: Filter | None = None
) -> View:
    """What there is once for each vertex: rows (v, k) of a multiple of 4 bytes, in ``pieces``."""
    stride = pieces[0].itemsize * pieces[0].shape[1]
    mode: Mode | None = "ATTRIBUTES" if encode else None
    return View(pieces, sum(map(len, pieces)), stride, _VERTICES, mode, filtered)


def triangles(pieces: Sequence[NDArray[Any]], *, encode: bool) -> View:
    """Triangles' vertex numbers (3 f,), uint16 or uint32, in ``pieces``."""
    mode: Mode | None = "TRIANGLES" if encode else None
    return View(pieces, sum(map(len, pieces)), pieces[0].itemsize, _TRIANGLES, mode)


def file(content: bytes) -> View:
    """A file as it is, of another format."""
    return View([content], len(content), 1, None)


def encoded(view: View) -> View:
    """The same view with rows as they are stored: encoded, if it has a mode."""
    if view.mode is None:
        return view
    from meshopt import encode_gltf_buffer

    rows = view.pieces[0] if len(view.pieces) == 1 else np.concatenate(view.pieces)
    return replace(view, pieces=[encode_gltf_buffer(rows, view.mode)])


@dataclass(frozen=True, slots=True, eq=False)
class Laid:
    """Views one after another: the pieces of the buffer, and what glTF says of views and buffers.

    ``fallback`` is the length of the buffer that encoded views would have; nobody stores it.
    """

    pieces: list[Any]
    length: int
    fallback: int
    views: list[dict[str, Any]]


def lay(views: Sequence[View]) -> Laid:
    """Lay all views into one buffer, each from a multiple of four bytes on."""
    pieces: list[Any] = []
    told: list[dict[str, Any]] = []
    length = fallback = 0
    for view in views:
        vertex_rows = {"byteStride": view.stride} if view.target == _VERTICES else {}
        if view.mode is None:
            place = {"buffer": 0, "byteOffset": length, "byteLength": view.size}
        else:
            place = {"buffer": 1, "byteOffset": fallback, "byteLength": view.size}
            fallback += view.size + -view.size % 4
        found: dict[str, Any] = {**place, **vertex_rows}
        if view.target is not None:
            found["target"] = view.target
        if view.mode is not None:
            found["extensions"] = {MESHOPT: _encoding(view, length)}
        told.append(found)
        stored = view.length
        padding = -stored % 4
        pieces += view.pieces
        if padding:
            pieces.append(bytes(padding))
        length += stored + padding
    return Laid(pieces, length, fallback, told)


def _encoding(view: View, offset: int) -> dict[str, Any]:
    found = {
        "buffer": 0,
        "byteOffset": offset,
        "byteLength": view.length,
        "byteStride": view.stride,
        "count": view.count,
        "mode": view.mode,
    }
    return found if view.filter is None else found | {"filter": view.filter}
