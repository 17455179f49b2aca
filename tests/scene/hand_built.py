"""Small programs with placements and tubes made by hand: the scene does not care who made them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from app.arrays import Floats
from app.notations.loader import load_notation
from app.notations.notation import Notation
from app.placement.placement import LabelPlace, Placement
from app.program.model import Program
from app.scene.assemble import assemble
from app.scene.camera import Axes
from app.scene.scene import Camera, Node, Scene
from app.solids.extents import size_of
from app.solids.meshing import mesh_of
from app.solids.solid import Box, Solid, Sphere, Text
from app.tubes.tubes import Tubes

PLAIN = load_notation("plain")
UPRIGHT = (0.0, 0.0, 0.0, 1.0)
STANDING = (float(np.sqrt(0.5)), 0.0, 0.0, float(np.sqrt(0.5)))
CUBE = Box((1.0, 1.0, 1.0), 0.05)


def program_of(**parts: Any) -> Program:
    """A program from what would stand in JSON."""
    return Program.model_validate(parts)


def three_items(**parts: Any) -> Program:
    """Three items that one hyperedge joins, and another that joins two of them."""
    ends = [{"item": "x"}, {"item": "y"}, {"item": "z"}]
    return program_of(
        items=[
            {"id": "x", "kind": "variable", "label": "X", "data": {"line": [1, {"größe": None}]}},
            {"id": "y", "parent": "x"},
            {"id": "z", "label": "Z"},
        ],
        hyperedges=[
            {"id": "e", "kind": "coreference", "label": "E", "attachments": ends},
            {"id": "f", "attachments": [{"item": "x", "point": "top"}, {"item": "y"}]},
        ],
        **parts,
    )


def placed(program: Program, *, spacing: float = 2.0, solids: Sequence[Solid] = ()) -> Placement:
    """Items in a row along x, cubes unless told otherwise, with labels on their front faces."""
    count = len(program.items)
    ends = [end for hyperedge in program.hyperedges for end in hyperedge.attachments]
    numbers = {item.id: number for number, item in enumerate(program.items)}
    items = np.array([numbers[end.item] for end in ends], dtype=np.int64)
    centers = np.zeros((count, 3))
    centers[:, 0] = spacing * np.arange(count)
    return Placement(
        centers=centers,
        rotations=np.tile(UPRIGHT, (count, 1)),
        sizes=np.ones((count, 3)),
        solids=tuple(solids) or (CUBE,) * count,
        labels=tuple(
            LabelPlace(
                Text(item.label, 0.3, 0.05),
                (0.0, -0.5, 0.0),
                STANDING,
                size_of(Text(item.label, 0.3, 0.05)),
            )
            if item.label
            else None
            for item in program.items
        ),
        attachment_positions=centers[items] + [0, 0, 0.5],
        attachment_directions=np.tile([0.0, 0.0, 1.0], (len(ends), 1)),
        attachment_starts=np.cumsum(
            [0, *(len(hyperedge.attachments) for hyperedge in program.hyperedges)]
        ),
        attachment_items=items,
        radii=np.full(len(program.hyperedges), 0.08),
    )


def balls(centers: Floats) -> Tubes:
    """Tubes of one ball for each hyperedge, around ``centers`` (h, 3)."""
    ball = mesh_of(Sphere(0.5))
    count = len(centers)
    return Tubes(
        vertices=(ball.vertices + centers[:, None]).reshape(-1, 3).astype(np.float32),
        normals=np.tile(ball.normals, (count, 1)),
        faces=np.tile(ball.faces, (count, 1)),
        vertex_starts=np.arange(count + 1) * len(ball.vertices),
        face_starts=np.arange(count + 1) * len(ball.faces),
    )


def scene_of(
    program: Program,
    *,
    notation: Notation = PLAIN,
    placement: Placement | None = None,
    tubes: Tubes | None = None,
    aspect: float = 4 / 3,
) -> Scene:
    """The scene, with balls in a row above the items as tubes unless told otherwise."""
    row = np.array([[2.0 * number, 0.0, 2.0] for number in range(len(program.hyperedges))])
    return assemble(
        program,
        notation,
        placement or placed(program),
        tubes or balls(row.reshape(-1, 3)),
        aspect,
    )


def node_named(scene: Scene, name: str) -> Node:
    """The only node of that name."""
    (found,) = [node for node in scene.nodes if node.name == name]
    return found


def material_of(scene: Scene, name: str, part: int = 0) -> str:
    """The name of a node's material."""
    return scene.materials[node_named(scene, name).primitives[part].material].name


def axes_of(camera: Camera) -> Axes:
    """The axes of a camera, from where it is and what it looks at."""
    back = np.subtract(camera.position, camera.target)
    back /= np.linalg.norm(back)
    right = np.cross(camera.up, back)
    return Axes(right, np.cross(back, right), back)


def seen_by(camera: Camera, points: Floats) -> Floats:
    """Where points (n, 3) are in the picture: -1 to 1 to the right and up, and their depth."""
    axes = axes_of(camera)
    assert np.isclose(np.linalg.norm(axes.right), 1.0), "up is square to where the camera looks"
    x, y, z = np.stack([axes.right, axes.up, -axes.back]) @ (points - camera.position).T
    if camera.vertical_angle is not None:
        half = z * np.tan(camera.vertical_angle / 2)
    else:
        assert camera.height is not None
        half = np.full(len(points), camera.height / 2)
    return np.stack([x / (half * camera.aspect), y / half, z], axis=1)
