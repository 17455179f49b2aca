"""A scene as the draft renderer wants it: one heap of triangles, around the origin, of size one.

Everything is moved to the middle of the scene and divided by its size, so that a scene of
micrometres and one of kilometres meet the same biases, distances and single-precision floats.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from app.arrays import Faces, Floats, Indices, Singles
from app.placement.turning import UNTURNED, matrices
from app.scene.boxes import boxes
from app.scene.scene import Camera, Material, Node, Primitive, Scene, TextureName
from app.scene.textures import tint

OPAQUE = 0.999
"""Opacity from which a material hides what is behind it."""


@dataclass(frozen=True, slots=True)
class Section:
    """Triangles that are drawn alike: ``count`` of them from the ``first`` on."""

    shows: Literal["item", "hyperedge"]
    is_clear: bool
    texture: TextureName | None
    first: int
    count: int


@dataclass(frozen=True, slots=True, eq=False)
class DraftScene:
    """What is drawn. A *row* is a primitive of a node; number 0 is none.

    ``positions`` and ``normals`` (v, 3); ``rows`` (v,) of uint32; ``coordinates`` (v, 2) where
    anything has a texture; ``faces`` (f, 3), sorted from near to far within each of the
    ``sections``. ``table`` (rows, 3, 4) has for each row linear RGB and opacity; metallic,
    roughness, clearcoat and its roughness; and the width of the halo, the radius, and whether it
    is lit. ``boxes`` (rows - 1, 2, 3) are theirs, and ``is_item`` (rows - 1,) whether they show
    items. ``ground`` is its height, or ``None``. ``reach`` is how far an item darkens what stands
    beside it.
    """

    positions: Singles
    normals: Singles
    rows: Faces
    coordinates: Singles | None
    faces: Faces
    sections: tuple[Section, ...]
    table: Singles
    boxes: Floats
    is_item: NDArray[np.bool_]
    ground: float | None
    reach: float

    @property
    def bounds(self) -> Floats | None:
        """Smallest and largest corner of all there is, (2, 3), without the ground."""
        if not len(self.boxes):
            return None
        return np.array([self.boxes[:, 0].min(axis=0), self.boxes[:, 1].max(axis=0)])

    @property
    def corners(self) -> Floats:
        """Those of the boxes, (p, 3): everything drawn lies between."""
        return corners_of(self.boxes)

    @property
    def floor(self) -> float:
        """The height below which nothing darkens anything."""
        if self.ground is not None:
            return self.ground
        return 0.0 if self.bounds is None else float(self.bounds[0, 2])


@dataclass(frozen=True, slots=True, eq=False)
class Normalization:
    """Moves ``center`` (3,) to the origin and divides lengths by ``size``."""

    center: Floats
    size: float

    @staticmethod
    def of(scene: Scene) -> Normalization:
        """What makes the scene's bounds one unit long, from corner to corner."""
        low, high = np.asarray(scene.bounds, dtype=np.float64)
        size = float(np.linalg.norm(high - low))
        if not np.isfinite(size) or size <= 0.0:
            return Normalization(np.zeros(3), 1.0)
        return Normalization((low + high) / 2, size)

    def points(self, points: Floats) -> Floats:
        """Positions (…, 3) of the document as positions of the draft."""
        return np.asarray((points - self.center) / self.size)


def corners_of(around: Floats) -> Floats:
    """The corners (8n, 3) of boxes (n, 2, 3).

    >>> corners_of(np.array([[[0.0, 0, 0], [1, 2, 3]]])).max(axis=0)
    array([1., 2., 3.])
    """
    ends = np.array([[i >> 2 & 1, i >> 1 & 1, i & 1] for i in range(8)])
    return np.asarray(around[:, ends, np.arange(3)]).reshape(-1, 3)


@dataclass(frozen=True, slots=True, eq=False)
class _Piece:
    """One primitive, and what it belongs to."""

    node: Node
    primitive: Primitive
    material: Material


def draft_scene(scene: Scene, normalization: Normalization) -> DraftScene:
    """Move, merge and sort the scene's triangles.

    Raises `ValueError` where a vertex is not finite: one would spoil the whole picture.
    """
    pieces = [
        _Piece(node, primitive, scene.materials[primitive.material])
        for node in scene.nodes
        if node.shows != "ground"
        for primitive in node.primitives
        if len(primitive.mesh.faces)
    ]
    starts = np.cumsum([0, *(len(piece.primitive.mesh.vertices) for piece in pieces)])
    positions, normals = _placed(pieces, starts, normalization)
    around = boxes(positions, starts).astype(np.float64) if pieces else np.zeros((0, 2, 3))
    faces, sections = _sorted(pieces, starts, _nearest_first(around, scene.camera))
    return DraftScene(
        positions=positions,
        normals=normals,
        rows=np.repeat(np.arange(1, len(pieces) + 1, dtype=np.uint32), np.diff(starts)),
        coordinates=_coordinates(pieces),
        faces=faces,
        sections=sections,
        table=_table(pieces, scene.halo, normalization.size),
        boxes=around,
        is_item=np.array([piece.node.shows == "item" for piece in pieces], dtype=np.bool_),
        ground=_ground_height(scene, normalization),
        reach=_reach(pieces, around),
    )


_NO_PLACES = np.zeros((0, 3), dtype=np.float32)


