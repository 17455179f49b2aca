"""Items as nodes: a body each, and its label on it."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import numpy as np

from app.arrays import Singles
from app.notations.notation import ItemStyle, Notation
from app.placement.placement import LabelPlace, Placement
from app.placement.turning import matrices
from app.program.model import Item, Program
from app.scene.color import difference, srgb_of
from app.scene.grain import textured, variant_of
from app.scene.materials import SURFACES, Look, make_material
from app.scene.palette import VANISHING
from app.scene.scene import Material, Node, Primitive, TextureName
from app.solids.mesh import Mesh
from app.solids.meshing import mesh_of
from app.solids.solid import Solid

INKS = ("#1f2933", "#ffffff")
"""For labels whose own colour cannot be read on their item's."""


def item_nodes(
    program: Program,
    notation: Notation,
    placement: Placement,
    materials: dict[Material, int],
    coarseness: float = 0.0,
) -> list[Node]:
    """One node for each item, in the order of the document.

    Equal bodies share one `Mesh`, and so do equal labels. Bodies with a texture are cut from it at
    one of a few places, as their ids say. Others are off by ``coarseness`` (document units) at
    most, where that saves triangles. New materials join ``materials``, which numbers them.
    """
    bodies: dict[Solid, Mesh] = {}
    labels: dict[LabelPlace, Mesh] = {}
    nodes: list[Node] = []
    centers, rotations = placement.centers.tolist(), placement.rotations.tolist()
    for number, item in enumerate(program.items):
        style = notation.item_style(item.kind)
        solid, place = placement.solids[number], placement.labels[number]
        material = _material(item, style)
        if material.texture is not None:
            body = _textured(solid, material.texture, variant_of(item.id))
        else:
            known = bodies.get(solid)
            body = known or bodies.setdefault(solid, mesh_of(solid, coarseness))
        parts = [(body, material)]
        if place is not None and program.style.labels:
            label = labels.get(place)
            if label is None:
                label = labels[place] = _label_mesh(place)
            parts.append((label, make_material("matte", _ink(item, style))))
        nodes.append(
            Node(
                item.id,
                "item",
                tuple(
                    Primitive(mesh, materials.setdefault(material, len(materials)))
                    for mesh, material in parts
                    if len(mesh.faces)
                ),
                tuple(centers[number]),
                tuple(rotations[number]),
                _extras(item),
            )
        )
    return nodes


def _material(item: Item, style: ItemStyle) -> Material:
    """As the document says; what it leaves out, as its kind's style, or the material itself."""
    if item.material is None:
        look = Look(
            style.material,
            item.finish or style.finish,
            _first(item.translucency, style.translucency),
        )
        return make_material(look, item.color or style.color)
    look = Look(item.material, item.finish, item.translucency)
    natural = SURFACES[item.material].natural_color
    return make_material(look, item.color or natural or style.color)


def _first(*values: float | None) -> float | None:
    return next((value for value in values if value is not None), None)


@lru_cache(maxsize=128)
def _textured(solid: Solid, texture: TextureName, variant: int) -> Mesh:
    return textured(mesh_of(solid), texture, variant)


@lru_cache(maxsize=512)
def _label_mesh(place: LabelPlace) -> Mesh:
    """The letters in their item's axes; kept, since an edit leaves most labels where they are."""
    letters = mesh_of(place.text)
    turn = _turn(place.rotation)
    vertices = letters.vertices @ turn
    vertices += np.array(place.position, dtype=np.float32)
    return Mesh(vertices, letters.normals @ turn, letters.faces)


@lru_cache(maxsize=64)
def _turn(rotation: tuple[float, float, float, float]) -> Singles:
    """The matrix (3, 3) that turns rows; most labels are turned alike."""
    return matrices(np.array(rotation)).T.astype(np.float32)


def _ink(item: Item, style: ItemStyle) -> str:
    """The notation's colour for labels, or one that can be read on the item's own colour."""
    if item.color is None:
        return style.label_color
    paper = srgb_of(item.color)
    if difference(srgb_of(style.label_color), paper) >= VANISHING:
        return style.label_color
    return max(INKS, key=lambda ink: float(difference(srgb_of(ink), paper)))


def _extras(item: Item) -> dict[str, Any]:
    """What the document says of the item, apart from how it looks."""
    extras: dict[str, Any] = {"shows": "item", "id": item.id}
    if item.kind is not None:
        extras["kind"] = item.kind
    if item.label is not None:
        extras["label"] = item.label
    if item.parent is not None:
        extras["parent"] = item.parent
    if item.data:
        extras["data"] = item.data
    return extras
