"""The scene: what every output draws or writes. z is up; lengths in document units."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, Literal, TypeAlias

from app.arrays import Floats, Indices
from app.program.model import MaterialName
from app.solids.mesh import Mesh
from app.tubes.tubes import Tubes

TextureName: TypeAlias = Literal["wood", "stone"]


@dataclass(frozen=True, slots=True)
class Material:
    """How a surface answers to light: the metallic-roughness model of glTF 2.0.

    ``base_color`` is linear RGB, and the opacity that it has where nothing can be refracted;
    ``transmission`` is the share of light that passes where something can (with ``ior``, the index
    of refraction). A ``texture`` is multiplied by the colour's `app.scene.textures.tint`. A surface
    that is not lit shows its colour as it is.
    """

    name: str
    base_color: tuple[float, float, float, float]
    metallic: float
    roughness: float
    surface: MaterialName = "plastic"
    transmission: float = 0.0
    ior: float = 1.5
    clearcoat: float = 0.0
    clearcoat_roughness: float = 0.0
    texture: TextureName | None = None
    is_lit: bool = True

    def __hash__(self) -> int:
        """Of the name alone, which says all the rest: each of very many hyperedges has its own."""
        return hash(self.name)


@dataclass(frozen=True, slots=True, eq=False)
class Primitive:
    """Triangles of one material (its number in ``Scene.materials``)."""

    mesh: Mesh
    material: int


@dataclass(frozen=True, slots=True, eq=False)
class Node:
    """An item, a hyperedge or the ground.

    ``primitives`` are in the node's own axes; ``translation`` and ``rotation`` (quaternion x, y,
    z, w) place them in the world. ``shows`` says of what kind it is; ``extras`` carry id, kind,
    label and data. ``radius`` is that of a hyperedge's tubes, where it is known.
    """

    name: str
    shows: Literal["item", "hyperedge", "ground"]
    primitives: tuple[Primitive, ...]
    translation: tuple[float, float, float]
    rotation: tuple[float, float, float, float]
    extras: Mapping[str, Any]
    radius: float | None = None


@dataclass(frozen=True, slots=True, eq=False)
class Crowd:
    """Very many hyperedges that have no nodes of their own.

    ``swept`` makes the tubes of some of them (k,), around the world's origin. ``vertex_counts``
    (h,) are how many vertices each has, ``boxes`` (h, 2, 3) hold them, ``radii`` (h,) are NaN where
    they are not known. ``colors`` (h, 3) are linear RGB; ``surfaces`` (h,) are numbers of
    ``materials``, which are white. ``extras`` are what a node of one would carry.
    """

    swept: Callable[[Indices], Tubes]
    vertex_counts: Indices
    boxes: Floats
    radii: Floats
    colors: Floats
    surfaces: Indices
    materials: tuple[Material, ...]
    extras: Callable[[int], Mapping[str, Any]]


@dataclass(frozen=True, slots=True, eq=False)
class Camera:
    """A camera at ``position`` that looks at ``target``, ``up`` being up in the picture.

    ``vertical_angle`` (radians) is that of a perspective camera; ``height`` (document units) is
    what an orthographic one sees from bottom to top. Exactly one of them is set. ``shift`` is how
    far the picture's middle lies to the right of where the camera looks, and above it, in halves of
    the picture's width and height: by (1, 0) the camera looks at the left edge. Nothing is turned.
    """

    position: tuple[float, float, float]
    target: tuple[float, float, float]
    up: tuple[float, float, float]
    aspect: float
    near: float
    far: float
    vertical_angle: float | None = None
    height: float | None = None
    shift: tuple[float, float] = (0.0, 0.0)


@dataclass(frozen=True, slots=True)
class Light:
    """A light that shines along ``direction``, like a sun; colour is linear RGB."""

    name: str
    direction: tuple[float, float, float]
    color: tuple[float, float, float]
    illuminance: float
    casts_shadows: bool


@dataclass(frozen=True, slots=True, eq=False)
class Scene:
    """Everything to be seen. ``background`` is linear RGB, or ``None`` for transparent.

    ``bounds`` (2, 3) hold the items and hyperedges, without the ground. Hyperedges are either among
    the nodes or a ``crowd``, which only glTF can show. ``halo`` is how wide a gap tubes leave in
    those that pass behind, in radii of the one in front. ``extras`` are handed through to glTF.
    """

    name: str
    nodes: tuple[Node, ...]
    materials: tuple[Material, ...]
    lights: tuple[Light, ...]
    camera: Camera
    background: tuple[float, float, float] | None
    bounds: Floats
    crowd: Crowd | None = None
    halo: float = 0.0
    extras: Mapping[str, Any] = field(default_factory=dict)
