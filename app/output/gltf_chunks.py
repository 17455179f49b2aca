"""Many hyperedges as few chunks, each drawn at once, that say at each vertex whose it is.

A chunk is of one kind of surface, compact, so that viewers need not draw what is out of sight, and
small enough for short vertex numbers. A hyperedge is never divided.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, TypeAlias

import numpy as np
from numba import njit
from numpy.typing import NDArray

from app.arrays import Floats, Indices
from app.output.gltf_numbers import colors_of, fits, spacing, starts_of
from app.scene.boxes import boxes
from app.scene.scene import Material, Node
from app.solids.mesh import Mesh

Colors: TypeAlias = NDArray[np.uint8]
Number: TypeAlias = NDArray[Any]

MOST_SHORT = 65_535
"""Vertices that uint16 can number: its largest value would restart the primitive."""

_AT_ONCE = 1_000
"""Meshes that are looked at together: few enough not to need much memory."""


@dataclass(frozen=True, slots=True, eq=False)
class Chunk:
    """Hyperedges (``members``) that are drawn at once, around ``center``.

    ``material`` is white; the members' own linear colours ``colors`` (m, 4), in 255ths, go to their
    vertices. ``step`` is the grid on which 16 bits number all positions, or ``None`` where the
    chunk, being one hyperedge, is too large for that.
    """

    members: tuple[Node, ...]
    material: Material
    colors: Colors
    center: tuple[float, float, float]
    step: float | None


@dataclass(frozen=True, slots=True, eq=False)
class Merged:
    """The triangles of a chunk around its centre, and for each vertex the member it is of, (v,)."""

    mesh: Mesh
    members: Indices


def chunks_of(nodes: Sequence[Node], materials: Sequence[Material]) -> list[Chunk]:
    """Chunks of ``nodes``, each of one primitive that has triangles."""
    shown = [node.primitives[0].material for node in nodes]
    numbers, surfaces = _in_white(materials)
    of_nodes = numbers[shown]
    colors = colors_of(np.array([material.base_color[:3] for material in materials]))[shown]
    spread = _Spread.of(nodes)
    return [
        _chunk(nodes, colors, surfaces[surface], spread, members)
        for surface in np.unique(of_nodes).tolist()
        for members in spread.divide(np.flatnonzero(of_nodes == surface))
    ]


def merge(chunk: Chunk) -> Merged:
    """All triangles of a chunk, in the order of its members."""
    meshes = [node.primitives[0].mesh for node in chunk.members]
    counts = [len(mesh.vertices) for mesh in meshes]
    starts = starts_of(counts)
    places = np.array([node.translation for node in chunk.members]) - chunk.center
    vertices = np.concatenate([mesh.vertices for mesh in meshes])
    _add_rows(vertices, starts, places.astype(np.float32))
    faces = np.concatenate([mesh.faces for mesh in meshes])
    corners = starts_of([len(mesh.faces) for mesh in meshes])
    _add_rows(faces, corners, np.repeat(starts[:-1, None].astype(np.uint32), 3, axis=1))
    normals = np.concatenate([mesh.normals for mesh in meshes])
    return Merged(Mesh(vertices, normals, faces), np.repeat(np.arange(len(meshes)), counts))


@njit(cache=True, nogil=True)
def _add_rows(rows: Number, starts: Indices, added: Number) -> None:
    """Add to each group of ``rows`` (n, 3) its row of ``added`` (g, 3)."""
    for group in range(len(starts) - 1):
        for row in range(starts[group], starts[group + 1]):
            for axis in range(3):
                rows[row, axis] += added[group, axis]


def _in_white(materials: Sequence[Material]) -> tuple[Indices, list[Material]]:
    """The same surfaces without colours, which number each material's is, (m,), and all of them.

    Their names say only what they are made of.
    """
    known: dict[tuple[str, float, float, float], int] = {}
    surfaces: list[Material] = []
    numbers: list[int] = []
    for material in materials:
        name, opacity = material.name.partition(" ")[0], material.base_color[3]
        number = known.setdefault(
            (name, material.metallic, material.roughness, opacity), len(surfaces)
        )
        if number == len(surfaces):
            white = (1.0, 1.0, 1.0, opacity)
            surfaces.append(replace(material, name=name, base_color=white))
        numbers.append(number)
    return np.array(numbers, dtype=np.int64), surfaces


def _chunk(
    nodes: Sequence[Node], colors: Colors, surface: Material, spread: _Spread, numbers: Indices
) -> Chunk:
    """The chunk of those of ``nodes`` that have ``numbers`` (m,); ``colors`` (n, 4) are theirs."""
    low, high = spread.lows[numbers].min(axis=0), spread.highs[numbers].max(axis=0)
    # Rounded first, as the translations of nodes are: see `app.scene.boxes.around_their_middles`.
    x, y, z = ((low + high) / 2).astype(np.float32).tolist()
    members = tuple([nodes[number] for number in numbers.tolist()])
    return Chunk(members, surface, colors[numbers], (x, y, z), spread.step(numbers))


@dataclass(frozen=True, slots=True, eq=False)
class _Spread:
    """Boxes (h, 3) of h nodes in the world, their vertices (h,) and the steps of their grids (h,).

    A step is not a number where a node does not say how thick its tubes are.
    """

    lows: Floats
    highs: Floats
    vertices: Indices
    steps: Floats

    @staticmethod
    def of(nodes: Sequence[Node]) -> _Spread:
        vertices = [node.primitives[0].mesh.vertices for node in nodes]
        counts = [len(own) for own in vertices]
        around = np.concatenate(
            [
                boxes(
                    np.concatenate(vertices[at : at + _AT_ONCE]),
                    starts_of(counts[at : at + _AT_ONCE]),
                )
                for at in range(0, len(nodes), _AT_ONCE)
            ]
        )
        around += np.array([node.translation for node in nodes])[:, None]
        radii = np.array([np.nan if node.radius is None else node.radius for node in nodes])
        return _Spread(around[:, 0], around[:, 1], np.array(counts), spacing(radii))

    def divide(self, members: Indices) -> list[Indices]:
        """Groups that are small enough, or of one member; each in ascending order."""
        if len(members) == 1 or self._is_small(members):
            return [np.sort(members)]
        middles = (self.lows[members] + self.highs[members]) / 2
        axis = int(np.argmax(np.ptp(middles, axis=0)))
        members = members[np.argsort(middles[:, axis], kind="stable")]
        total = np.cumsum(self.vertices[members])
        half = int(np.searchsorted(total, total[-1] / 2)) + 1
        half = min(half, len(members) - 1)
        return self.divide(members[:half]) + self.divide(members[half:])

    def step(self, members: Indices) -> float | None:
        """The widest grid that suits all members, if 16 bits number all of them on it."""
        step = float(self.steps[members].min())
        low, high = self.lows[members].min(axis=0), self.highs[members].max(axis=0)
        # The centre is rounded to single precision.
        reach = float((high - low).max()) / 2 + 1e-7 * float(np.abs([low, high]).max())
        return step if fits(reach, step) else None

    def _is_small(self, members: Indices) -> bool:
        few = int(self.vertices[members].sum()) <= MOST_SHORT
        # Where radii are not known there is no grid, and so none that is too small.
        return few and (bool(np.isnan(self.steps[members]).any()) or self.step(members) is not None)
