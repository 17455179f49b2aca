"""Many hyperedges as few chunks, each drawn at once, that say at each vertex whose it is.

A chunk is of one kind of surface, compact, so that viewers need not draw what is out of sight, and
small enough for short vertex numbers. A hyperedge is never divided.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numba import njit
from numpy.typing import NDArray

from app.arrays import Faces, Floats, Indices
from app.output.gltf_numbers import colors_of, fits, spacing, starts_of
from app.scene.boxes import boxes
from app.scene.materials import in_white
from app.scene.scene import Crowd, Material, Node
from app.solids.mesh import Mesh
from app.tubes.tubes import Tubes

MOST_SHORT = 65_535
"""Vertices that uint16 can number: its largest value would restart the primitive."""


@dataclass(frozen=True, slots=True, eq=False)
class Chunk:
    """Those ``members`` (m,) of a crowd that are drawn at once, around ``center`` (3,).

    ``surface`` is the number of their material. ``step`` is the grid on which 16 bits number all
    positions, or ``None`` where members are too large for that, each alone.
    """

    crowd: Crowd
    members: Indices
    surface: int
    center: Floats
    step: float | None


@dataclass(frozen=True, slots=True, eq=False)
class Merged:
    """The triangles of a chunk around its centre, and for each vertex the member it is of, (v,).

    ``members`` number the chunk's from 0. ``colors`` (m, 4) are theirs, linear, in 255ths.
    """

    mesh: Mesh
    members: Indices
    colors: NDArray[np.uint8]


def crowd_of(nodes: Sequence[Node], materials: Sequence[Material]) -> Crowd:
    """Hyperedges that have ``nodes``, each of one primitive with triangles, as a crowd."""
    shown = [materials[node.primitives[0].material] for node in nodes]
    whites = [in_white(material) for material in shown]
    surfaces = {material: number for number, material in enumerate(dict.fromkeys(whites))}
    meshes = [
        replace(mesh, vertices=mesh.vertices + np.array(node.translation, dtype=np.float32))
        for node in nodes
        for mesh in (node.primitives[0].mesh,)
    ]
    counts = [len(mesh.vertices) for mesh in meshes]
    return Crowd(
        swept=lambda members: Tubes.of([meshes[member] for member in members.tolist()]),
        vertex_counts=np.array(counts),
        boxes=boxes(np.concatenate([mesh.vertices for mesh in meshes]), starts_of(counts)),
        radii=np.array([np.nan if node.radius is None else node.radius for node in nodes]),
        colors=np.array([material.base_color[:3] for material in shown]),
        surfaces=np.array([surfaces[white] for white in whites]),
        materials=tuple(surfaces),
        extras=lambda member: nodes[member].extras,
    )


def chunks_of(crowd: Crowd) -> list[Chunk]:
    """All members of ``crowd``, in chunks."""
    spread = _Spread.of(crowd)
    has_grid = ~np.isnan(spread.steps)
    return [
        Chunk(crowd, members, surface, spread.center(members), spread.step(members))
        for surface in np.unique(crowd.surfaces).tolist()
        for kind in (has_grid, ~has_grid)
        for members in spread.divide(np.flatnonzero(kind & (crowd.surfaces == surface)))
    ]


def merge(chunk: Chunk) -> Merged:
    """All triangles of a chunk, in the order of its members."""
    tubes = chunk.crowd.swept(chunk.members)
    count = len(chunk.members)
    center = chunk.center.astype(np.float32)
    _renumber(tubes.faces, tubes.face_starts, tubes.vertex_starts)
    return Merged(
        Mesh(tubes.vertices - center, tubes.normals, tubes.faces),
        np.repeat(np.arange(count), np.diff(tubes.vertex_starts)),
        colors_of(chunk.crowd.colors[chunk.members]),
    )


@njit(cache=True, nogil=True)
def _renumber(faces: Faces, face_starts: Indices, vertex_starts: Indices) -> None:
    """Make faces, which number the vertices of each hyperedge from 0, number those of all."""
    for group in range(len(face_starts) - 1):
        first = np.uint32(vertex_starts[group])
        for face in range(face_starts[group], face_starts[group + 1]):
            for corner in range(3):
                faces[face, corner] += first


@dataclass(frozen=True, slots=True, eq=False)
class _Spread:
    """A crowd with the middles (h, 3) of its boxes and the steps (h,) of its members' grids.

    A step is not a number where the radius is none, or the hyperedge alone too large for the grid.
    """

    crowd: Crowd
    middles: Floats
    steps: Floats

    @staticmethod
    def of(crowd: Crowd) -> _Spread:
        low, high = crowd.boxes[:, 0], crowd.boxes[:, 1]
        reaches = (high - low).max(axis=1) / 2 + _slack(np.abs(crowd.boxes).max(axis=(1, 2)))
        steps = spacing(crowd.radii)
        return _Spread(crowd, (low + high) / 2, np.where(fits(reaches, steps), steps, np.nan))

    def divide(self, members: Indices) -> list[Indices]:
        """Groups of ``members`` that are small enough, or of one; each in ascending order."""
        if len(members) == 0:
            return []
        if len(members) == 1 or self._is_small(members):
            return [np.sort(members)]
        middles = self.middles[members]
        axis = int(np.argmax(middles.max(axis=0) - middles.min(axis=0)))
        members = members[np.argsort(middles[:, axis], kind="stable")]
        total = np.cumsum(self.crowd.vertex_counts[members])
        half = min(int(np.searchsorted(total, total[-1] / 2)) + 1, len(members) - 1)
        return self.divide(members[:half]) + self.divide(members[half:])

    def center(self, members: Indices) -> Floats:
        """Their middle, rounded to single precision: so that differences lose nothing."""
        boxes = self.crowd.boxes[members]
        middle = (boxes[:, 0].min(axis=0) + boxes[:, 1].max(axis=0)) / 2
        return np.asarray(middle.astype(np.float32).astype(np.float64))

    def step(self, members: Indices) -> float | None:
        """The widest grid that suits all members, if 16 bits number all of them on it."""
        step = float(self.steps[members].min())
        center = self.center(members)
        boxes = self.crowd.boxes[members]
        reach = float(np.abs(boxes - center).max() + _slack(np.abs(boxes).max()))
        return step if fits(reach, step) else None

    def _is_small(self, members: Indices) -> bool:
        if int(self.crowd.vertex_counts[members].sum()) > MOST_SHORT:
            return False
        # Where there is no grid, there is none that is too small.
        return bool(np.isnan(self.steps[members[0]])) or self.step(members) is not None


def _slack(largest: Floats) -> Floats:
    """How far vertices may stand out of their boxes: they are of single precision."""
    return 1e-6 * largest
