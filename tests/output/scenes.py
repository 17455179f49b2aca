"""Small scenes, made by hand, of which is known what a picture of them must show."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

import numpy as np

from app.arrays import Floats
from app.scene.scene import Camera, Light, Material, Node, Primitive, Scene
from app.solids.mesh import Mesh

Triple = tuple[float, float, float]

WHITE: Triple = (1.0, 1.0, 1.0)
UPRIGHT = (0.0, 0.0, 0.0, 1.0)
ORIGIN: Triple = (0.0, 0.0, 0.0)


def linear(color: str) -> Triple:
    """#rrggbb as linear RGB."""
    srgb = np.array(list(bytes.fromhex(color[1:]))) / 255
    below = srgb <= 0.04045
    red, green, blue = np.where(below, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4).tolist()
    return red, green, blue


def box(x: float, y: float, z: float) -> Mesh:
    """A box around the origin with sharp edges."""
    top = np.array([[-1, -1, 1], [1, -1, 1], [1, 1, 1], [-1, 1, 1]]) / 2
    bottom = top * [-1, 1, -1]
    corners = [np.roll(side, shift, axis=1) for shift in range(3) for side in (top, bottom)]
    normals = [np.roll([0, 0, sign], shift) for shift in range(3) for sign in (1, -1)]
    faces = 4 * np.arange(6)[:, None, None] + np.array([[0, 1, 2], [0, 2, 3]])
    return Mesh(
        (np.concatenate(corners) * [x, y, z]).astype(np.float32),
        np.repeat(normals, 4, axis=0).astype(np.float32),
        faces.reshape(-1, 3).astype(np.uint32),
    )


def arch(start: Triple, end: Triple, height: float, radius: float) -> Mesh:
    """A tube along a parabola, 40 rings of 12 sides."""
    rings, sides = 40, 12
    share = np.linspace(0, 1, rings)[:, None]
    center = np.array(start) * (1 - share) + np.array(end) * share
    center[:, 2] += 4 * height * (share * (1 - share))[:, 0]
    tangent = np.gradient(center, axis=0)
    tangent /= np.linalg.norm(tangent, axis=1, keepdims=True)
    side = np.cross(tangent, [0.0, 0.0, 1.0])
    side /= np.linalg.norm(side, axis=1, keepdims=True)
    turn = np.arange(sides)[None, :, None] * (2 * np.pi / sides)
    normals = np.cos(turn) * side[:, None] + np.sin(turn) * np.cross(side, tangent)[:, None]
    ring, number = np.meshgrid(np.arange(rings - 1), np.arange(sides), indexing="ij")
    here, beside = ring * sides + number, ring * sides + (number + 1) % sides
    faces = np.stack(
        [
            np.stack([here, beside + sides, beside], axis=-1),
            np.stack([here, here + sides, beside + sides], axis=-1),
        ],
        axis=2,
    )
    return Mesh(
        (center[:, None] + radius * normals).reshape(-1, 3).astype(np.float32),
        normals.reshape(-1, 3).astype(np.float32),
        faces.reshape(-1, 3).astype(np.uint32),
    )


def node(
    name: str,
    mesh: Mesh,
    material: int,
    at: Triple = ORIGIN,
    shows: Literal["item", "hyperedge", "ground"] = "item",
) -> Node:
    """A node of one mesh."""
    return Node(name, shows, (Primitive(mesh, material),), at, UPRIGHT, {})


def matte(color: str, opacity: float = 1.0) -> Material:
    """A material like paper."""
    return Material(color, (*linear(color), opacity), 0.0, 0.9)


def from_above(height: float) -> Camera:
    """Looks straight down; x to the right and y up in the picture, ``height`` units of y."""
    return Camera((0.0, 0.0, 10.0), ORIGIN, (0.0, 1.0, 0.0), 1.0, 0.1, 20.0, height=height)


def from_front() -> Camera:
    """Looks along y and a little down, in perspective."""
    return Camera(
        (0.5, -6.0, 4.0), (0.0, 0.0, 0.4), (0.0, 0.0, 1.0), 1.0, 0.1, 50.0, vertical_angle=0.6
    )


def sun(direction: Triple = (0.6, 0.0, -1.0)) -> Light:
    """The light that casts shadows."""
    return Light("key", direction, WHITE, 3.0, casts_shadows=True)


def scene(
    nodes: Sequence[Node],
    materials: Sequence[Material],
    *,
    camera: Camera | None = None,
    lights: Sequence[Light] | None = None,
    background: Triple | None = WHITE,
    ground: bool = True,
) -> Scene:
    """The nodes, on a ground at z = 0 unless there is none."""
    disc = node("ground", box(40, 40, 0.001), 0, (0.0, 0.0, -0.0005), shows="ground")
    return Scene(
        name="by hand",
        nodes=(*nodes, disc) if ground else tuple(nodes),
        materials=tuple(materials),
        lights=(sun(),) if lights is None else tuple(lights),
        camera=camera or from_above(4.0),
        background=background,
        bounds=_bounds(nodes),
    )


def still_life(background: Triple | None = WHITE, seed: int = 0) -> Scene:
    """Boxes of many colours, one of glass, with letters' stand-ins, and arches between them."""
    random = np.random.default_rng(seed)
    materials = [
        *map(matte, ("#1b1f27", "#e69f00", "#56b4e9", "#009e73", "#d55e00", "#cc79a7")),
        Material("glass", (*linear("#7dd3fc"), 0.35), 0.0, 0.05),
        Material("metal", (*linear("#c0c5ce"), 1.0), 1.0, 0.37),
    ]
    places = [(1.2 * x, 1.2 * y) for x in (-1.0, 0.0, 1.0) for y in (-1.0, 0.0, 1.0)]
    nodes = []
    for number, (x, y) in enumerate(places):
        z = float(random.uniform(0.3, 0.7))
        at = (x, y, z / 2)
        nodes.append(node(f"box {number}", box(0.7, 0.5, z), 1 + number % 7, at))
        nodes.append(node(f"label {number}", box(0.3, 0.1, 0.03), 0, (x, y, z + 0.015)))
    for number in range(4):
        one, other = random.choice(len(places), 2, replace=False)
        tube = arch((*places[one], 0.4), (*places[other], 0.4), 0.8 + 0.2 * number, 0.06)
        nodes.append(node(f"tube {number}", tube, 1 + number, shows="hyperedge"))
    lights = (
        sun((0.45, 0.55, -1.0)),
        Light("fill", (-0.9, 0.4, -0.4), WHITE, 1.0, casts_shadows=False),
        Light("rim", (0.2, -1.0, -0.4), WHITE, 0.7, casts_shadows=False),
    )
    return scene(nodes, materials, camera=from_front(), lights=lights, background=background)


def _bounds(nodes: Sequence[Node]) -> Floats:
    if not nodes:
        return np.zeros((2, 3))
    corners = np.array(
        [
            primitive.mesh.bounds + np.array(shown.translation)
            for shown in nodes
            for primitive in shown.primitives
        ]
    )
    return np.array([corners[:, 0].min(axis=0), corners[:, 1].max(axis=0)])
