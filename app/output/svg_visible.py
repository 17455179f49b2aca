"""What is to be seen of bands: their pieces, less whatever passes in front."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from manifold3d import CrossSection, FillRule, OpType
from numpy.typing import NDArray

from app.arrays import Floats, Indices
from app.output.svg_bands import Bands
from app.output.svg_projection import Projection
from app.output.svg_raster import Foremost, foremost, hidden
from app.output.svg_surfaces import area

TOUCHING = 0.9
"""Radii by which an item must be in front of a tube to hide it: tubes stand on items."""

CROSSING = 0.25
"""The same of another hyperedge's tube."""

OWN = 3.0
"""The same of a tube of the same hyperedge: at a join they are none before the other."""

SHARE = 0.4
"""Of the pixels that a piece of a tube shares with a face: at so many the face must hide it."""

SPECK = 0.4
"""Square pixels: what is left of less is left out."""


@dataclass(frozen=True, slots=True, eq=False)
class Grid:
    """The grid that questions of order are answered on: ``scale`` of it to a pixel."""

    width: int
    height: int
    scale: float

    @property
    def coarser(self) -> Grid:
        """Half as many points along each side: enough for what is large."""
        return Grid(-(-self.width // 2), -(-self.height // 2), self.scale / 2)

    def on(self, triangles: Floats) -> Floats:
        """Triangles (t, 3, 3) on the grid."""
        return np.asarray(triangles * np.array([self.scale, self.scale, 1.0]))

    def places(self, points: Floats) -> tuple[Indices, Indices]:
        """Rows and columns (n,) of points (n, 2)."""
        found = np.floor(points * self.scale).astype(np.int64)
        limits = (self.width - 1, self.height - 1)
        columns, rows = np.clip(found, 0, limits).T
        return rows, columns


@dataclass(frozen=True, slots=True, eq=False)
class Surroundings:
    """What is foremost of the ``tubes`` with their halos, by piece, and of the ``faces``."""

    bands: Bands
    tubes: Foremost
    faces: Foremost
    view: Projection
    grid: Grid
    halo: float

    @staticmethod
    def of(
        bands: Bands, faces: Foremost, halo: float, view: Projection, grid: Grid
    ) -> Surroundings:
        """Those of ``bands`` among the ``faces`` of items."""
        numbers = np.repeat(np.arange(len(bands.firsts)), 4)
        wide = grid.on(bands.triangles(1.0 + halo, 0.0, view))
        tubes = foremost(wide, numbers, grid.width, grid.height)
        return Surroundings(bands, tubes, faces, view, grid, halo)

    def hiders(self) -> tuple[Indices, Indices]:
        """Which pieces are hidden by which pieces, and by which faces: (k, 2) each."""
        bands, grid = self.bands, self.grid
        numbers = np.repeat(np.arange(len(bands.firsts)), 4)
        own = grid.on(bands.triangles(1.0, 0.0, self.view))
        near, radii = own[:, 0, 2], bands.radii[bands.firsts][numbers]
        owners = np.stack([numbers, bands.hyperedges[numbers]])
        room = [self.view.nearer(near, by * radii) - near for by in (CROSSING, OWN, TOUCHING)]
        tubes, _ = hidden(own, owners, bands.hyperedges, np.stack(room[:2]), self.tubes)
        nobody = np.full(int(self.faces.owners.max()) + 1, -1)
        walls, counts = hidden(own, owners, nobody, np.stack([room[2]] * 2), self.faces)
        # A tube that ends at a face is before it: what the grid says of its rim is noise.
        walls = walls[counts[:, 0] > SHARE * counts[:, 1]]
        return _with_neighbours(tubes, bands), walls

    def hides(self, points: Floats, radii: Floats, hyperedge: int) -> NDArray[np.bool_]:
        """Whether points (n, 3) of a hyperedge's tubes, of ``radii`` (n,), are hidden, (n,)."""
        at = self.grid.places(points[:, :2])
        near = points[:, 2]
        walls, tubes = self.faces.nearness[at], self.tubes.nearness[at]
        owners = self.tubes.owners[at]
        is_own = (owners >= 0) & (self.bands.hyperedges[np.maximum(owners, 0)] == hyperedge)
        room = np.where(is_own, OWN, CROSSING) * radii
        found = walls > self.view.nearer(near, TOUCHING * radii)
        return np.asarray(found | (tubes > self.view.nearer(near, room)))


def _with_neighbours(tubes: Indices, bands: Bands) -> Indices:
    """Pairs (k, 2), and the same of pieces next to either: the grid may miss where they overlap."""
    last = len(bands.firsts) - 1
    if len(tubes) == 0:
        return tubes
    found = [tubes]
    for column in (0, 1):
        for step in (-1, 1):
            beside = tubes.copy()
            beside[:, column] = np.clip(beside[:, column] + step, 0, last)
            near = bands.segments[beside[:, column]] == bands.segments[tubes[:, column]]
            found.append(beside[near])
    keys = np.unique(np.concatenate(found) @ np.array([last + 1, 1]))
    return np.stack(np.divmod(keys, last + 1), axis=1)


@dataclass(frozen=True, slots=True, eq=False)
class _Group:
    """Pieces that are hidden, and by what; ``whole`` is what they cover."""

    pieces: Indices
    whole: CrossSection
    hiding: CrossSection
    has_feet: bool
    has_tubes: bool


class Sight:
    """Cuts out of bands what is hidden; ``faces`` are contours of those that may hide."""

    def __init__(self, around: Surroundings, faces: Sequence[Sequence[Floats]]) -> None:
        self._around, self._faces = around, faces
        self._tubes, self._walls = map(_by_first, around.hiders())
        groups = _groups(around.bands.hyperedges, self._tubes, self._walls)
        self._groups = {owner: list(map(self._group, found)) for owner, found in groups.items()}

    def visible(self, hyperedge: int, wider: float, inset: float = 0.0) -> list[Floats]:
        """Contours (k, 2) of what is to be seen of a hyperedge, as `Bands.shapes` takes them."""
        bands, groups = self._around.bands, self._groups.get(hyperedge, [])
        pieces = np.arange(bands.starts[hyperedge], bands.starts[hyperedge + 1])
        is_free = np.ones(len(pieces), dtype=np.bool_)
        for group in groups:
            is_free[group.pieces - pieces[0]] = False
        parts = [_union(bands.shapes(pieces[is_free], wider, inset))]
        parts += [self._own(group, wider, inset) - group.hiding for group in groups]
        whole = CrossSection.batch_boolean(parts, OpType.Add) if groups else parts[0]
        return _rings(whole)

    def gaps(self, hyperedge: int) -> list[tuple[int, list[Floats]]]:
        """Contours of what is left out of a hyperedge beside tubes in front, and where they are.

        That is the number of the face behind each, or -1 where there is none.
        """
        found: list[tuple[int, list[Floats]]] = []
        for group in self._groups.get(hyperedge, []) if self._around.halo else ():
            if not group.has_tubes:
                continue
            narrow = self._hiding(group.pieces.tolist(), 1.0)
            gap = ((group.whole ^ group.hiding) - narrow).simplify(0.05)
            for part in gap.decompose():
                rings = _rings(part)
                if rings:
                    at = self._around.grid.places(rings[0])
                    faces = self._around.faces.owners[at] + 1
                    found.append((int(np.bincount(faces).argmax()) - 1, rings))
        return found

    def _group(self, group: list[int]) -> _Group:
        pieces = np.array(group)
        # Where a face hides the end of a tube, what would stand out of it is no round end.
        has_feet = self._walls.keys().isdisjoint(group)
        return _Group(
            pieces,
            _union(self._around.bands.shapes(pieces, 1.0, feet=has_feet)),
            self._hiding(group, 1.0 + self._around.halo),
            has_feet,
            not self._tubes.keys().isdisjoint(group),
        )

    def _own(self, group: _Group, wider: float, inset: float) -> CrossSection:
        if (wider, inset) == (1.0, 0.0):
            return group.whole
        return _union(self._around.bands.shapes(group.pieces, wider, inset, feet=group.has_feet))

    def _hiding(self, pieces: Sequence[int], wide: float) -> CrossSection:
        tubes = sorted({tube for piece in pieces for tube in self._tubes.get(piece, ())})
        walls = sorted({wall for piece in pieces for wall in self._walls.get(piece, ())})
        shapes = self._around.bands.shapes(np.array(tubes, dtype=np.int64), wide)
        return _union(shapes + [ring for wall in walls for ring in self._faces[wall]])


def _by_first(pairs: Indices) -> dict[int, list[int]]:
    """Who hides each one of those that are hidden, from pairs (k, 2) in order."""
    if len(pairs) == 0:
        return {}
    begins = np.flatnonzero(np.diff(pairs[:, 0], prepend=-1))
    hiders = np.split(pairs[:, 1], begins[1:])
    ones = pairs[begins, 0].tolist()
    return {one: others.tolist() for one, others in zip(ones, hiders, strict=True)}


def _groups(
    hyperedges: Indices, tubes: Mapping[int, list[int]], walls: Mapping[int, list[int]]
) -> dict[int, list[list[int]]]:
    """Hidden pieces of each hyperedge in groups: what hides one of a group hides no other wrongly.

    A tube may run between two pieces of one hyperedge, and a wall too; or be one of its pieces.
    """
    owners = hyperedges.tolist()
    above = {(hidden, owners[hider]) for hidden, hiders in tubes.items() for hider in hiders}
    groups: dict[int, dict[object, list[int]]] = defaultdict(lambda: defaultdict(list))
    for piece in sorted(tubes.keys() | walls.keys()):
        owner = owners[piece]
        is_between = any((tube, owner) in above for tube in tubes.get(piece, ()))
        by_own = any(owners[tube] == owner for tube in tubes.get(piece, ()))
        key: object = piece if is_between else (by_own, *walls.get(piece, ()))
        groups[owner][key].append(piece)
    return {owner: list(found.values()) for owner, found in groups.items()}


def _rings(whole: CrossSection) -> list[Floats]:
    return [ring for ring in whole.simplify(0.01).to_polygons() if abs(area(ring)) > SPECK]


def _union(shapes: Sequence[Floats]) -> CrossSection:
    """All contours (k, 2) together, which turn the same way."""
    return CrossSection(shapes, FillRule.NonZero)
