"""A scene as the draft renderer wants it: few large batches, around the origin, of size one.

Everything is moved to the middle of the scene and divided by its size, so that a scene of
micrometres and one of kilometres meet the same biases, distances and single-precision floats.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np

from app.arrays import Faces, Floats, Singles
from app.placement.turning import matrices
from app.scene.scene import Camera, Material, Node, Scene

MOST_VERTICES = 1 << 20
"""Of a batch that more is added to: keeps copies small. (pyrender passes vertex numbers through
single-precision floats, so no batch may have more than 2^24.)"""

OPAQUE = 0.999
"""Opacity from which a material hides what is behind it."""


LOWEST_SUN = 0.1
"""Sine of the height of the sun below which shadows would have no end."""

CONTACT_REACHES = 3.0
"""How many times its reach the darkness around an item is drawn."""


@dataclass(frozen=True, slots=True, eq=False)
class Batch:
    """Triangles that are drawn at once.

    ``positions`` and ``normals`` (v, 3); ``colors`` (v, 4) linear RGB and opacity; ``surfaces``
    (v, 2) metallic and roughness; ``faces`` (f, 3).
    """

    positions: Singles
    normals: Singles
    colors: Singles
    surfaces: Singles
    faces: Faces


@dataclass(frozen=True, slots=True, eq=False)
class DraftScene:
    """What is drawn, in the order in which it is drawn.

    ``items`` and ``hyperedges`` are opaque, from near to far; ``catcher`` is a piece of the
    ground, just large enough for every shadow on it; ``translucent`` are sorted from far to near.
    ``bounds`` (2, 3) hold them all but the ground, and are ``None`` where there is nothing.
    ``ground`` is its height, or ``None``. ``reach`` is how far an item darkens what stands
    beside it.
    """

    items: tuple[Batch, ...]
    hyperedges: tuple[Batch, ...]
    catcher: tuple[Batch, ...]
    translucent: tuple[Batch, ...]
    bounds: Floats | None
    ground: float | None
    reach: float

    @property
    def floor(self) -> float:
        """The height below which nothing darkens anything."""
        if self.ground is not None:
            return self.ground
        return 0.0 if self.bounds is None else float(self.bounds[0, 2])

    @property
    def corners(self) -> Floats:
        """Points (p, 3) that everything drawn lies between."""
        if self.bounds is None:
            return np.zeros((0, 3))
        return np.concatenate([_corners(self.bounds), *(batch.positions for batch in self.catcher)])

    @property
    def batches(self) -> tuple[Batch, ...]:
        """All batches, in the order in which they are drawn."""
        return (*self.items, *self.hyperedges, *self.catcher, *self.translucent)

    @property
    def casters(self) -> tuple[Batch, ...]:
        """Those that cast shadows."""
        return (*self.items, *self.hyperedges, *self.translucent)


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


def draft_scene(scene: Scene, normalization: Normalization, sun: Floats | None) -> DraftScene:
    """Sort, move and merge the scene's triangles.

    ``sun`` (3,) points at the light that casts shadows, if there is one. Raises `ValueError`
    where a vertex is not finite: one would spoil the whole picture.
    """
    pieces = _by_depth(_pieces(scene, normalization), scene.camera)
    opaque = [piece for piece in pieces if piece.material.base_color[3] >= OPAQUE]
    translucent = [piece for piece in pieces if piece.material.base_color[3] < OPAQUE]
    bounds = _bounds(pieces)
    ground = _ground_height(scene, normalization)
    reach = _reach([piece for piece in pieces if piece.node.shows == "item"])
    return DraftScene(
        items=_batches(piece for piece in opaque if piece.node.shows == "item"),
        hyperedges=_batches(piece for piece in opaque if piece.node.shows == "hyperedge"),
        catcher=_catcher(pieces, ground, reach, sun),
        translucent=_batches(reversed(translucent)),
        bounds=bounds,
        ground=ground,
        reach=reach,
    )


@dataclass(frozen=True, slots=True, eq=False)
class _Piece:
    """One primitive in the draft's axes."""

    node: Node
    positions: Singles
    normals: Singles
    faces: Faces
    material: Material
    bounds: Singles = field(init=False)

    def __post_init__(self) -> None:
        bounds = np.array([self.positions.min(axis=0), self.positions.max(axis=0)])
        object.__setattr__(self, "bounds", bounds)


def _pieces(scene: Scene, normalization: Normalization) -> list[_Piece]:
    """Every primitive but the ground's, turned and moved."""
    nodes = [node for node in scene.nodes if node.shows != "ground"]
    if not nodes:
        return []
    _refuse_infinity(nodes)
    turns = matrices(np.array([node.rotation for node in nodes], dtype=np.float64))
    turns = turns.transpose(0, 2, 1).astype(np.float32)
    places = normalization.points(np.array([node.translation for node in nodes], dtype=np.float64))
    return [
        _Piece(
            node=node,
            positions=primitive.mesh.vertices @ (turn / np.float32(normalization.size)) + place,
            normals=primitive.mesh.normals @ turn,
            faces=primitive.mesh.faces,
            material=scene.materials[primitive.material],
        )
        for node, turn, place in zip(nodes, turns, places.astype(np.float32), strict=True)
        for primitive in node.primitives
        if len(primitive.mesh.faces)
    ]


