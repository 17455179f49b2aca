"""A scene as Mitsuba draws it: few meshes, one for each kind of surface, in a studio."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from app.arrays import Faces, Floats, Singles
from app.output.final_light import studio
from app.output.final_materials import Kind, bsdf, emitter, vertex_color
from app.placement.turning import matrices
from app.scene.scene import Camera, Node, Scene
from app.solids.mesh import Mesh

BOUNCES = 7
"""Without glass; through glass a path needs four more for each thing that it goes through."""

GLASS_BOUNCES = 14

GROUND_WIDTH = 60.0
"""Radius of the ground over the scene's diagonal: its rim is beyond all that is seen."""

BRIGHTEST_GROUND = 0.95
"""What the ground reflects where the background is white; the exposure makes up for it."""

GAP = 2e-4
"""By which glass is smaller than it should be, as a share: its floor is not that of its tray."""


@dataclass(frozen=True, slots=True, eq=False)
class FinalScene:
    """What is drawn (``world``, Mitsuba's), and what makes pixels of it.

    ``exposure`` is multiplied; ``background`` is linear RGB (3,), white where there is none.
    """

    world: Any
    exposure: float
    background: Floats


def final_scene(renderer: Any, scene: Scene) -> FinalScene:
    """The scene for ``renderer`` (Mitsuba): meshes, light and ground; cameras come later."""
    background = np.ones(3) if scene.background is None else np.asarray(scene.background)
    upright = renderer.ScalarTransform4f().rotate([1, 0, 0], 90)
    radiance = renderer.Bitmap(studio(scene.lights).radiance)
    groups = _grouped(scene)
    glass = any(kind.is_glass for kind in groups)
    parts: dict[str, Any] = {
        "type": "scene",
        "path": {
            "type": "path",
            "max_depth": GLASS_BOUNCES if glass else BOUNCES,
            "rr_depth": 4,
            # Then the sky is not seen, and the background is; but what shines would not be either.
            "hide_emitters": all(kind.is_lit for kind in groups),
        },
        "studio": {"type": "envmap", "bitmap": radiance, "to_world": upright},
    }
    if any(node.shows == "ground" for node in scene.nodes):
        parts["ground"] = _ground(renderer, scene, background)
    for number, (kind, pieces) in enumerate(groups.items()):
        parts[f"surface{number:03}"] = _mesh(renderer, f"surface{number:03}", kind, pieces)
    return FinalScene(renderer.load_dict(parts), 1.0 / BRIGHTEST_GROUND, background)


def sensor(
    renderer: Any, camera: Camera, size: tuple[int, int], window: tuple[int, int, int, int]
) -> Any:
    """A camera for pictures of ``size``, which draws only ``window`` (left, top, width, height)."""
    transform = renderer.ScalarTransform4f()
    to_world = transform.look_at(
        origin=list(camera.position), target=list(camera.target), up=_up(camera)
    )
    left, top, width, height = window
    parts: dict[str, Any] = {
        "near_clip": camera.near,
        "far_clip": camera.far,
        "film": {
            "type": "hdrfilm",
            "width": size[0],
            "height": size[1],
            "crop_offset_x": left,
            "crop_offset_y": top,
            "crop_width": width,
            "crop_height": height,
            "rfilter": {"type": "box"},
            "pixel_format": "rgba",
            "component_format": "float32",
        },
        "sampler": {"type": "multijitter"},
    }
    if camera.vertical_angle is not None:
        parts["type"] = "perspective"
        parts["principal_point_offset_x"] = camera.shift[0] / 2
        parts["principal_point_offset_y"] = -camera.shift[1] / 2
        parts["fov_axis"] = "y"
        parts["fov"] = float(np.degrees(camera.vertical_angle))
    else:
        half = (camera.height or 1.0) * size[0] / size[1] / 2
        parts["type"] = "orthographic"
        to_world = to_world @ transform.scale([half, half, 1.0])
    parts["to_world"] = to_world
    return renderer.load_dict(parts)


def _up(camera: Camera) -> list[float]:
    """Any other, where a camera looks along its own."""
    away = np.subtract(camera.target, camera.position)
    aside = np.linalg.norm(np.cross(away, camera.up))
    up = camera.up if aside > 1e-9 * np.linalg.norm(away) else np.roll(camera.up, 1)
    return [float(part) for part in up]


@dataclass(frozen=True, slots=True, eq=False)
class _Piece:
    """A primitive in the world."""

    vertices: Singles
    normals: Singles
    faces: Faces
    coordinates: Singles | None
    color: Floats


def _grouped(scene: Scene) -> dict[Kind, list[_Piece]]:
    groups: dict[Kind, list[_Piece]] = {}
    for node in scene.nodes:
        if node.shows == "ground":
            continue
        for primitive in node.primitives:
            if len(primitive.mesh.faces) == 0:
                continue
            material = scene.materials[primitive.material]
            kind = Kind.of(material, primitive.mesh.coordinates is not None)
            piece = _placed(
                node, primitive.mesh, vertex_color(kind, np.array(material.base_color[:3]))
            )
            if kind.is_glass and node.shows == "item":
                piece = _shrunk(piece)
            groups.setdefault(kind, []).append(piece)
    return groups


def _placed(node: Node, mesh: Mesh, color: Floats) -> _Piece:
    turn = matrices(np.array(node.rotation)).T.astype(np.float32)
    vertices = mesh.vertices @ turn + np.array(node.translation, dtype=np.float32)
    return _Piece(vertices, mesh.normals @ turn, mesh.faces, mesh.coordinates, color)


def _shrunk(piece: _Piece) -> _Piece:
    middle = (piece.vertices.min(axis=0) + piece.vertices.max(axis=0)) / 2
    vertices = middle + (piece.vertices - middle) * np.float32(1.0 - GAP)
    return _Piece(vertices, piece.normals, piece.faces, piece.coordinates, piece.color)


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
        has_vertex_texcoords=kind.texture is not None,
        props=properties,
    )
    if kind.texture is None:
        colors = np.repeat([piece.color for piece in pieces], counts, axis=0)
        mesh.add_attribute("vertex_color", 3, colors.astype(np.float32).ravel())
    found = renderer.traverse(mesh)
    found["vertex_positions"] = np.concatenate([piece.vertices for piece in pieces]).ravel()
    found["vertex_normals"] = np.concatenate([piece.normals for piece in pieces]).ravel()
    found["faces"] = faces.ravel()
    if kind.texture is not None:
        found["vertex_texcoords"] = np.concatenate(list(_coordinates(pieces))).ravel()
    found.update()
    return mesh


def _coordinates(pieces: list[_Piece]) -> Iterator[Singles]:
    for piece in pieces:
        if piece.coordinates is not None:
            yield piece.coordinates


def _ground(renderer: Any, scene: Scene, background: Floats) -> dict[str, Any]:
    """A disc of the background's colour, which under the studio's light melts into it."""
    low, high = scene.bounds
    diagonal = max(float(np.linalg.norm(high - low)), 1e-3)
    middle = [*((low[:2] + high[:2]) / 2).tolist(), float(low[2]) - 1e-4 * diagonal]
    place = renderer.ScalarTransform4f().translate(middle).scale(GROUND_WIDTH * diagonal)
    color = (background * BRIGHTEST_GROUND).tolist()
    return {
        "type": "disk",
        "to_world": place,
        "surface": {"type": "diffuse", "reflectance": {"type": "rgb", "value": color}},
    }
