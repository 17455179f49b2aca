"""Random trees of constructive solid geometry, and what is inside them by their own account."""

from __future__ import annotations

import numpy as np
from hypothesis import strategies as st

from app.arrays import Floats
from app.solids.csg_leaves import rotation_of
from app.solids.csg_tree import Form, Leaf, Operation, Tree, leaves_of

lengths = st.floats(0.3, 1.5)
places = st.tuples(*[st.floats(-1.2, 1.2)] * 3)
turns = st.one_of(
    st.just((0.0, 0.0, 0.0, 1.0)),
    st.just((0.5**0.5, 0.0, 0.0, 0.5**0.5)),
    st.tuples(*[st.floats(-1.0, 1.0)] * 4)
    .filter(lambda turn: sum(part**2 for part in turn) > 0.1)
    .map(lambda turn: tuple((np.array(turn) / np.linalg.norm(turn)).tolist())),
)


def leaf(form: Form, *sizes: st.SearchStrategy[float]) -> st.SearchStrategy[Leaf]:
    return st.builds(Leaf, st.just(form), st.tuples(*sizes), turns, places)


solids = st.one_of(
    leaf("box", lengths, lengths, lengths),
    leaf("cylinder", lengths, lengths),
    leaf("cone", lengths, lengths, st.just(0.0) | lengths),
    leaf("sphere", lengths),
)
half_spaces = leaf("half_space", st.floats(-0.5, 0.5))


def trees(most_leaves: int) -> st.SearchStrategy[Tree]:
    """Trees that have an end: half-spaces cut, but stand nowhere alone."""
    return st.recursive(
        solids,
        lambda inner: st.one_of(
            st.builds(
                Operation,
                st.sampled_from(["union", "intersection", "difference"]),
                st.lists(inner, min_size=1, max_size=3).map(tuple),
            ),
            st.builds(
                Operation, st.sampled_from(["intersection", "difference"]),
                st.tuples(inner, half_spaces),
            ),
        ),
        max_leaves=most_leaves,
    )  # fmt: skip


def contains(tree: Tree, points: Floats) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    """Whether points (p, 3) are inside, by what union, intersection and difference mean."""
    if isinstance(tree, Leaf):
        return np.asarray(height_over(tree, points) < 0)
    first, *others = [contains(part, points) for part in tree.of]
    for other in others:
        match tree.kind:
            case "union":
                first = first | other
            case "intersection":
                first = first & other
            case "difference":
                first = first & ~other
    return first


def clear_of_surfaces(
    tree: Tree, points: Floats, margin: float
) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    """Whether points (p, 3) are more than ``margin`` from the surface of every leaf."""
    heights = [np.abs(height_over(leaf, points)) for leaf in leaves_of(tree)]
    return np.asarray(np.min(heights, axis=0) > margin)


def height_over(leaf: Leaf, points: Floats) -> Floats:
    """At most the distance of points (p, 3) to a leaf's surface, negative inside."""
    own = (points - leaf.position) @ rotation_of(leaf)
    across, z = np.hypot(own[:, 0], own[:, 1]), own[:, 2]
    match leaf.form:
        case "sphere":
            return np.asarray(np.linalg.norm(own, axis=1) - leaf.sizes[0])
        case "half_space":
            return np.asarray(z - leaf.sizes[0])
        case "box":
            return np.asarray((np.abs(own) - np.array(leaf.sizes) / 2).max(axis=1))
        case "cylinder":
            radius, height = leaf.sizes
            return np.asarray(np.maximum(across - radius, np.abs(z) - height / 2))
        case "cone":
            low, height, high = leaf.sizes
            beyond = across - low - (high - low) * (z / height + 0.5)
            slope = height / np.hypot(height, low - high)
            return np.asarray(np.maximum(beyond * slope, np.abs(z) - height / 2))
