"""Hyperedges as nodes: all tubes of one hyperedge, around their own middle."""

from __future__ import annotations

from typing import Any

from app.arrays import Floats
from app.notations.notation import Notation
from app.program.model import Hyperedge, Program
from app.scene.boxes import around_their_middles
from app.scene.color import srgb_of
from app.scene.materials import make_materials
from app.scene.palette import colors
from app.scene.scene import Material, Node, Primitive
from app.solids.mesh import Mesh
from app.tubes.tubes import Tubes

UPRIGHT = (0.0, 0.0, 0.0, 1.0)


def hyperedge_nodes(
    program: Program,
    notation: Notation,
    tubes: Tubes,
    radii: Floats,
    background: Floats | None,
    materials: dict[Material, int],
) -> tuple[list[Node], Floats]:
    """One node for each hyperedge, in the order of the document, and their boxes (h, 2, 3).

    ``radii`` (h,) are the tubes'; ``background`` is sRGB (3,) or ``None``. Vertices and boxes are
    relative to the node's translation. New materials join ``materials``, which numbers them.
    """
    vertices, middles, around = around_their_middles(tubes.vertices, tubes.vertex_starts)
    first_vertices, first_faces = tubes.vertex_starts.tolist(), tubes.face_starts.tolist()
    nodes = [
        _node(
            hyperedge,
            Mesh(vertices[start:end], tubes.normals[start:end], tubes.faces[first:last]),
            materials.setdefault(material, len(materials)),
            (x, y, z),
            radius,
        )
        for hyperedge, start, end, first, last, material, (x, y, z), radius in zip(
            program.hyperedges,
            first_vertices[:-1],
            first_vertices[1:],
            first_faces[:-1],
            first_faces[1:],
            _materials(program, notation, background),
            middles.tolist(),
            radii.tolist(),
            strict=True,
        )
    ]
    return nodes, around


def _node(
    hyperedge: Hyperedge,
    mesh: Mesh,
    material: int,
    translation: tuple[float, float, float],
    radius: float,
) -> Node:
    primitives = (Primitive(mesh, material),) if len(mesh.faces) else ()
    return Node(
        hyperedge.id, "hyperedge", primitives, translation, UPRIGHT, _extras(hyperedge), radius
    )


def _materials(program: Program, notation: Notation, background: Floats | None) -> list[Material]:
    """Its own colour, or its kind's, or the palette's.

    Every hyperedge takes one from the palette, whether it shows it or not: so a colour given to
    one does not change the others'.
    """
    chosen = colors(program.style.palette, len(program.hyperedges), background)
    names = []
    for number, hyperedge in enumerate(program.hyperedges):
        style = notation.hyperedge_style(hyperedge.kind)
        names.append(hyperedge.material or style.material)
        given = hyperedge.color or style.color
        if given is not None:
            chosen[number] = srgb_of(given)
    return make_materials(names, chosen)


def _extras(hyperedge: Hyperedge) -> dict[str, Any]:
    """What the document says of the hyperedge, apart from how it looks."""
    extras: dict[str, Any] = {"shows": "hyperedge", "id": hyperedge.id}
    if hyperedge.kind is not None:
        extras["kind"] = hyperedge.kind
    if hyperedge.label is not None:
        extras["label"] = hyperedge.label
    extras["attachments"] = [
        {"item": end.item} if end.point is None else {"item": end.item, "point": end.point}
        for end in hyperedge.attachments
    ]
    if hyperedge.data:
        extras["data"] = hyperedge.data
    return extras
