"""Shapes as a document gives them. What is left out is fitted to the item's label and contents."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from app.program.base import Length, Part, Size
from app.program.csg import CsgNode


class Box(Part):
    """A block with slightly rounded edges; its label stands on the front face."""

    type: Literal["box"]
    size: Size | None = None


class Tray(Part):
    """An open box that other items lie in."""

    type: Literal["tray"]
    size: Size | None = None
    wall: Length | None = None


class Sphere(Part):
    """A ball."""

    type: Literal["sphere"]
    radius: Length | None = None


class Cylinder(Part):
    """A cylinder whose axis is z."""

    type: Literal["cylinder"]
    radius: Length | None = None
    height: Length | None = None


class Cone(Part):
    """A cone whose axis is z, with its tip on top."""

    type: Literal["cone"]
    radius: Length | None = None
    height: Length | None = None


class Arrow(Part):
    """A cylinder and a cone along x, pointing to +x; ``radius`` is the cone's."""

    type: Literal["arrow"]
    length: Length | None = None
    radius: Length | None = None


class Text(Part):
    """The item's label itself, as solid letters; ``height`` is that of a capital letter."""

    type: Literal["text"]
    height: Length | None = None
    depth: Length | None = None


class Csg(Part):
    """A body made of simple solids: a tree of unions, intersections and differences.

    The tree's origin stands where the item's position is.
    """

    type: Literal["csg"]
    tree: CsgNode


Shape = Annotated[
    Box | Tray | Sphere | Cylinder | Cone | Arrow | Text | Csg, Field(discriminator="type")
]
