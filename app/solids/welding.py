"""Triangles as files without normals hold them: one vertex for each position."""

from __future__ import annotations

import numpy as np

from app.arrays import Faces, Floats, Indices, Singles

_ATTEMPTS = 16
"""At parting vertices; each moves them a step farther."""

_KEY = np.array([0x1E3779B97F4A7C15, 0x42B2AE3D27D4EB4F, 0x165667B19E3779F9])
"""Odd numbers with mixed bits, whose multiples tell positions apart."""

_COARSE = 8.0
"""Steps. Where half of its faces are narrower, a body has lost its form to rounding."""


def weld(vertices: Singles, faces: Faces) -> tuple[Singles, Faces]:
    """The distinct positions of ``vertices`` (v, 3), and ``faces`` (f, 3) by their numbers.

    Faces two of whose corners are at the same position are left out. Positions stay in the order
    in which they first come.

    >>> corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 0, 0]], dtype=np.float32)
    >>> positions, faces = weld(corners, np.array([[0, 1, 2], [1, 2, 3]], dtype=np.uint32))
    >>> len(positions), faces.tolist()
    (3, [[0, 1, 2]])
    """
    # Adding 0 makes -0 and 0 the same bits.
    keys = np.ascontiguousarray(vertices + np.float32(0)).view("V12").ravel()
    _, firsts, numbers = np.unique(keys, return_index=True, return_inverse=True)
    order = np.argsort(firsts)
    ranks = np.empty_like(order)
    ranks[order] = np.arange(len(order))
    welded = ranks[numbers.ravel()][faces].reshape(-1, 3)
    distinct = (welded != np.roll(welded, 1, axis=1)).all(axis=1)
    return vertices[firsts[order]], welded[distinct].astype(np.uint32)


def part(vertices: Floats, faces: Faces) -> Singles | None:
    """``vertices`` (v, 3) in single precision, no two of them at one position.

    Rounding may put vertices that are very near, or the edges of two sides of a body, at one
    position, and what was closed is so no more to those who see nothing but positions. Here all are
    rounded to one lattice, and of those at one point all but one move some steps into the body that
    ``faces`` (f, 3) bound. None where rounding leaves nothing of the form, or they are too many to
    part.
    """
    step = float(np.spacing(np.float32(np.abs(vertices).max(initial=0.0))))
    exact = vertices / step
    start, stop = edges_of(faces).T
    lengths = np.abs(exact[stop] - exact[start]).max(axis=1).reshape(-1, 3)
    if len(faces) and np.median(lengths.min(axis=1)) < _COARSE:
        return None
    places = np.rint(exact).astype(np.int64)
    inward: Floats | None = None
    for attempt in range(_ATTEMPTS):
        # Where two keys agree by chance, a vertex moves for nothing: by a step or two.
        _, firsts = np.unique((places * _KEY).sum(axis=1), return_index=True)
        if len(firsts) == len(places):
            return (places * step).astype(np.float32)
        if inward is None:
            inward = -normals_of(vertices, faces)
        moved = np.ones(len(places), dtype=np.bool_)
        moved[firsts] = False
        places[moved] = np.rint(exact[moved] + (1.5 + attempt) * inward[moved])
    return None


def normals_of(vertices: Floats | Singles, faces: Faces) -> Floats:
    """Unit normals (v, 3): means of those of the ``faces`` around each vertex, by their areas."""
    corners = vertices[faces].astype(np.float64)
    crossed = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    around, count = faces.ravel(), len(vertices)
    sums = np.stack(
        [np.bincount(around, np.repeat(part, 3), minlength=count) for part in crossed.T], axis=1
    )
    lengths = np.linalg.norm(sums, axis=1)
    flat = ~(lengths > 0.0)
    sums[flat], lengths[flat] = (0.0, 0.0, 1.0), 1.0
    return np.asarray(sums / lengths[:, None])


def is_closed(faces: Faces) -> bool:
    """Whether faces (f, 3) bound a body: each edge belongs to two of them, which agree on its way.

    Numbers of vertices stand for positions (`weld`).

    >>> is_closed(np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]], dtype=np.uint32))
    True
    >>> is_closed(np.array([[0, 2, 1]], dtype=np.uint32))
    False
    """
    start, stop = (
        faces.astype(np.int64).ravel(),
        np.roll(faces, -1, axis=1).astype(np.int64).ravel(),
    )
    forth, back = np.sort(start << 32 | stop), np.sort(stop << 32 | start)
    return bool(np.all(forth[1:] != forth[:-1]) and np.array_equal(forth, back))


def edges_of(faces: Faces) -> Indices:
    """The edges (3f, 2) of faces (f, 3), each once for each of its faces."""
    return np.stack([faces, np.roll(faces, -1, axis=1)], axis=-1).reshape(-1, 2)
