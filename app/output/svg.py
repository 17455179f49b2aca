"""Scenes as line drawings: SVG with an element for each item and each hyperedge.

What is hidden is not there: items are painted from back to front, and bands hold only what nothing
passes in front of. So every item and every hyperedge can be one group, with its own id.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from app.arrays import Floats
from app.hyperedges.routing import Routing
from app.output.svg_bands import Bands
from app.output.svg_faces import Face
from app.output.svg_items import Drawing, draw_items
from app.output.svg_labels import FAMILY, Writing
from app.output.svg_lines import hidden_edges, hidden_sides, shine
from app.output.svg_markup import decimal, escaped, name
from app.output.svg_paths import path
from app.output.svg_projection import Projection
from app.output.svg_raster import Foremost, foremost
from app.output.svg_shades import Shades
from app.output.svg_visible import Grid, Sight, Surroundings
from app.placement.placement import Placement
from app.program.model import Hyperedge, Item, Program
from app.scene.color import hex_of, srgb_from_linear
from app.scene.scene import Node, Scene

GRID = 600_000
"""Points on the grid that questions of order are answered on."""

OUTLINE = 1.0
"""Pixels of the dark edge of a band."""

THIN = 1.8
"""Pixels of a tube's radius below which its band has one colour."""

MANY = 400
"""Hyperedges from which on all bands have one colour: they are thin then, or nearly."""

STYLE = (
    "path{stroke-linejoin:round;stroke-linecap:round}.item path{stroke-width:.9px}"
    f"text{{font-family:{FAMILY};font-weight:600;white-space:pre}}"
)
"""For all elements of a kind; colours stand with each, where styles can change them."""

SHINE = (0.13, 0.3)
"""Of the light line along a band: how much lighter it is, and how wide, in radii."""


def write_svg(
    program: Program, placement: Placement, routing: Routing, scene: Scene, width: int, height: int
) -> bytes:
    """The line drawing of ``scene``, ``width`` by ``height`` pixels, as UTF-8."""
    view = Projection.of(scene.camera, width, height)
    scale = min(float(np.sqrt(GRID / (width * height))), 2.0)
    grid = Grid(max(round(width * scale), 1), max(round(height * scale), 1), scale)
    drawing = draw_items(scene, placement, view, grid)
    around = _surroundings(program, routing, drawing, view, grid)
    dashes = []
    if program.style.hidden_lines == "dashed":
        dashes = _dashes(program, placement, scene, around)
    return "".join(
        [
            *_head(program, scene, width, height),
            *_items(program, scene, drawing),
            *_hyperedges(program, scene, drawing, around),
            *dashes,
            "</svg>\n",
        ]
    ).encode()


def _head(program: Program, scene: Scene, width: int, height: int) -> list[str]:
    title = escaped(program.name or "Tubeloom")
    items, hyperedges = len(program.items), len(program.hyperedges)
    described = 'role="img" aria-labelledby="title desc"'
    size = f'width="{width}" height="{height}" viewBox="0 0 {width} {height}"'
    lines = [
        f'<svg xmlns="http://www.w3.org/2000/svg" {described} {size}>\n',
        f'<title id="title">{title}</title>\n',
        f'<desc id="desc">A drawing of {items} items and {hyperedges} hyperedges.</desc>\n',
        f"<style>{STYLE}</style>\n",
    ]
    if _sheet(scene):
        size = 'width="100%" height="100%"'
        lines.append(f'<rect class="background" {size} fill="{_sheet(scene)}"/>\n')
    return lines


def _items(program: Program, scene: Scene, drawing: Drawing) -> list[str]:
    parts: dict[int, list[str]] = {}
    for part in drawing.parts:
        line = ""
        if isinstance(part, Face):
            node = scene.nodes[part.owner]
            line = Shades.of(scene.materials[node.primitives[0].material]).line
            parts.setdefault(part.owner, []).append(_face(part, line))
        else:
            parts.setdefault(part.owner, []).append(_writing(part))
    return [
        _group("item", program.items[owner], "".join(parts.get(owner, [])))
        for owner in drawing.order
    ]


def _face(face: Face, line: str) -> str:
    data = path(face.outline, smooth=not face.is_polygon)
    if not data:
        return ""
    tones = "".join(f'<path fill="{color}" d="{path(rings)}"/>' for color, rings in face.tones)
    if face.lines is None and not tones:
        return f'<path fill="{face.color}" stroke="{line}" d="{data}"/>'
    edge = data if face.lines is None else path(face.lines, closed=False)
    return (
        f'<path fill="{face.color}" stroke="{face.color}" d="{data}"/>{tones}'
        f'<path class="line" fill="none" stroke="{line}" d="{edge}"/>'
    )


