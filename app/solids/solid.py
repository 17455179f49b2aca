"""Solids with every size known: what placement decides and meshes are made from.

All are centred on the origin in their own axes; z is up.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

from app.solids.csg_tree import Tree

Size: TypeAlias = tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class Box:
    """A block of ``size`` with edges rounded by ``edge``."""

    size: Size
    edge: float


@dataclass(frozen=True, slots=True)
class Tray:
    """An open box of outer ``size``: a floor ``floor`` thick within walls ``wall`` thick."""

    size: Size
    wall: float
    floor: float


@dataclass(frozen=True, slots=True)
class Sphere:
    """A ball."""

    radius: float


@dataclass(frozen=True, slots=True)
class Cylinder:
    """A cylinder along z, with its rims rounded by ``edge``."""

    radius: float
    height: float
    edge: float


@dataclass(frozen=True, slots=True)
class Cone:
    """A cone along z, tip on top."""

    radius: float
    height: float


@dataclass(frozen=True, slots=True)
class Arrow:
    """A cylinder and a cone along x, pointing to +x; ``radius`` is the cone's."""

    length: float
    radius: float


@dataclass(frozen=True, slots=True)
class Text:
    """Letters in the plane z = 0, reading along x, extruded by ``depth`` half up, half down.

    ``height`` is that of a capital letter. The box of the letters is centred on the origin.
    """

    text: str
    height: float
    depth: float


@dataclass(frozen=True, slots=True)
class Csg:
    """What a tree of simple solids comes to, of ``size``.

    The box around it is centred on the origin; the tree's own origin is at -``middle``. ``top`` is
    where something that comes from above meets it.
    """

    tree: Tree
    size: Size
    middle: Size
    top: Size


Solid: TypeAlias = Box | Tray | Sphere | Cylinder | Cone | Arrow | Text | Csg
