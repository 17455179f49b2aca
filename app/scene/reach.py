"""How far a scene reaches in any direction, exactly, without looking at every vertex."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from app.arrays import Floats
from app.placement.turning import matrices
from app.scene.camera import Farthest
from app.scene.scene import Node

_CORNERS = np.array([[i >> 2 & 1, i >> 1 & 1, i & 1] for i in range(8)])


@dataclass(frozen=True, slots=True, eq=False)
class Reach:
    """Nodes that have triangles, their rotations (n, 3, 3) and their boxes' corners (n, 8, 3)."""

    nodes: Sequence[Node]
    rotations: Floats
    corners: Floats

    @staticmethod
    def of(nodes: Sequence[Node], boxes: Floats) -> Reach:
        """Of ``nodes`` whose ``boxes`` (n, 2, 3) in their own axes hold all their vertices.

        Nodes without triangles are left out, whatever their boxes.
        """
        solid = [index for index, node in enumerate(nodes) if node.primitives]
        kept = [nodes[index] for index in solid]
        if not kept:
            return Reach((), np.zeros((0, 3, 3)), np.zeros((0, 8, 3)))
        rotations = matrices(np.array([node.rotation for node in kept]))
        translations = np.array([node.translation for node in kept])
        own = boxes[solid][:, _CORNERS, [0, 1, 2]]
        corners = own @ rotations.transpose(0, 2, 1) + translations[:, None]
        return Reach(kept, rotations, corners)

    @property
    def bounds(self) -> Floats:
        """Smallest and largest corner, exact, (2, 3); the origin twice where there is nothing."""
        return bounds_by(self.farthest if self.nodes else None)

    def farthest(self, direction: Floats) -> Floats:
        """The vertex (3,) that lies farthest along ``direction`` (3,); there must be one.

        Nodes are asked in the order in which their boxes promise, until no box promises more
        than what was found: few are.
        """
        promises = (self.corners.reshape(-1, 3) @ direction).reshape(-1, 8).max(axis=1)
        first = int(promises.argmax())
        best, found = self._asked(first, direction)
        promises[first] = -np.inf
        promising = np.flatnonzero(promises > best)
        for index in promising[np.argsort(-promises[promising], kind="stable")].tolist():
            if promises[index] <= best:
                break
            reached, position = self._asked(index, direction)
            if reached > best:
                best, found = reached, position
        return found

    def _asked(self, index: int, direction: Floats) -> tuple[float, Floats]:
        """How far a node reaches, and with which vertex."""
        node, rotation = self.nodes[index], self.rotations[index]
        own = direction @ rotation
        best, found = -np.inf, self.corners[index, 0]
        for primitive in node.primitives:
            vertices = primitive.mesh.vertices
            vertex = vertices[int(np.argmax(vertices @ own))].astype(np.float64)
            position = rotation @ vertex + node.translation
            reached = float(position @ direction)
            if reached > best:
                best, found = reached, position
        return best, found


def bounds_by(farthest: Farthest | None) -> Floats:
    """Smallest and largest corner of what ``farthest`` knows, (2, 3); of nothing the origin."""
    if farthest is None:
        return np.zeros((2, 3))
    low = [farthest(-axis) @ axis for axis in np.eye(3)]
    high = [farthest(axis) @ axis for axis in np.eye(3)]
    return np.array([low, high])


def farther_of(one: Farthest | None, other: Farthest | None) -> Farthest | None:
    """Who answers for both; ``None`` is nothing."""
    if one is None or other is None:
        return one or other

    def farthest(direction: Floats) -> Floats:
        here, there = one(direction), other(direction)
        return there if there @ direction > here @ direction else here

    return farthest
