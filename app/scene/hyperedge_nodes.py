"""Hyperedges as nodes: all tubes of one hyperedge, around their own middle; or as a crowd."""

from __future__ import annotations

from typing import Any

import numpy as np

from app.arrays import Floats, Indices
from app.notations.notation import HyperedgeStyle, Notation
from app.program.model import Hyperedge, Program
from app.scene.boxes import around_their_middles
from app.scene.color import linear_of
from app.scene.curve_reach import curve_boxes
from app.scene.grain import textured_tubes, variant_of
from app.scene.hyperedge_colors import hyperedge_colors
from app.scene.materials import Look, in_white, make_material, make_materials
from app.scene.scene import Crowd, Material, Node, Primitive
from app.solids.mesh import Mesh
from app.tubes.tubes import Tubes
from app.tubes.unswept import UnsweptTubes

UPRIGHT = (0.0, 0.0, 0.0, 1.0)


def hyperedge_nodes(
    program: Program,
    notation: Notation,
    tubes: Tubes,
    radii: Floats,
    background: Floats | None,
    materials: dict[Material, int],
    hues: Indices | None = None,
) -> tuple[list[Node], Floats]:
    """One node for each hyperedge, in the order of the document, and their boxes (h, 2, 3).

    ``radii`` (h,) are the tubes'; ``background`` is sRGB (3,) or ``None``; ``hues`` (h,) say which
    colour of the palette each takes, left out they take one after another. Vertices and boxes are
    relative to the node's translation. New materials join ``materials``, which numbers them.
    """
    vertices, middles, around = around_their_middles(tubes.vertices, tubes.vertex_starts)
    first_vertices, first_faces = tubes.vertex_starts.tolist(), tubes.face_starts.tolist()
    nodes = [
        _node(
            hyperedge,
            _mesh(
                hyperedge,
                Mesh(vertices[start:end], tubes.normals[start:end], tubes.faces[first:last]),
                material,
                radius,
            ),
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
            _materials(program, notation, background, hues),
            middles.tolist(),
            radii.tolist(),
            strict=True,
        )
    ]
    return nodes, around


def _mesh(hyperedge: Hyperedge, mesh: Mesh, material: Material, radius: float) -> Mesh:
    """With coordinates, where the material has a texture."""
    if material.texture is None:
        return mesh
    return textured_tubes(mesh, material.texture, radius, variant_of(hyperedge.id))


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


def crowd_of(
    program: Program,
    notation: Notation,
    tubes: UnsweptTubes,
    background: Floats | None,
    hues: Indices | None = None,
) -> Crowd:
    """All hyperedges without nodes, in the order of the document; else as `hyperedge_nodes`."""
    looks, chosen = _styles(program, notation, background, hues)
    known: dict[Look, int] = {}
    surfaces = np.array([known.setdefault(look, len(known)) for look in looks], dtype=np.int64)
    return Crowd(
        swept=tubes.swept,
        vertex_counts=tubes.vertex_counts,
        boxes=curve_boxes(tubes.routing),
        radii=tubes.routing.radii,
        colors=linear_of(chosen),
        surfaces=surfaces,
        materials=tuple(in_white(make_material(look, "#fff")) for look in known),
        extras=lambda number: _extras(program.hyperedges[number]),
    )


def _materials(
    program: Program, notation: Notation, background: Floats | None, hues: Indices | None
) -> list[Material]:
    return make_materials(*_styles(program, notation, background, hues))


def _styles(
    program: Program, notation: Notation, background: Floats | None, hues: Indices | None
) -> tuple[list[Look], Floats]:
    """Looks (h,) and sRGB colours (h, 3)."""
    styles = (notation.hyperedge_style(hyperedge.kind) for hyperedge in program.hyperedges)
    looks = [_look(*each) for each in zip(program.hyperedges, styles, strict=True)]
    return looks, hyperedge_colors(program, notation, background, hues)


def _look(hyperedge: Hyperedge, style: HyperedgeStyle) -> Look:
    if hyperedge.material is not None:
        return Look(hyperedge.material, hyperedge.finish, hyperedge.translucency)
    translucency = hyperedge.translucency
    return Look(
        style.material,
        hyperedge.finish or style.finish,
        style.translucency if translucency is None else translucency,
    )


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
