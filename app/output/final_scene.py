"""A scene as Mitsuba draws it: few meshes, one for each kind of surface, in a studio."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from app.arrays import Faces, Floats, Singles
from app.output.final_camera import REACH, Measure, sees_ground
from app.output.final_light import studio
from app.output.final_materials import BRIGHTEST, Kind, bsdf, emitter, vertex_color
from app.placement.turning import matrices
from app.scene.scene import Node, Scene
from app.solids.mesh import Mesh

BOUNCES = 7
"""Without glass; through glass a path needs four more for each thing that it goes through."""

GLASS_BOUNCES = 14

GROUND_WIDTH = 200.0
"""Half the side of the ground over the scene's reach: its rim is beyond all that is seen."""

GAP = 0.006
"""By which glass is smaller than it should be on all sides (`REACH` being 10), thrice as far as
rays keep away from surfaces: else its floor and that of its tray would be one."""


@dataclass(frozen=True, slots=True, eq=False)
class FinalScene:
    """What is drawn (``world``, Mitsuba's), and what makes pixels of it.

    ``things`` is the same without the ground, and ``None`` where there is nothing but a ground.
    Where it ``hides_sky``, coverage says where there is sky; else the sky is in the picture.
    ``exposure`` is multiplied; ``background`` is linear RGB (3,), white where there is none.
    """

    world: Any
    things: Any | None
    has_ground: bool
    has_glass: bool
    hides_sky: bool
    measure: Measure
    exposure: float
    background: Floats


def final_scene(renderer: Any, scene: Scene) -> FinalScene:
    """The scene for ``renderer`` (Mitsuba): meshes, light and ground; cameras come later."""
    background = np.ones(3) if scene.background is None else np.asarray(scene.background)
    measure = Measure.of(scene.bounds)
    upright = renderer.ScalarTransform4f().rotate([1, 0, 0], 90)
    radiance = renderer.Bitmap(studio(scene.lights).radiance)
    groups = _grouped(scene, measure)
    glass = any(kind.is_glass for kind in groups)
    hides_sky = all(kind.is_lit for kind in groups)
    parts: dict[str, Any] = {
        "type": "scene",
        "path": {
            "type": "path",
            "max_depth": GLASS_BOUNCES if glass else BOUNCES,
            "rr_depth": 4,
            # Then the sky is not seen; but neither would be what shines.
            "hide_emitters": hides_sky,
        },
        "studio": {"type": "envmap", "bitmap": radiance, "to_world": upright},
    }
    for number, (kind, pieces) in enumerate(groups.items()):
        name = f"surface{number:03}"
        parts[name] = _mesh(renderer, name, kind, pieces)
    things = renderer.load_dict(parts) if groups else None
    floor = float(scene.bounds[0, 2])
    grounded = any(node.shows == "ground" for node in scene.nodes)
    if grounded and sees_ground(scene.camera, floor):
        parts["ground"] = _ground(renderer, measure, scene.bounds, background)
    world = renderer.load_dict(parts) if "ground" in parts or things is None else things
    return FinalScene(
        world,
        things,
        "ground" in parts,
        glass,
        hides_sky,
        measure,
        1.0 / BRIGHTEST,
        background,
    )


@dataclass(frozen=True, slots=True, eq=False)
class _Piece:
    """A primitive as it is drawn."""

    vertices: Singles
    normals: Singles
    faces: Faces
    coordinates: Singles | None
    color: Floats


def _grouped(scene: Scene, measure: Measure) -> dict[Kind, list[_Piece]]:
    groups: dict[Kind, list[_Piece]] = {}
    for node in scene.nodes:
        if node.shows == "ground":
            continue
        for primitive in node.primitives:
            if len(primitive.mesh.faces) == 0:
                continue
            material = scene.materials[primitive.material]
            kind = Kind.of(material, primitive.mesh.coordinates is not None)
            color = vertex_color(kind, np.array(material.base_color[:3]))
            piece = _placed(node, primitive.mesh, color, measure)
            if kind.is_glass and node.shows == "item":
                piece = _shrunk(piece)
            groups.setdefault(kind, []).append(piece)
    return groups


def _placed(node: Node, mesh: Mesh, color: Floats, measure: Measure) -> _Piece:
    turn = matrices(np.array(node.rotation)).T.astype(np.float32)
    at = measure.place(np.array(node.translation)).astype(np.float32)
    vertices = (mesh.vertices @ turn) * np.float32(measure.scale) + at
    return _Piece(vertices, mesh.normals @ turn, mesh.faces, mesh.coordinates, color)


def _shrunk(piece: _Piece) -> _Piece:
    low, high = piece.vertices.min(axis=0), piece.vertices.max(axis=0)
    factor = 1.0 - np.minimum(2 * GAP / np.maximum(high - low, 1e-9), 0.05)
    middle = (low + high) / 2
    vertices = middle + (piece.vertices - middle) * factor.astype(np.float32)
    return replace(piece, vertices=vertices)


def _mesh(renderer: Any, name: str, kind: Kind, pieces: list[_Piece]) -> Any:
    counts = np.array([len(piece.vertices) for piece in pieces])
    starts = (np.cumsum(counts) - counts).astype(np.uint32)
    faces = np.concatenate(
        [piece.faces + start for piece, start in zip(pieces, starts, strict=True)]
    )
    properties = renderer.Properties()
    properties["mesh_bsdf"] = renderer.load_dict(bsdf(renderer, kind))
    shining = emitter(kind)
    if shining is not None:
        properties["mesh_emitter"] = renderer.load_dict(shining)
    mesh = renderer.Mesh(
        name,
        vertex_count=int(counts.sum()),
        face_count=len(faces),
        has_vertex_normals=True,
        has_vertex_texcoords=not kind.has_vertex_colors,
        props=properties,
    )
    if kind.has_vertex_colors:
        colors = np.repeat([piece.color for piece in pieces], counts, axis=0)
        mesh.add_attribute("vertex_color", 3, colors.astype(np.float32).ravel())
    found = renderer.traverse(mesh)
    found["vertex_positions"] = np.concatenate([piece.vertices for piece in pieces]).ravel()
    found["vertex_normals"] = np.concatenate([piece.normals for piece in pieces]).ravel()
    found["faces"] = faces.ravel()
    if not kind.has_vertex_colors:
        found["vertex_texcoords"] = np.concatenate(list(_coordinates(pieces))).ravel()
    found.update()
    return mesh


def _coordinates(pieces: list[_Piece]) -> Iterator[Singles]:
    for piece in pieces:
        if piece.coordinates is not None:
            yield piece.coordinates


def _ground(renderer: Any, measure: Measure, bounds: Floats, background: Floats) -> Any:
    """A square of the background's colour, which under the studio's light melts into it."""
    low, high = measure.place(bounds)
    half = GROUND_WIDTH * REACH
    corners = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) * half + (low[:2] + high[:2]) / 2
    color = {"type": "rgb", "value": (background * BRIGHTEST).tolist()}
    properties = renderer.Properties()
    properties["mesh_bsdf"] = renderer.load_dict({"type": "diffuse", "reflectance": color})
    mesh = renderer.Mesh("ground", vertex_count=4, face_count=2, props=properties)
    found = renderer.traverse(mesh)
    vertices = np.column_stack([corners, np.full(4, low[2] - GAP)])
    found["vertex_positions"] = vertices.astype(np.float32).ravel()
    found["faces"] = np.array([0, 1, 2, 0, 2, 3], dtype=np.uint32)
    found.update()
    return mesh
