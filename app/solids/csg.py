"""Constructive solid geometry: a tree of simple solids as one closed body, made once and kept."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from manifold3d import Manifold, OpType

from app.arrays import Floats
from app.errors import DocumentTooLarge, Fault, InconsistentDocument
from app.solids.csg_bounds import bounds_of, scale_of
from app.solids.csg_effort import Effort
from app.solids.csg_surface import leaf_body, surface_of
from app.solids.csg_top import top_of
from app.solids.csg_tree import Leaf, Tree, leaves_of
from app.solids.mesh import Mesh

FAR = 1000.0
"""How far half-spaces alone may meet, of the farthest that any solid or plane says itself."""

SIDES = ((8, 64), (32, 48), (100, 32), (1_000_000, 24))
"""Of circles, by how many round leaves there are: a tree of many has small ones."""

SMALLEST = 2.0**-28
"""Size of a leaf, of the whole: below this its form is lost to rounding."""

ALMOST = 0.9
"""Of the way to the end of the room that an endless body must reach at least."""

MOST_TRIANGLES = 200_000

FEW = 16
"""Bodies that are united at once: so few cannot cross in very many places."""

DUST = 1e-9
"""Lengths, of the whole, that nobody meant."""


@dataclass(frozen=True, slots=True, eq=False)
class Body:
    """What a tree comes to.

    ``mesh`` is centred on ``middle``, that of the box around it, in the tree's axes. ``top`` is
    where a line from above meets it, in the mesh's axes: a line through the tree's origin, or
    through the highest place where that line goes by.
    """

    mesh: Mesh
    middle: tuple[float, float, float]
    size: tuple[float, float, float]
    top: tuple[float, float, float]


def make_body(tree: Tree) -> Body:
    """The body of ``tree``.

    Its surface is closed, and its normals are those of the leaves' own surfaces, with creases where
    these meet. Raises `InconsistentDocument` where nothing is left, or it has no end, or its
    smallest solids cannot be told beside the whole, and `DocumentTooLarge` where it is too much
    work; a fault's place is the tree's own.
    """
    room, is_supposed = _room(tree)
    center = room.mean(axis=0)
    reach = float((room[1] - room[0]).max()) / 2
    manifold = _Making(center, reach, _sides(tree)).made(tree)
    if manifold.num_tri() > MOST_TRIANGLES:
        raise _too_much()
    manifold = _dusted(manifold)
    if manifold.is_empty():
        raise _nothing()
    low, high = np.array(manifold.bounding_box()).reshape(2, 3)
    if is_supposed and max(-low.min(), high.max()) > ALMOST * reach:
        raise _impossible("Half-spaces leave it without an end.")
    middle = (low + high) / 2
    surface = surface_of(manifold.translate((-middle).tolist()))
    if surface is None:
        raise _impossible("It is so thin that it cannot be drawn.")
    size = high - low
    x, y, z = _tidy(center + middle, size)
    width, depth, height = _tidy(size, size)
    mesh = Mesh(surface.vertices, surface.normals, surface.faces)
    top = top_of(mesh, (-x, -y))
    return Body(mesh, (x, y, z), (width, depth, height), top)


def _too_much() -> DocumentTooLarge:
    detail = "Its solids cross each other in too many places: the body would be too complex."
    return DocumentTooLarge([Fault("", detail)])


def _impossible(detail: str) -> InconsistentDocument:
    return InconsistentDocument([Fault("", detail)])


def _nothing() -> InconsistentDocument:
    return _impossible("Nothing is left of it: no place is in the body.")


def _room(tree: Tree) -> tuple[Floats, bool]:
    """A box (2, 3) that holds the body, and whether that was only supposed."""
    bounds = bounds_of(tree)
    if (bounds[0] >= bounds[1]).any():
        raise _nothing()
    if np.isfinite(bounds).all():
        return bounds, False
    far = FAR * scale_of(tree)
    return np.clip(bounds, -far, far), True


def _sides(tree: Tree) -> int:
    count = sum(leaf.form in {"sphere", "cylinder", "cone"} for leaf in leaves_of(tree))
    return next(sides for most, sides in SIDES if count <= most)


def _tidy(lengths: Floats, size: Floats) -> list[float]:
    """Without what the lattice of corners left behind numbers that were round."""
    digits = 9 - int(np.floor(np.log10(size.max())))
    return [round(length, digits) + 0.0 for length in lengths.tolist()]


def _dusted(body: Manifold) -> Manifold:
    """Without the tiny edges and thin skins that rounding leaves where surfaces coincide."""
    low, high = np.array(body.bounding_box()).reshape(2, 3)
    grain = DUST * float((high - low).max())
    shells = body.decompose()
    # A hollow's shell has a negative volume.
    thick = [s for s in shells if 2 * abs(s.volume()) > grain * s.surface_area()]
    if len(thick) < len(shells):
        body = Manifold.compose(thick)
    dusted = body.simplify(grain)
    # Where much is as fine as the grain, simplifying may lose more than grains.
    lost = abs(dusted.volume() - body.volume())
    return dusted if lost <= grain * body.surface_area() else body


class _Making:
    """Puts a tree together about ``center``, as long as that is not too much work."""

    def __init__(self, center: Floats, reach: float, sides: int) -> None:
        self._center, self._reach, self._sides = center, reach, sides
        self._effort = Effort()

    def made(self, tree: Tree) -> Manifold:
        if isinstance(tree, Leaf):
            return self._leaf(tree)
        parts = map(self.made, tree.of)
        match tree.kind:
            case "union":
                return self._united(list(parts))
            case "intersection":
                common = next(parts)
                for part in parts:
                    if common.is_empty():
                        break
                    common = self._checked(common, part) ^ part
                return common
            case "difference":
                first = next(parts)
                tools = list(parts)
                if not tools or first.is_empty():
                    return first
                tool = self._united(tools)
                return self._checked(first, tool) - tool

    def _united(self, parts: list[Manifold]) -> Manifold:
        """All together, a few at once and then two and two: so none is gone through often."""
        if len(parts) > 2:
            few = [parts[first : first + FEW] for first in range(0, len(parts), FEW)]
            parts = [self._few_united(group) for group in few]
        while len(parts) > 1:
            pairs = zip(parts[::2], parts[1::2], strict=False)
            odd = parts[-1:] if len(parts) % 2 else []
            parts = [self._checked(one, other) + other for one, other in pairs] + odd
        return parts[0]

    def _few_united(self, parts: list[Manifold]) -> Manifold:
        if not self._effort.allows_all(parts):
            raise _too_much()
        return Manifold.batch_boolean(parts, OpType.Add)

    def _checked(self, one: Manifold, other: Manifold) -> Manifold:
        if not self._effort.allows(one, other):
            raise _too_much()
        return one

    def _leaf(self, leaf: Leaf) -> Manifold:
        if leaf.form != "half_space" and min(filter(None, leaf.sizes)) < SMALLEST * self._reach:
            raise _impossible("One of its solids is too small to be told beside the whole.")
        return leaf_body(leaf, self._sides, self._center, self._reach)