def _writing(writing: Writing) -> str:
    matrix = " ".join(f"{value:.4g}" for value in writing.matrix[:4])
    place = " ".join(map(decimal, writing.matrix[4:]))
    return (
        f'<text fill="{writing.color}" font-size="{decimal(writing.size)}" '
        f'textLength="{decimal(writing.length)}" lengthAdjust="spacingAndGlyphs" '
        f'transform="matrix({matrix} {place})">{escaped(writing.text)}</text>'
    )


def _surroundings(
    program: Program, routing: Routing, drawing: Drawing, view: Projection, grid: Grid
) -> Surroundings:
    lifts: Floats = np.zeros(len(program.hyperedges))
    if program.layout.dimensions == 2:
        # In one plane nothing is in front: what comes later in the document is.
        lifts += np.arange(len(lifts)) * float(routing.radii.max(initial=0.0))
    bands = Bands.of(routing, view, lifts)
    return Surroundings.of(bands, _foremost(drawing.faces, grid), program.style.halo, view, grid)


def _hyperedges(
    program: Program, scene: Scene, drawing: Drawing, around: Surroundings
) -> list[str]:
    faces = drawing.faces
    sight = Sight(around, [face.outline for face in faces])
    colors = [*(face.color for face in faces), _sheet(scene)]
    groups: list[str] = []
    nodes = scene.nodes[len(program.items) :]
    for number, hyperedge in enumerate(program.hyperedges):
        band = _band(around, sight, number, colors, _shades(scene, nodes[number]))
        groups.append(_group("hyperedge", hyperedge, band))
    return groups


def _sheet(scene: Scene) -> str:
    """The background's colour, or nothing."""
    if scene.background is None:
        return ""
    return hex_of(srgb_from_linear(np.array(scene.background)))


def _dashes(
    program: Program, placement: Placement, scene: Scene, around: Surroundings
) -> list[str]:
    found: list[str] = []
    for number, item in enumerate(program.items):
        if scene.nodes[number].primitives:
            edges = hidden_edges(number, placement, around.faces, around.view, around.grid)
            found.append(_dashed("item", item, edges, _shades(scene, scene.nodes[number])))
    for number, hyperedge in enumerate(program.hyperedges):
        sides = hidden_sides(around.bands, around, number)
        shades = _shades(scene, scene.nodes[len(program.items) + number])
        found.append(_dashed("hyperedge", hyperedge, sides, shades))
    return found


def _dashed(shows: str, part: Item | Hyperedge, lines: Sequence[Floats], shades: Shades) -> str:
    data = path(lines, closed=False)
    if not data:
        return ""
    return (
        f'<path class="hidden of-{shows}" data-of="{escaped(part.id)}" fill="none" '
        f'stroke="{shades.line}" stroke-width=".8" stroke-dasharray="4 3" d="{data}"/>\n'
    )


def _band(
    around: Surroundings, sight: Sight, number: int, colors: Sequence[str], shades: Shades
) -> str:
    """A hyperedge, given the ``colors`` of faces, the last one that of the sheet."""
    bands = around.bands
    width = float(
        np.median(bands.widths[bands.firsts[bands.starts[number] : bands.starts[number + 1]]])
    )
    outline = path(sight.visible(number, 1.0))
    if width < THIN or len(bands.starts) > MANY:
        return f'<path fill="{shades.lighter(0.0)}" d="{outline}"/>'
    text = "".join(
        f'<path class="gap" fill="{colors[face]}" d="{path(rings, smooth=False)}"/>'
        for face, rings in sight.gaps(number)
        if colors[face]
    )
    text += f'<path class="edge" fill="{shades.line}" d="{outline}"/>'
    inside = path(sight.visible(number, 1.0, OUTLINE))
    text += f'<path class="band" fill="{shades.lighter(0.0)}" d="{inside}"/>'
    light = path(shine(bands, around, number), closed=False)
    return text + (
        f'<path class="shine" fill="none" stroke="{shades.lighter(SHINE[0])}" '
        f'stroke-width="{decimal(SHINE[1] * width)}" d="{light}"/>'
    )


def _shades(scene: Scene, node: Node) -> Shades:
    return Shades.of(scene.materials[node.primitives[0].material])


def _foremost(faces: list[Face], grid: Grid) -> Foremost:
    if not faces:
        return foremost(np.zeros((0, 3, 3)), np.zeros(0, dtype=np.int64), grid.width, grid.height)
    triangles = grid.on(np.concatenate([face.triangles for face in faces]))
    owners = np.repeat(np.arange(len(faces)), [len(face.triangles) for face in faces])
    return foremost(triangles, owners, grid.width, grid.height)


def _group(shows: str, part: Item | Hyperedge, content: str) -> str:
    kind = "" if part.kind is None else " " + name("kind", part.kind)
    title = part.label or part.id
    return (
        f'<g id="{name(shows, part.id)}" class="{shows}{kind}" data-id="{escaped(part.id)}">'
        f"<title>{escaped(title)}</title>{content}</g>\n"
    )
