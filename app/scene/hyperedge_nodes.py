"""Hyperedges as nodes: all tubes of one hyperedge, around their own middle."""

from __future__ import annotations

from typing import Any

import numpy as np

from app.arrays import Floats
from app.notations.notation import Notation
from app.program.model import Hyperedge, Program
from app.scene.boxes import boxes
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
    background: Floats | None,
    materials: dict[Material, int],
) -> tuple[list[Node], Floats]:
    """One node for each hyperedge, in the order of the document, and their boxes (h, 2, 3).

    ``background`` is sRGB (3,) or ``None``. Vertices and boxes are relative to the node's
    translation. New materials join ``materials``, which numbers them.
    """
    around = boxes(tubes.vertices, tubes.vertex_starts)
    middles = around.mean(axis=1)
    counts = np.diff(tubes.vertex_starts)
    # The middle is rounded to single precision first: so the difference loses nothing where
    # coordinates are large.
    offsets = middles.astype(np.float32)
    vertices = np.subtract(tubes.vertices, np.repeat(offsets, counts, axis=0))
    own = Tubes(vertices, tubes.normals, tubes.faces, tubes.vertex_starts, tubes.face_starts)
    translations = offsets.astype(np.float64)
    nodes = [
        _node(
            hyperedge,
            own.mesh(number),
            materials.setdefault(material, len(materials)),
            (x, y, z),
        )
        for number, (hyperedge, material, (x, y, z)) in enumerate(
            zip(
                program.hyperedges,
                _materials(program, notation, background),
                translations.tolist(),
                strict=True,
            )
        )
    ]
    return nodes, around - translations[:, None]


def _node(
    hyperedge: Hyperedge, mesh: Mesh, material: int, translation: tuple[float, float, float]
) -> Node:
    primitives = (Primitive(mesh, material),) if len(mesh.faces) else ()
    return Node(hyperedge.id, "hyperedge", primitives, translation, UPRIGHT, _extras(hyperedge))


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
