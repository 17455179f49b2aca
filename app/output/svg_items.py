"""All items of a scene as faces and labels, in the order in which they can be painted."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from manifold3d import CrossSection, FillRule

from app.arrays import Floats
from app.output.svg_faces import Face, block_faces, corners_of
from app.output.svg_labels import Writing, write
from app.output.svg_order import broken, order
from app.output.svg_projection import Projection
from app.output.svg_raster import overlaps
from app.output.svg_shades import Shades
from app.output.svg_surfaces import MANY, area, surface_faces
from app.output.svg_visible import Grid
from app.placement.placement import Placement
from app.placement.turning import matrices
from app.scene.color import hex_of, srgb_from_linear
from app.scene.scene import Node, Scene
from app.solids.solid import Box, Tray

Part = Face | Writing

NOISE = 2
"""Points of the grid: parts that touch each other seem to overlap at so many."""

MUCH = 25
"""Points of the grid: what one would see at once."""

SLIVER = 0.8
"""Pixels: what is left of a part that is narrower is left out."""

DEEPEST = 64
"""So many parts behind each other are looked at where no order is right for all."""


@dataclass(frozen=True, slots=True, eq=False)
class Drawing:
    """The items of a scene: parts in the order to paint them in, and the items' own order."""

    parts: tuple[Part, ...]
    order: tuple[int, ...]

    @property
    def faces(self) -> list[Face]:
        """The parts that can hide something."""
        return [part for part in self.parts if isinstance(part, Face)]


def draw_items(scene: Scene, placement: Placement, view: Projection, grid: Grid) -> Drawing:
    """The items of a scene as `view` shows them."""
    nodes = scene.nodes[: len(placement.solids)]
    turns = matrices(placement.rotations)
    parts = _bodies(scene, nodes, placement, turns, view)
    for number, (node, place) in enumerate(zip(nodes, placement.labels, strict=True)):
        if place is None or len(node.primitives) < 2:
            continue
        ink = scene.materials[node.primitives[1].material].base_color[:3]
        color = hex_of(srgb_from_linear(np.array(ink)))
        body = (turns[number], placement.centers[number])
        writing = write(number, place, body, color, view)
        if writing is not None:
            parts.append(writing)
    return _ordered(parts, len(nodes), grid)


def _bodies(
    scene: Scene, nodes: Sequence[Node], placement: Placement, turns: Floats, view: Projection
) -> list[Part]:
    boxes: list[tuple[int, Floats, Shades]] = []
    trays: list[tuple[int, Floats, Shades]] = []
    others: list[tuple[int, Shades]] = []
    for number, (node, solid) in enumerate(zip(nodes, placement.solids, strict=True)):
        if not node.primitives:
            continue
        shades = Shades.of(scene.materials[node.primitives[0].material])
        if isinstance(solid, Box | Tray):
            corners = corners_of(solid) @ turns[number].T + placement.centers[number]
            (boxes if isinstance(solid, Box) else trays).append((number, corners, shades))
        else:
            others.append((number, shades))
    parts: list[Part] = []
    for alike in (boxes, trays):
        if alike:
            parts += block_faces(
                [number for number, _, _ in alike],
                np.stack([corners for _, corners, _ in alike]),
                [shades for _, _, shades in alike],
                view,
            )
    for number, own in others:
        mesh = nodes[number].primitives[0].mesh
        place = (turns[number], placement.centers[number])
        parts += surface_faces(number, mesh, place, own, len(others) >= MANY, view)
    return parts


def _ordered(parts: list[Part], items: int, fine: Grid) -> Drawing:
    """First by item, then within each; what the items' order gets wrong is cut out."""
    if not parts:
        return Drawing((), tuple(range(items)))
    counts = [len(part.triangles) for part in parts]
    triangles = np.concatenate([part.triangles for part in parts])
    numbers = np.repeat(np.arange(len(parts)), counts)
    grid = fine.coarser
    pairs, weights = overlaps(grid.on(triangles), numbers, grid.width, grid.height)
    owners = np.array([part.owner for part in parts])
    ends = owners[pairs]
    between = ends[:, 0] != ends[:, 1]
    items_order = order(items, ends[between], weights[between])
    places = np.argsort(items_order)
    own = pairs[~between]
    within = np.argsort(order(len(parts), own, weights[~between]))
    painted = np.lexsort((within, places[owners])).tolist()
    at = np.argsort(painted).tolist()
    cut = list(parts)
    if broken(at, pairs[weights > NOISE]):
        # Then what is farther apart may be wrong as well; where much is, it is looked at closely.
        grid = fine if broken(at, pairs[weights > MUCH]) else grid
        all_pairs, _ = overlaps(grid.on(triangles), numbers, grid.width, grid.height, DEEPEST)
        for behind, front in broken(at, all_pairs):
            cut[behind] = _less(cut[behind], parts[front])
    return Drawing(tuple(cut[number] for number in painted), tuple(items_order))


def _less(behind: Part, front: Part) -> Part:
    """A part without what another one hides; text cannot be cut."""
    if not isinstance(behind, Face) or not isinstance(front, Face):
        return behind
    hole = _region(front.outline)
    outline = _left(behind.outline, hole)
    tones = [(color, _left(rings, hole)) for color, rings in behind.tones]
    return replace(behind, outline=outline, tones=tones, lines=None)


def _left(rings: Sequence[Floats], hole: CrossSection) -> list[Floats]:
    """What is left of contours, but for slivers."""
    found = []
    for ring in (_region(rings) - hole).to_polygons():
        around = float(np.hypot(*np.diff(ring, axis=0, append=ring[:1]).T).sum())
        if abs(area(ring)) > SLIVER / 2 * around:
            found.append(ring)
    return found


def _region(rings: Sequence[Floats]) -> CrossSection:
    return CrossSection(rings, FillRule.NonZero)