def _placed(
    pieces: Sequence[_Piece], starts: Indices, normalization: Normalization
) -> tuple[Singles, Singles]:
    """Positions and normals of all pieces, turned and moved."""
    if not pieces:
        return _NO_PLACES, _NO_PLACES
    positions = np.concatenate([piece.primitive.mesh.vertices for piece in pieces])
    normals = np.concatenate([piece.primitive.mesh.normals for piece in pieces])
    rotations = np.array([piece.node.rotation for piece in pieces], dtype=np.float64)
    turned = np.flatnonzero((rotations != UNTURNED).any(axis=1))
    turns = matrices(rotations[turned]).transpose(0, 2, 1).astype(np.float32)
    for piece, turn in zip(turned.tolist(), turns, strict=True):
        own = slice(starts[piece], starts[piece + 1])
        positions[own] = positions[own] @ turn
        normals[own] = normals[own] @ turn
    places = normalization.points(np.array([piece.node.translation for piece in pieces]))
    positions *= np.float32(1 / normalization.size)
    positions += np.repeat(places.astype(np.float32), np.diff(starts), axis=0)
    if not np.isfinite(positions).all():
        row = np.flatnonzero(~np.isfinite(positions).all(axis=1))[0]
        name = pieces[int(np.searchsorted(starts, row, side="right")) - 1].node.name
        raise ValueError(f"{name!r} has a vertex that is not finite.")
    return positions, normals


def _sorted(
    pieces: Sequence[_Piece], starts: Indices, order: Indices
) -> tuple[Faces, tuple[Section, ...]]:
    """Faces of all pieces, section by section and in this order within each."""
    members: dict[tuple[bool, bool, str], list[int]] = {}
    for index in order.tolist():
        piece = pieces[index]
        is_clear = piece.material.base_color[3] < OPAQUE
        key = is_clear, piece.node.shows == "hyperedge", _texture(piece) or ""
        members.setdefault(key, []).append(index)
    groups = sorted(members.items())
    ordered = [index for _, group in groups for index in group]
    counts = np.array([len(piece.primitive.mesh.faces) for piece in pieces], dtype=np.int64)
    sections: list[Section] = []
    first = 0
    for (is_clear, is_hyperedge, _), group in groups:
        count = int(counts[group].sum())
        texture = _texture(pieces[group[0]])
        shows: Literal["item", "hyperedge"] = "hyperedge" if is_hyperedge else "item"
        sections.append(Section(shows, is_clear, texture, first, count))
        first += count
    if not ordered:
        return np.zeros((0, 3), dtype=np.uint32), ()
    faces = np.concatenate([pieces[index].primitive.mesh.faces for index in ordered])
    faces += np.repeat(starts[ordered].astype(np.uint32), counts[ordered])[:, None]
    return faces, tuple(sections)


def _texture(piece: _Piece) -> TextureName | None:
    """Only where it is known how it lies on the surface."""
    return None if piece.primitive.mesh.coordinates is None else piece.material.texture


def _coordinates(pieces: Sequence[_Piece]) -> Singles | None:
    if not any(_texture(piece) for piece in pieces):
        return None
    return np.concatenate(
        [
            np.zeros((len(mesh.vertices), 2), dtype=np.float32)
            if mesh.coordinates is None
            else mesh.coordinates
            for mesh in (piece.primitive.mesh for piece in pieces)
        ]
    )


def _table(pieces: Sequence[_Piece], halo: float, size: float) -> Singles:
    """See `DraftScene`; halos are so many times a radius wide, and lengths divided by ``size``."""
    rows = [[0.0] * 12]
    for piece in pieces:
        material, radius = piece.material, (piece.node.radius or 0.0) / size
        red, green, blue, opacity = material.base_color
        if _texture(piece):
            red, green, blue = tint((red, green, blue))
        rows.append(
            [
                *(red, green, blue, opacity, material.metallic, material.roughness),
                *(material.clearcoat, material.clearcoat_roughness),
                *(halo * radius, radius, float(material.is_lit), 0.0),
            ]
        )
    return np.array(rows, dtype=np.float32).reshape(-1, 3, 4)


def _nearest_first(around: Floats, camera: Camera) -> Indices:
    """The order of boxes (n, 2, 3) by their farthest corner.

    So what is in a tray comes before the tray; what is drawn first hides the next before it costs.
    """
    away = np.subtract(camera.target, camera.position)
    farthest = np.where(away > 0, around[:, 1], around[:, 0]) @ away
    return np.argsort(farthest, kind="stable")


def _ground_height(scene: Scene, normalization: Normalization) -> float | None:
    """The top of the scene's ground, in the draft's axes."""
    for node in scene.nodes:
        if node.shows == "ground":
            tops = [piece.mesh.bounds[1, 2] for piece in node.primitives if len(piece.mesh.faces)]
            top = node.translation[2] + max(tops, default=0.0)
            return float((top - normalization.center[2]) / normalization.size)
    return None


def _reach(pieces: Sequence[_Piece], around: Floats) -> float:
    """A third of the usual width of an item, so that its neighbours are touched and no more."""
    widths: dict[str, float] = {}
    narrow = (around[:, 1, :2] - around[:, 0, :2]).min(axis=1)
    for piece, width in zip(pieces, narrow.tolist(), strict=True):
        if piece.node.shows == "item":
            widths[piece.node.name] = max(width, widths.get(piece.node.name, 0.0))
    return 0.3 * float(np.median(list(widths.values()))) if widths else 0.0
