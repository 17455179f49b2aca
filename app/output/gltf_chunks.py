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
    positions, or ``None`` where the chunk, being one hyperedge, is too large for that.
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
    steps = spacing(crowd.radii)
    return [
        Chunk(crowd, members, surface, _center(crowd, members), _step(crowd, steps, members))
        for surface in np.unique(crowd.surfaces).tolist()
        for members in _divide(crowd, steps, np.flatnonzero(crowd.surfaces == surface))
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


def _divide(crowd: Crowd, steps: Floats, members: Indices) -> list[Indices]:
    """Groups of ``members`` that are small enough, or of one; each in ascending order."""
    if len(members) == 1 or _is_small(crowd, steps, members):
        return [np.sort(members)]
    middles = crowd.boxes[members].mean(axis=1)
    axis = int(np.argmax(np.ptp(middles, axis=0)))
    members = members[np.argsort(middles[:, axis], kind="stable")]
    total = np.cumsum(crowd.vertex_counts[members])
    half = min(int(np.searchsorted(total, total[-1] / 2)) + 1, len(members) - 1)
    return _divide(crowd, steps, members[:half]) + _divide(crowd, steps, members[half:])


def _is_small(crowd: Crowd, steps: Floats, members: Indices) -> bool:
    if int(crowd.vertex_counts[members].sum()) > MOST_SHORT:
        return False
    # Where radii are not known there is no grid, and so none that is too small.
    is_known = not np.isnan(steps[members]).any()
    return not is_known or _step(crowd, steps, members) is not None


def _center(crowd: Crowd, members: Indices) -> Floats:
    """The middle of members, rounded to single precision: so that differences lose nothing."""
    low, high = crowd.boxes[members, 0].min(axis=0), crowd.boxes[members, 1].max(axis=0)
    return np.asarray(((low + high) / 2).astype(np.float32).astype(np.float64))


def _step(crowd: Crowd, steps: Floats, members: Indices) -> float | None:
    """The widest grid that suits all members, if 16 bits number all of them on it."""
    step = float(steps[members].min())
    center = _center(crowd, members)
    reach = float(np.abs(crowd.boxes[members] - center).max())
    # Vertices are of single precision, and may stand out of their boxes by as much.
    return step if fits(reach + 1e-6 * float(np.abs(center).max() + reach), step) else None
