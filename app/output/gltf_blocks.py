"""Meshes as views and accessors: what is stored of them, and how to read it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pydantic_core import to_json

from app.arrays import Floats, Indices
from app.output import gltf_numbers as numbers
from app.output.gltf_chunks import MOST_SHORT, Chunk, merge
from app.output.gltf_views import View, triangles, vertices
from app.output.media import Compression
from app.scene.boxes import boxes
from app.solids.mesh import Mesh

# Components of accessors, by OpenGL's numbers.
_BYTE, _UNSIGNED_BYTE, _SHORT, _UNSIGNED_SHORT, _FLOAT = 5120, 5121, 5122, 5123, 5126
_INTEGERS = {"<u4": 5125, "<u2": 5123}


@dataclass(frozen=True, slots=True)
class Accessor:
    """JSON without braces and without the view, which is number ``view`` of its block."""

    view: int
    text: bytes


@dataclass(frozen=True, slots=True, eq=False)
class Block:
    """Meshes that are stored alike, and together.

    ``primitives`` are, for each mesh, the numbers within the block of the accessors of its
    ``attributes``, and last that of its triangles.
    """

    views: list[View]
    accessors: list[Accessor]
    attributes: tuple[str, ...]
    primitives: list[tuple[int, ...]]


def block_of(
    meshes: Sequence[Mesh],
    compress: Compression,
    finest: float,
    steps: Floats | None = None,
) -> Block:
    """A block of ``meshes``, each of one triangle or more; equal triangles are stored once.

    Either all have coordinates in a texture, or none has. With ``steps`` (m,) positions are
    numbered by 16 bits on grids so wide. Without, they are floats; where these are encoded,
    rounding moves no vertex by more than ``finest``.
    """
    starts = numbers.starts_of([len(mesh.vertices) for mesh in meshes])
    columns = [
        _positions(meshes, starts, compress, finest, steps),
        _normals(meshes, starts, compress),
    ]
    if meshes[0].coordinates is None:
        return _block(("POSITION", "NORMAL"), columns, meshes, compress)
    columns.append(_coordinates(meshes, starts, compress))
    return _block(("POSITION", "NORMAL", "TEXCOORD_0"), columns, meshes, compress)


def block_of_chunk(chunk: Chunk, compress: Compression, finest: float) -> Block:
    """A block of the only mesh of ``chunk``, with its members' colours and numbers."""
    merged = merge(chunk)
    meshes, starts = [merged.mesh], numbers.starts_of([len(merged.members)])
    encode = compress == "meshopt"
    steps = None if compress == "none" or chunk.step is None else np.array([chunk.step])
    features = np.zeros((len(merged.members), 2), dtype="<u2")  # the second fills four bytes
    features[:, 0] = merged.members
    columns = [
        _positions(meshes, starts, compress, finest, steps),
        _normals(meshes, starts, compress),
        _Column(
            vertices([merged.colors[merged.members]], encode=encode),
            _texts(starts, 4, _UNSIGNED_BYTE, b"VEC4", normalized=True),
        ),
        _Column(
            vertices([features], encode=encode),
            _texts(starts, 4, _UNSIGNED_SHORT, b"SCALAR"),
        ),
    ]
    return _block(("POSITION", "NORMAL", "COLOR_0", "_FEATURE_ID_0"), columns, meshes, compress)


@dataclass(frozen=True, slots=True, eq=False)
class _Column:
    """One attribute of all meshes: its view, and a text for each mesh's accessor."""

    view: View
    texts: list[bytes]


def _block(
    attributes: tuple[str, ...],
    columns: Sequence[_Column],
    meshes: Sequence[Mesh],
    compress: Compression,
) -> Block:
    views = [column.view for column in columns]
    accessors = [
        Accessor(number, text) for number, column in enumerate(columns) for text in column.texts
    ]
    places = _add_triangles(meshes, views, accessors, encode=compress == "meshopt")
    count = len(meshes)
    primitives = [
        (*(number + row * count for row in range(len(columns))), place)
        for number, place in enumerate(places)
    ]
    return Block(views, accessors, attributes, primitives)


