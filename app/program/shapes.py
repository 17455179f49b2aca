"""Shapes as a document gives them. What is left out is fitted to the item's label and contents."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, Strict

from app.program.base import Part

Length = Annotated[float, Field(ge=1e-3, le=1e5, allow_inf_nan=False)]
"""A size in document units: positive, finite, and within what single precision can draw."""

Size = Annotated[tuple[Length, Length, Length], Strict(strict=False)]


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


Shape = Annotated[Box | Tray | Sphere | Cylinder | Cone | Arrow | Text, Field(discriminator="type")]
