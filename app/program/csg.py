"""Constructive solid geometry as a document gives it: trees of simple solids."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Annotated, Literal

from pydantic import Field, JsonValue, Strict

from app.errors import DocumentTooLarge, Fault, pointer
from app.program.base import Coordinate, Degrees, Length, Many, Part, Size, Vector
from app.settings import Settings


class CsgPart(Part):
    """A solid in a tree, and where it is among the others."""

    position: Vector | None = Field(
        None, description="Of its own origin, in the axes of what it is part of."
    )
    rotation: Annotated[tuple[Degrees, Degrees, Degrees], Strict(strict=False)] | None = Field(
        None, description="Degrees about x, then y, then z, about its own origin."
    )


class CsgBox(CsgPart):
    """A block around its origin, with sharp edges."""

    type: Literal["box"]
    size: Size


class CsgCylinder(CsgPart):
    """A cylinder around its origin, whose axis is z."""

    type: Literal["cylinder"]
    radius: Length
    height: Length


class CsgCone(CsgPart):
    """A cone around its origin, tip on top; with ``top_radius`` it has no tip but a flat top."""

    type: Literal["cone"]
    radius: Length
    height: Length
    top_radius: Length | None = None


class CsgSphere(CsgPart):
    """A ball around its origin."""

    type: Literal["sphere"]
    radius: Length


class CsgHalfSpace(CsgPart):
    """All that lies behind a plane: it only cuts, having no end itself."""

    type: Literal["half_space"]
    normal: Vector = Field(description="Out of the half-space, of any length.")
    offset: Coordinate = Field(0.0, description="Of the plane from the origin, along the normal.")


class CsgUnion(CsgPart):
    """All that is in any of these."""

    type: Literal["union"]
    of: Many[CsgNode] = Field(min_length=1)


class CsgIntersection(CsgPart):
    """What is in all of these."""

    type: Literal["intersection"]
    of: Many[CsgNode] = Field(min_length=1)


class CsgDifference(CsgPart):
    """The first of these without the others."""

    type: Literal["difference"]
    of: Many[CsgNode] = Field(min_length=1)


CsgNode = Annotated[
    CsgBox
    | CsgCylinder
    | CsgCone
    | CsgSphere
    | CsgHalfSpace
    | CsgUnion
    | CsgIntersection
    | CsgDifference,
    Field(discriminator="type"),
]

CsgOperation = CsgUnion | CsgIntersection | CsgDifference

for _operation in (CsgUnion, CsgIntersection, CsgDifference):
    _operation.model_rebuild()


def refuse_large_trees(document: JsonValue, settings: Settings) -> None:
    """Raise `DocumentTooLarge` where trees are too many, too large or too deep.

    ``document`` is one that nobody has validated yet. Nothing here recurses, and nothing looks at
    more than the limits allow.
    """
    items = document.get("items") if isinstance(document, dict) else None
    total = 0
    for number, item in enumerate(items if isinstance(items, list) else ()):
        shape = item.get("shape") if isinstance(item, dict) else None
        tree = shape.get("tree") if isinstance(shape, dict) else None
        if tree is None:
            continue
        here = pointer("items", number, "shape", "tree")
        for count, depth in _growth(tree):
            if total + count > settings.max_csg_nodes:
                detail = (
                    f"Trees of solids may have at most {settings.max_csg_nodes} nodes in one "
                    "document; here they have more."
                )
                raise DocumentTooLarge([Fault(here, detail)])
            if depth > settings.max_csg_depth:
                detail = f"Trees of solids may be at most {settings.max_csg_depth} deep."
                raise DocumentTooLarge([Fault(here, detail)])
        total += count


def tree_faults(tree: CsgNode, place: Sequence[str | int]) -> Iterator[Fault]:
    """What cannot be right about a tree at ``place``, whatever its solids come to."""
    waiting: list[tuple[CsgNode, tuple[str | int, ...]]] = [(tree, tuple(place))]
    while waiting:
        node, here = waiting.pop()
        if isinstance(node, CsgHalfSpace) and not any(node.normal):
            yield Fault(pointer(*here, "normal"), "A half-space needs a normal that is not zero.")
        if isinstance(node, CsgOperation):
            waiting.extend((node.of[n], (*here, "of", n)) for n in reversed(range(len(node.of))))
    endless = _endless(tree, tuple(place))
    if endless is not None:
        detail = "A half-space has no end: take its intersection with something that has."
        yield Fault(pointer(*endless), detail)


def _endless(tree: CsgNode, place: tuple[str | int, ...]) -> tuple[str | int, ...] | None:
    """The place of a half-space that certainly leaves ``tree`` without an end.

    Where several half-spaces may bound each other, only geometry knows.
    """
    waiting = [(tree, place)]
    while waiting:
        node, here = waiting.pop()
        match node:
            case CsgHalfSpace():
                return here
            case CsgUnion():
                waiting.extend((inner, (*here, "of", n)) for n, inner in enumerate(node.of))
            case CsgIntersection() if len(node.of) == 1:
                waiting.append((node.of[0], (*here, "of", 0)))
            case CsgDifference() if not any(map(_has_half_space, node.of[1:])):
                waiting.append((node.of[0], (*here, "of", 0)))
    return None


def _has_half_space(tree: CsgNode) -> bool:
    waiting = [tree]
    while waiting:
        node = waiting.pop()
        if isinstance(node, CsgHalfSpace):
            return True
        if isinstance(node, CsgOperation):
            waiting.extend(node.of)
    return False


def _growth(tree: JsonValue) -> Iterator[tuple[int, int]]:
    """How many nodes of a tree, and levels, are known after each step down it."""
    level = [tree]
    count = depth = 0
    while level:
        count, depth = count + len(level), depth + 1
        yield count, depth
        level = [entry for node in level for entry in _entries(node)]


def _entries(node: JsonValue) -> list[JsonValue]:
    entries = node.get("of") if isinstance(node, dict) else None
    return entries if isinstance(entries, list) else []
