"""Triangles cut into smaller ones, so that what is given at their corners may bend."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from app.arrays import Floats, Indices, Singles
from app.solids.mesh import Mesh

_MOST_ROUNDS = 12


def refined(mesh: Mesh, axes: tuple[int, int], longest: float) -> Mesh:
    """The same surface with no edge longer than ``longest``, as seen along the third axis.

    Edges are halved, those of neighbours at the same place to the bit: nothing gapes. A mesh that
    is fine enough is returned itself.
    """
    vertices, normals, faces = mesh.vertices, mesh.normals, mesh.faces.astype(np.int64)
    for _ in range(_MOST_ROUNDS):
        ends = _edges(faces)
        lengths = np.linalg.norm(
            (vertices[ends[:, 1]] - vertices[ends[:, 0]])[:, list(axes)], axis=1
        )
        is_long = lengths > longest
        if not is_long.any():
            break
        halved, which = np.unique(ends[is_long], axis=0, return_inverse=True)
        middles = np.full(len(ends), -1)
        middles[is_long] = len(vertices) + which.reshape(-1)
        faces = _divided(faces, middles.reshape(-1, 3), vertices)
        vertices = np.concatenate([vertices, vertices[halved].mean(axis=1, dtype=np.float32)])
        normals = np.concatenate([normals, _unit(normals[halved].sum(axis=1, dtype=np.float32))])
    if len(vertices) == len(mesh.vertices):
        return mesh
    return Mesh(vertices, normals, faces.astype(np.uint32))


def _edges(faces: Indices) -> Indices:
    """Edges (3 f, 2) of faces (f, 3): those from corner 0, from 1, from 2; smaller number first."""
    return np.sort(np.stack([faces, np.roll(faces, -1, axis=1)], axis=-1).reshape(-1, 2), axis=1)


def _divided(faces: Indices, middles: Indices, vertices: Singles) -> Indices:
    """Faces cut at the ``middles`` (f, 3) of their edges, -1 where an edge stays whole."""
    is_cut = middles >= 0
    count = is_cut.sum(axis=1)
    # Turned so that the first edge is cut where one is, and the last one whole where one is.
    turn = np.where(
        count == 1,
        np.argmax(is_cut, axis=1),
        np.where(count == 2, np.argmin(is_cut, axis=1) + 1, 0),
    )
    order = (turn[:, None] + np.arange(3)) % 3
    a, b, c = np.take_along_axis(faces, order, axis=1).T
    ab, bc, ca = np.take_along_axis(middles, order, axis=1).T
    one, two, three = count == 1, count == 2, count == 3
    # Of the two diagonals of what remains, the shorter.
    whole = two & (_distance(vertices, a, c, b) >= 0)
    return np.concatenate(
        [
            faces[count == 0],
            _rows(one, a, ab, c),
            _rows(one, ab, b, c),
            _rows(two, ab, b, bc),
            _rows(whole, a, ab, bc),
            _rows(whole, a, bc, c),
            _rows(two & ~whole, a, ab, c),
            _rows(two & ~whole, ab, bc, c),
            _rows(three, a, ab, ca),
            _rows(three, ab, b, bc),
            _rows(three, ca, bc, c),
            _rows(three, ab, bc, ca),
        ]
    )


def _rows(chosen: NDArray[np.bool_], *corners: Indices) -> Indices:
    return np.column_stack([corner[chosen] for corner in corners])


def _distance(vertices: Singles, a: Indices, c: Indices, b: Indices) -> Floats:
    """From the middle of a and b to c, less that from the middle of b and c to a; squared."""
    one = (vertices[a] + vertices[b]) / 2 - vertices[c]
    other = (vertices[b] + vertices[c]) / 2 - vertices[a]
    return np.asarray((one**2).sum(axis=1) - (other**2).sum(axis=1))


def _unit(vectors: Singles) -> Singles:
    lengths = np.linalg.norm(vectors, axis=1, keepdims=True)
    return np.asarray(vectors / np.maximum(lengths, 1e-30), dtype=np.float32)
