"""Constructive solid geometry: simple solids in one frame, and how they are put together."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal, TypeAlias

Triple: TypeAlias = tuple[float, float, float]

Form = Literal["box", "cylinder", "cone", "sphere", "half_space"]


@dataclass(frozen=True, slots=True)
class Leaf:
    """A simple solid about its own origin, turned by a quaternion and moved to ``position``.

    ``sizes`` are those of a box, radius and height of a cylinder, lower radius, height and upper
    radius of a cone, a sphere's radius. A half-space is what lies at most ``sizes[0]`` along its
    own z.
    """

    form: Form
    sizes: tuple[float, ...]
    rotation: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 1.0)
    position: Triple = (0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class Operation:
    """A union, an intersection, or the first without the others."""

    kind: Literal["union", "intersection", "difference"]
    of: tuple[Tree, ...]


Tree: TypeAlias = Leaf | Operation


def leaves_of(tree: Tree) -> Iterator[Leaf]:
    """All leaves, in order.

    >>> ball = Leaf("sphere", (1.0,))
    >>> len(list(leaves_of(Operation("union", (ball, Operation("union", (ball,)))))))
    2
    """
    waiting = [tree]
    while waiting:
        node = waiting.pop()
        if isinstance(node, Leaf):
            yield node
        else:
            waiting.extend(reversed(node.of))
