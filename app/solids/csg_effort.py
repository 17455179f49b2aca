"""How much work a tree of constructive solid geometry is, found before the work is done."""

from __future__ import annotations

import numpy as np
from manifold3d import Manifold

from app.arrays import Floats

MOST = 2_000_000
"""Triangles gone through and made anew; some seconds of work."""

FEW = 100_000
"""Pairs of triangles that may all cross without anybody minding."""

SHARPNESS = 200_000
"""Crossings that are noticed for certain; they are estimated from as few pairs as that takes."""

HITS = 50
"""Pairs found crossing, on which an estimate of so many rests."""

LEAST = 128
"""Triangles of each surface that are looked at."""


class Effort:
    """Adds up the work on one tree. The same tree always is the same work."""

    __slots__ = ("_left", "_random")

    def __init__(self, most: int = MOST) -> None:
        self._left = float(most)
        self._random = np.random.default_rng(0)

    def allows(self, one: Manifold, other: Manifold) -> bool:
        """Whether what is left of the effort suffices to put two bodies together; takes it off."""
        first, second = one.num_tri(), other.num_tri()
        self._left -= first + second
        if first * second > FEW and self._left > 0:
            self._left -= 2 * self._crossings(one, other)
        return self._left > 0

    def allows_all(self, few: list[Manifold]) -> bool:
        """The same of a few small bodies at once; large ones are too many pairs to be allowed."""
        self._left -= 2 * sum(body.num_tri() for body in few)
        return self._left > 0

    def _crossings(self, one: Manifold, other: Manifold) -> float:
        """About how many triangles of ``one`` cross how many of ``other``."""
        pairs = one.num_tri() * other.num_tri()
        looked_at = max(int(np.sqrt(HITS * pairs / SHARPNESS)), LEAST)
        ours, theirs = self._boxes(one, looked_at), self._boxes(other, looked_at)
        apart = np.zeros((len(ours), len(theirs)), dtype=np.bool_)
        for axis in range(3):
            apart |= ours[:, None, 0, axis] > theirs[None, :, 1, axis]
            apart |= ours[:, None, 1, axis] < theirs[None, :, 0, axis]
        return (1.0 - float(apart.mean())) * float(pairs)

    def _boxes(self, body: Manifold, count: int) -> Floats:
        """Boxes (n, 2, 3) around at most ``count`` triangles."""
        mesh = body.to_mesh()
        faces = mesh.tri_verts
        if len(faces) > count:
            faces = faces[self._random.integers(0, len(faces), count)]
        corners = mesh.vert_properties[:, :3][faces]
        return np.stack([corners.min(axis=1), corners.max(axis=1)], axis=1)
