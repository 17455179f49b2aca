"""Meshes as glTF's binary buffer: one view for each kind of data, accessors into them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import accumulate
from typing import Any

import numpy as np
from pydantic_core import to_json

from app.scene.boxes import boxes
from app.solids.mesh import Mesh

MOST_SHORT = 65_535
"""Vertices that uint16 can number: its largest value would restart the primitive."""

_FLOAT = 5126
_INTEGERS = {"<u4": 5125, "<u2": 5123}  # the wide ones first, so that all are aligned
_VERTICES, _TRIANGLES = 34962, 34963  # what a buffer view is for, by OpenGL's numbers


@dataclass(frozen=True, slots=True)
class Packed:
    """A binary buffer in ``pieces`` (anything like bytes), and what glTF says about it.

    ``accessors`` are JSON texts. ``indices`` are the accessors of each mesh's triangles; those
    of mesh k's positions and normals are k and k plus the number of meshes.
    """

    pieces: Sequence[Any]
    length: int
    views: list[dict[str, int]]
    accessors: list[bytes]
    indices: list[int]


def pack(meshes: Sequence[Mesh]) -> Packed:
    """All ``meshes``, each of one triangle or more; equal triangles are stored once.

    Nothing is copied that need not be: the pieces are joined when the file is written.
    """
    if not meshes:
        return Packed([], 0, [], [], [])
    positions = np.concatenate([mesh.vertices for mesh in meshes], dtype=np.dtype("<f4"))
    normals = [np.ascontiguousarray(mesh.normals, dtype="<f4") for mesh in meshes]
    pieces: list[Any] = [positions, *normals]
    size = positions.nbytes
    views = [_view(0, size, _VERTICES, 12), _view(size, size, _VERTICES, 12)]
    length = 2 * size
    accessors = [*_vector_accessors(positions, [len(mesh.vertices) for mesh in meshes])]

    distinct: dict[tuple[str, bytes], int] = {}
    triangles = [distinct.setdefault(_triangles(mesh), len(distinct)) for mesh in meshes]
    places = [0] * len(distinct)
    for kind, component in _INTEGERS.items():
        offset = 0
        for (found, data), number in distinct.items():
            if found == kind:
                places[number] = len(accessors)
                count = len(data) // np.dtype(kind).itemsize
                accessors.append(
                    b'{"bufferView":%d,"byteOffset":%d,"componentType":%d,"count":%d,'
                    b'"type":"SCALAR"}' % (len(views), offset, component, count)
                )
                pieces.append(data)
                offset += len(data)
        if offset:
            views.append(_view(length, offset, _TRIANGLES))
            length += offset
    return Packed(pieces, length, views, accessors, [places[number] for number in triangles])


def _vector_accessors(positions: Any, counts: Sequence[int]) -> Iterator[bytes]:
    """Accessors of all positions, with their bounds as glTF wants them, and of all normals."""
    starts = list(accumulate(counts, initial=0))
    bounds = boxes(positions, np.array(starts)).reshape(-1, 3)
    # All numbers at once, each as x,y,z: smallest and largest of each mesh in turn.
    corners = to_json(bounds.tolist())[2:-2].split(b"],[")
    vectors = b'"byteOffset":%%d,"componentType":%d,"count":%%d,"type":"VEC3"' % _FLOAT
    position = b'{"bufferView":0,' + vectors + b',"min":[%b],"max":[%b]}'
    normal = b'{"bufferView":1,' + vectors + b"}"
    for number, count in enumerate(counts):
        low, high = corners[2 * number : 2 * number + 2]
        yield position % (12 * starts[number], count, low, high)
    for start, count in zip(starts, counts, strict=False):
        yield normal % (12 * start, count)


def _triangles(mesh: Mesh) -> tuple[str, bytes]:
    kind = "<u2" if len(mesh.vertices) <= MOST_SHORT else "<u4"
    return kind, mesh.faces.astype(kind).tobytes()


def _view(offset: int, length: int, target: int, stride: int | None = None) -> dict[str, int]:
    view = {"buffer": 0, "byteOffset": offset, "byteLength": length, "target": target}
    return view if stride is None else view | {"byteStride": stride}