def _positions(
    meshes: Sequence[Mesh],
    starts: Indices,
    compress: Compression,
    finest: float,
    steps: Floats | None,
) -> _Column:
    """Positions, with their bounds as glTF wants them: as they are read back."""
    positions = np.concatenate([mesh.vertices for mesh in meshes], dtype=np.dtype("<f4"))
    encode = compress == "meshopt"
    if steps is not None:
        rows = numbers.on_grid(positions, starts, steps)
        texts = _texts(starts, 8, _SHORT, b"VEC3", rows[:, :3], normalized=True)
        return _Column(vertices([rows], encode=encode), texts)
    if not encode:
        return _Column(
            vertices([positions], encode=False), _texts(starts, 12, _FLOAT, b"VEC3", positions)
        )
    positions, coded = numbers.rounded(positions, starts, finest)
    return _Column(
        vertices([coded], encode=True, filtered="EXPONENTIAL"),
        _texts(starts, 12, _FLOAT, b"VEC3", positions),
    )


def _normals(meshes: Sequence[Mesh], starts: Indices, compress: Compression) -> _Column:
    if compress == "none":
        # Not joined: what need not be copied is not.
        pieces = [np.ascontiguousarray(mesh.normals, dtype="<f4") for mesh in meshes]
        return _Column(vertices(pieces, encode=False), _texts(starts, 12, _FLOAT, b"VEC3"))
    normals = np.concatenate([mesh.normals for mesh in meshes])
    texts = _texts(starts, 4, _BYTE, b"VEC3", normalized=True)
    if compress == "quantize":
        return _Column(vertices([numbers.small_normals(normals)], encode=False), texts)
    folded = numbers.folded_normals(normals)
    return _Column(vertices([folded], encode=True, filtered="OCTAHEDRAL"), texts)


def _coordinates(meshes: Sequence[Mesh], starts: Indices, compress: Compression) -> _Column:
    """Places in a texture, as floats: they go beyond 1, where 16 bits would end."""
    found = [mesh.coordinates for mesh in meshes if mesh.coordinates is not None]
    pieces = [np.ascontiguousarray(rows, dtype="<f4") for rows in found]
    encode = compress == "meshopt"
    return _Column(vertices(pieces, encode=encode), _texts(starts, 8, _FLOAT, b"VEC2"))


def _texts(
    starts: Indices,
    stride: int,
    component: int,
    kind: bytes,
    bounded: NDArray[Any] | None = None,
    *,
    normalized: bool = False,
) -> list[bytes]:
    """Accessors of one attribute of all meshes, with the bounds of the rows ``bounded`` (v, 3)."""
    text = b'"byteOffset":%%d,"componentType":%d,"count":%%d,"type":"%b"' % (component, kind)
    if normalized:
        text += b',"normalized":true'
    places = zip((starts[:-1] * stride).tolist(), np.diff(starts).tolist(), strict=True)
    if bounded is None:
        return [text % place for place in places]
    text += b',"min":[%b],"max":[%b]'
    found = boxes(bounded, starts).reshape(-1, 3)
    if component != _FLOAT:
        found = found.astype(np.int64)
    # All numbers at once, each as x,y,z: smallest and largest of each mesh in turn.
    corners = to_json(found.tolist())[2:-2].split(b"],[")
    return [
        text % (*place, low, high)
        for place, low, high in zip(places, corners[::2], corners[1::2], strict=True)
    ]


def _add_triangles(
    meshes: Sequence[Mesh], views: list[View], accessors: list[Accessor], *, encode: bool
) -> list[int]:
    """Add views and accessors of the meshes' triangles; the number of each mesh's accessor."""
    all_indices = [_indices(mesh) for mesh in meshes]
    distinct: dict[tuple[str, bytes], int] = {}
    found = [0] * len(meshes)
    if len(meshes) > 1:
        found = [
            distinct.setdefault((own.dtype.str, own.tobytes()), number)
            for number, own in enumerate(all_indices)
        ]
    places: dict[int, int] = {}
    for kind, component in _INTEGERS.items():
        pieces: list[NDArray[Any]] = []
        offset = 0
        for number in dict.fromkeys(found):
            own = all_indices[number]
            if own.dtype == kind:
                places[number] = len(accessors)
                text = b'"byteOffset":%d,"componentType":%d,"count":%d,"type":"SCALAR"'
                accessors.append(Accessor(len(views), text % (offset, component, len(own))))
                pieces.append(own)
                offset += own.nbytes
        if pieces:
            views.append(triangles(pieces, encode=encode))
    return [places[number] for number in found]


def _indices(mesh: Mesh) -> NDArray[Any]:
    """Vertex numbers (3 f,), short ones where they will do."""
    kind = "<u2" if len(mesh.vertices) <= MOST_SHORT else "<u4"
    return mesh.faces.astype(kind).reshape(-1)