def _refuse_infinity(nodes: Sequence[Node]) -> None:
    for node in nodes:
        if not all(np.isfinite(primitive.mesh.vertices).all() for primitive in node.primitives):
            raise ValueError(f"{node.name!r} has a vertex that is not finite.")


def _batches(pieces: Iterable[_Piece]) -> tuple[Batch, ...]:
    return tuple(_batch(group) for group in _groups(pieces))


def _groups(pieces: Iterable[_Piece]) -> Iterator[list[_Piece]]:
    group: list[_Piece] = []
    vertices = 0
    for piece in pieces:
        if group and vertices + len(piece.positions) > MOST_VERTICES:
            yield group
            group, vertices = [], 0
        group.append(piece)
        vertices += len(piece.positions)
    if group:
        yield group


def _batch(pieces: Sequence[_Piece]) -> Batch:
    counts = np.array([len(piece.positions) for piece in pieces])
    starts = np.concatenate([[0], np.cumsum(counts)[:-1]]).astype(np.uint32)
    colors = np.array([piece.material.base_color for piece in pieces], dtype=np.float32)
    surfaces = np.array(
        [(piece.material.metallic, piece.material.roughness) for piece in pieces],
        dtype=np.float32,
    )
    return Batch(
        positions=np.concatenate([piece.positions for piece in pieces]),
        normals=np.concatenate([piece.normals for piece in pieces]),
        colors=np.repeat(colors, counts, axis=0),
        surfaces=np.repeat(surfaces, counts, axis=0),
        faces=np.concatenate(
            [piece.faces + start for piece, start in zip(pieces, starts, strict=True)]
        ),
    )


def _catcher(
    pieces: Sequence[_Piece], ground: float | None, reach: float, sun: Floats | None
) -> tuple[Batch, ...]:
    """The part of the ground on which shadows of the pieces fall."""
    if not pieces or ground is None:
        return ()
    corners = np.concatenate([_corners(piece.bounds) for piece in pieces])
    places = [corners[:, :2]]
    if sun is not None and sun[2] > LOWEST_SUN:
        above = np.clip(corners[:, 2:] - ground, 0.0, None)
        places.append(corners[:, :2] - above * (sun[:2] / sun[2]))
    low = np.min(places, axis=(0, 1)) - CONTACT_REACHES * reach
    high = np.max(places, axis=(0, 1)) + CONTACT_REACHES * reach
    ring = np.array([low, (high[0], low[1]), high, (low[0], high[1])])
    return (
        Batch(
            positions=np.column_stack([ring, np.full(4, ground)]).astype(np.float32),
            normals=np.tile(np.array([0, 0, 1], dtype=np.float32), (4, 1)),
            colors=np.ones((4, 4), dtype=np.float32),
            surfaces=np.ones((4, 2), dtype=np.float32),
            faces=np.array([[0, 1, 2], [0, 2, 3]], dtype=np.uint32),
        ),
    )


def _corners(bounds: Floats | Singles) -> Floats:
    return np.array([[x, y, z] for x in bounds[:, 0] for y in bounds[:, 1] for z in bounds[:, 2]])


def _bounds(pieces: Sequence[_Piece]) -> Floats | None:
    if not pieces:
        return None
    corners = np.array([piece.bounds for piece in pieces], dtype=np.float64)
    return np.array([corners[:, 0].min(axis=0), corners[:, 1].max(axis=0)])


def _by_depth(pieces: Sequence[_Piece], camera: Camera) -> list[_Piece]:
    """From near to far, by the farthest corner: so that what is in a tray comes before the tray.

    Opaque pieces in this order hide the next ones before they are shaded, and take half the time;
    translucent ones must be drawn in the opposite order.
    """
    if not pieces:
        return []
    away = np.subtract(camera.target, camera.position)
    bounds = np.array([piece.bounds for piece in pieces], dtype=np.float64)
    farthest = np.where(away > 0, bounds[:, 1], bounds[:, 0]) @ away
    return [pieces[index] for index in np.argsort(farthest, kind="stable")]


def _ground_height(scene: Scene, normalization: Normalization) -> float | None:
    """The top of the scene's ground, in the draft's axes."""
    for node in scene.nodes:
        if node.shows == "ground":
            tops = [piece.mesh.bounds[1, 2] for piece in node.primitives if len(piece.mesh.faces)]
            top = node.translation[2] + max(tops, default=0.0)
            return float((top - normalization.center[2]) / normalization.size)
    return None


def _reach(items: Sequence[_Piece]) -> float:
    """A third of the usual width of an item, so that its neighbours are touched and no more."""
    widths: dict[str, float] = {}
    for piece in items:
        width = float((piece.bounds[1, :2] - piece.bounds[0, :2]).min())
        widths[piece.node.name] = max(width, widths.get(piece.node.name, 0.0))
    return 0.3 * float(np.median(list(widths.values()))) if widths else 0.0
