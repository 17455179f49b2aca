"""Where a tree of constructive solid geometry can reach, before any of it is made."""

from __future__ import annotations

from math import inf

import numpy as np

from app.arrays import Floats
from app.solids.csg_leaves import rotation_of
from app.solids.csg_tree import Leaf, Tree, leaves_of

UPRIGHT = 1e-12
"""Components of a unit normal that count as none: what is left of them after turning."""


def bounds_of(tree: Tree) -> Floats:
    """A box (2, 3) that holds all of ``tree``; infinite where half-spaces may reach for ever.

    Nothing is there at all where its lowest corner is beyond its highest.
    """
    if isinstance(tree, Leaf):
        return _leaf_bounds(tree)
    parts = [bounds_of(part) for part in tree.of]
    match tree.kind:
        case "union":
            solid = [part for part in parts if (part[0] <= part[1]).all()] or parts[:1]
            return np.array(
                [np.min([p[0] for p in solid], axis=0), np.max([p[1] for p in solid], axis=0)]
            )
        case "intersection":
            return np.array(
                [np.max([p[0] for p in parts], axis=0), np.min([p[1] for p in parts], axis=0)]
            )
        case "difference":
            return parts[0]


def _leaf_bounds(leaf: Leaf) -> Floats:
    position, frame = np.array(leaf.position), rotation_of(leaf)
    if leaf.form == "half_space":
        return _behind(frame[:, 2], float(frame[:, 2] @ position) + leaf.sizes[0])
    half = np.full(3, leaf.sizes[0]) if leaf.form == "sphere" else np.abs(frame) @ _half(leaf)
    return np.array([position - half, position + half])


def _half(leaf: Leaf) -> Floats:
    """Half the size of the box around a leaf in its own axes."""
    match leaf.form:
        case "box":
            return np.array(leaf.sizes) / 2
        case "cylinder":
            radius, height = leaf.sizes
            return np.array([radius, radius, height / 2])
        case _:
            low, height, high = leaf.sizes
            return np.array([max(low, high), max(low, high), height / 2])


def _behind(normal: Floats, offset: float) -> Floats:
    """Half of space: bounded on one side where its plane is upright or level."""
    bounds = np.array([[-inf] * 3, [inf] * 3])
    axis = int(np.argmax(np.abs(normal)))
    if np.abs(np.delete(normal, axis)).max() < UPRIGHT:
        bounds[1 if normal[axis] > 0 else 0, axis] = offset / normal[axis]
    return bounds


def scale_of(tree: Tree) -> float:
    """How far solids reach from the origin, and how far planes of half-spaces are from it."""
    found = [1e-3]
    for leaf in leaves_of(tree):
        if leaf.form == "half_space":
            normal = rotation_of(leaf)[:, 2]
            found.append(abs(float(normal @ np.array(leaf.position)) + leaf.sizes[0]))
        else:
            found.append(float(np.abs(_leaf_bounds(leaf)).max()))
    return max(found)
