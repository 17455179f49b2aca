"""Leaves of a tree of constructive solid geometry as triangles, with exact normals."""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from math import hypot

import numpy as np

from app.arrays import Faces, Floats, Indices
from app.solids.csg_tree import Form, Leaf
from app.solids.lathe import Profile, circle, corner, point, quarters, rectangle, turn_exactly

LATTICE = 2.0**-50
"""Of the whole: steps that corners are rounded to, so that what was turned by right angles is where
it would be unturned. They are far below what the library takes for equal, and have to be."""


def leaf_surface(
    leaf: Leaf, sides: int, center: Floats, reach: float
) -> tuple[Floats, Floats, Faces]:
    """Vertices (v, 3) about ``center``, unit normals (v, 3) and faces (f, 3), in the tree's axes.

    A circle has ``sides``. Nothing farther than ``reach`` from ``center`` (3,) along any axis
    matters: a half-space ends beyond that.
    """
    away = np.array(leaf.position) - center
    vertices, normals, faces = _own(leaf, sides, 2.0 * reach + float(np.linalg.norm(away)))
    frame = rotation_of(leaf)
    step = 2.0 ** np.ceil(np.log2(reach)) * LATTICE
    placed = vertices @ frame.T + away
    return np.rint(placed / step) * step + 0.0, normals @ frame.T, faces


def doubles_of(leaf: Leaf, sides: int) -> tuple[Indices, Indices]:
    """Which vertices of a leaf are where another is that came before, and which that is."""
    return _doubles(leaf.form, sides, leaf.form == "cone" and leaf.sizes[2] == 0.0)


@lru_cache(maxsize=32)
def _doubles(form: Form, sides: int, is_pointed: bool) -> tuple[Indices, Indices]:
    vertices = _own(Leaf(form, _ORDINARY[form, is_pointed]), sides, 1.0)[0]
    _, firsts, numbers = np.unique(vertices, axis=0, return_index=True, return_inverse=True)
    before = firsts[numbers.ravel()]
    doubles = np.flatnonzero(before != np.arange(len(vertices)))
    return doubles, before[doubles]


_ORDINARY: Mapping[tuple[Form, bool], tuple[float, ...]] = {
    ("box", False): (1.0, 1.0, 1.0),
    ("cylinder", False): (1.0, 1.0),
    ("cone", False): (1.0, 1.0, 0.5),
    ("cone", True): (1.0, 1.0, 0.0),
    ("sphere", False): (1.0,),
    ("half_space", False): (0.0,),
}
"""Sizes that stand for all: where corners meet does not depend on them."""


def rotation_of(leaf: Leaf) -> Floats:
    """The matrix (3, 3) that turns columns as the leaf is turned."""
    x, y, z, w = np.array(leaf.rotation) / np.linalg.norm(leaf.rotation)
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )


def _own(leaf: Leaf, sides: int, far: float) -> tuple[Floats, Floats, Faces]:
    match leaf.form:
        case "sphere":
            normals = quarters(-1, 2, sides // 4)
            return _turned(np.column_stack([leaf.sizes[0] * normals, normals]), sides)
        case "cylinder":
            radius, height = leaf.sizes
            return _turned(_spool(radius, height, radius), sides)
        case "cone":
            radius, height, top = leaf.sizes
            return _turned(_spool(radius, height, top), sides)
        case "box":
            x, y, z = leaf.sizes
            return _block(x / 2, y / 2, -z / 2, z / 2)
        case "half_space":
            return _block(far, far, -far, leaf.sizes[0])


def _spool(low: float, height: float, high: float) -> Profile:
    z = height / 2
    slant = hypot(height, low - high)
    sideways = (height / slant, (low - high) / slant)
    profile = [
        point(0.0, -z, (0.0, -1.0)),
        point(low, -z, (0.0, -1.0)),
        point(low, -z, sideways),
        point(high, z, sideways),
    ]
    if high:
        profile += [point(high, z, (0.0, 1.0)), point(0.0, z, (0.0, 1.0))]
    return np.concatenate(profile)


def _block(x: float, y: float, low: float, high: float) -> tuple[Floats, Floats, Faces]:
    profile = np.concatenate([corner(1.0, low, -1, 0.0, 1), corner(1.0, high, 0, 0.0, 1)])
    vertices, normals, faces = turn_exactly(rectangle(0.0, 0.0, 0), profile)
    return vertices * (x, y, 1.0), normals, faces


def _turned(profile: Profile, sides: int) -> tuple[Floats, Floats, Faces]:
    return turn_exactly(circle(sides), profile)
