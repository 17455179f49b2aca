"""Puts the scene together: items, hyperedges, ground, light and a camera that sees them all."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from app.arrays import Floats, Indices
from app.notations.notation import Notation
from app.placement.placement import Placement
from app.program.model import Program
from app.scene.boxes import boxes
from app.scene.camera import Farthest, axes_of, frame, view_of
from app.scene.color import linear_of
from app.scene.curve_reach import CurveReach
from app.scene.ground import disc_below, ground_color
from app.scene.hyperedge_colors import background_of
from app.scene.hyperedge_nodes import UPRIGHT, crowd_of, hyperedge_nodes
from app.scene.item_nodes import item_nodes
from app.scene.lights import three_point
from app.scene.materials import make_material
from app.scene.reach import Reach, bounds_by, farther_of
from app.scene.scene import Material, Node, Primitive, Scene
from app.tubes.tubes import Tubes
from app.tubes.unswept import UnsweptTubes


def assemble(
    program: Program,
    notation: Notation,
    placement: Placement,
    tubes: Tubes | UnsweptTubes,
    aspect: float,
    hues: Indices | None = None,
    coarseness: float = 0.0,
) -> Scene:
    """The scene of a program, framed for a picture of ``aspect`` (width over height).

    One node for each item and each hyperedge, in the order of the document, and one for the
    ground where the style wishes for it and there is something to stand on it. Where tubes are not
    swept yet, hyperedges are a crowd without nodes. ``hues`` (h,) say which colour of the palette
    each hyperedge takes; left out, they take one after another. Items may be off by
    ``coarseness`` (document units). Raises `UnknownName` where there is no such palette.
    """
    background = background_of(program)
    materials: dict[Material, int] = {}
    items = item_nodes(program, notation, placement, materials, coarseness)
    nodes, around, crowd = items, _boxes(items), None
    of_crowd: Farthest | None = None
    if isinstance(tubes, Tubes):
        hyperedges, tube_boxes = hyperedge_nodes(
            program, notation, tubes, placement.radii, background, materials, hues
        )
        nodes, around = items + hyperedges, np.concatenate([around, tube_boxes])
    else:
        crowd = crowd_of(program, notation, tubes, background, hues)
        of_crowd = CurveReach.of(tubes.routing).farthest
    reach = Reach.of(nodes, around)
    farthest = farther_of(reach.farthest if reach.nodes else None, of_crowd)
    bounds = bounds_by(farthest)
    ground = None
    if program.style.ground and placement.stands and farthest is not None:
        node, box = _ground(bounds, background, materials)
        ground = Reach.of([node], box[None]).farthest
        nodes.append(node)
    view = view_of(program, placement.mode)
    axes = axes_of(view)
    return Scene(
        name=program.name or "",
        nodes=tuple(nodes),
        materials=tuple(materials),
        lights=three_point(axes, is_upright=program.layout.placement == "layers"),
        camera=frame(farthest, view, aspect, ground),
        background=None if background is None else _triple(linear_of(background)),
        bounds=bounds,
        crowd=crowd,
        halo=program.style.halo,
    )


def _boxes(nodes: Sequence[Node]) -> Floats:
    """Boxes (n, 2, 3) of nodes in their own axes; the origin twice where there are no triangles."""
    found = np.zeros((len(nodes), 2, 3))
    # Many nodes show the same meshes, which live as long as this scene does.
    meshes = {id(part.mesh): part.mesh for node in nodes for part in node.primitives}
    if not meshes:
        return found
    starts = np.cumsum([0, *(len(mesh.vertices) for mesh in meshes.values())])
    around = boxes(np.concatenate([mesh.vertices for mesh in meshes.values()]), starts)
    places = {key: place for place, key in enumerate(meshes)}
    solid = [number for number, node in enumerate(nodes) if node.primitives]
    parts = around[[places[id(part.mesh)] for node in nodes for part in node.primitives]]
    first = np.cumsum([0, *(len(nodes[number].primitives) for number in solid)])[:-1]
    found[solid, 0] = np.minimum.reduceat(parts[:, 0], first, axis=0)
    found[solid, 1] = np.maximum.reduceat(parts[:, 1], first, axis=0)
    return found


def _ground(
    bounds: Floats, background: Floats | None, materials: dict[Material, int]
) -> tuple[Node, Floats]:
    """The ground and its box (2, 3)."""
    mesh, center = disc_below(bounds)
    material = materials.setdefault(
        make_material("matte", ground_color(background)), len(materials)
    )
    node = Node(
        "ground",
        "ground",
        (Primitive(mesh, material),),
        _triple(center),
        UPRIGHT,
        {"shows": "ground"},
    )
    return node, mesh.bounds


def _triple(vector: Floats) -> tuple[float, float, float]:
    x, y, z = vector.tolist()
    return x, y, z
