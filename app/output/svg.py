"""Line drawings: the scene as SVG, with text as text, and no line that something hides."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from xml.sax.saxutils import escape, quoteattr

import numpy as np

from app.arrays import Flags, Floats
from app.hyperedges.routing import Routing
from app.output.depth_buffer import depths_of
from app.output.projection import Projection
from app.output.svg_bands import Lines, runs, sides
from app.output.svg_faces import Face, faces_of
from app.placement.placement import LabelPlace, Placement
from app.placement.turning import matrices
from app.program.model import Hyperedge, Item, Program
from app.scene.color import hex_of, srgb_from_linear
from app.scene.scene import Node, Scene
from app.solids.lettering import lettering

CAPITAL = 0.7273
"""Height of Inter's capitals, in ems."""

STYLE = """
.item path{stroke:#3a4552;stroke-width:.8;stroke-linejoin:round}
.item text{font-family:Inter,'Noto Sans',system-ui,sans-serif;font-weight:600;text-anchor:middle}
.hyperedge .side{fill:none;stroke-width:1;stroke-linecap:butt;stroke-linejoin:round}
.hyperedge .light{fill:none;stroke:#fff;stroke-opacity:.35;stroke-linejoin:round}
.hyperedge .hidden{fill:none;stroke-width:1;stroke-dasharray:3 3;stroke-opacity:.7}
"""


def write_svg(
    program: Program,
    placement: Placement,
    routing: Routing,
    scene: Scene,
    width: int,
    height: int,
) -> bytes:
    """The drawing, ``width`` by ``height`` pixels, in UTF-8.

    Every item and every hyperedge is a group with an id, classes (``item`` or ``hyperedge``, and
    ``kind-…``), ``data-id`` as in the document, and a title; items stand within what contains them.
    """
    drawing = _Drawing(
        program, placement, routing, scene, Projection.of(scene.camera, width, height)
    )
    title = program.name or "A program"
    counts = f"{len(program.items)} items and {len(program.hyperedges)} hyperedges"
    size = f'width="{width}" height="{height}" viewBox="0 0 {width} {height}"'
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" {size} role="img" aria-labelledby="title desc">',
        f'<title id="title">{_text(title)}</title><desc id="desc">{counts}</desc>',
        f"<style>{STYLE}</style>",
    ]
    if scene.background is not None:
        color = hex_of(srgb_from_linear(np.array(scene.background)))
        parts.append(f'<rect class="background" width="100%" height="100%" fill="{color}"/>')
    parts.extend(drawing.items())
    parts.extend(drawing.hyperedges())
    parts.append("</svg>\n")
    return "\n".join(parts).encode()


class _Drawing:
    """What is drawn, and how it is seen."""

    def __init__(
        self,
        program: Program,
        placement: Placement,
        routing: Routing,
        scene: Scene,
        projection: Projection,
    ) -> None:
        self.program, self.placement, self.routing = program, placement, routing
        self.scene, self.projection = scene, projection
        self.nodes = {(node.shows, node.name): node for node in scene.nodes}
        self.rotations = (
            matrices(placement.rotations) if len(program.items) else np.zeros((0, 3, 3))
        )
        numbers = {item.id: number for number, item in enumerate(program.items)}
        self.children: dict[int | None, list[int]] = {}
        for number, item in enumerate(program.items):
            parent = None if item.parent is None else numbers[item.parent]
            self.children.setdefault(parent, []).append(number)

    def items(self) -> Iterator[str]:
        """All items, from back to front; what is in a tray comes before its front walls."""
        stack: list[int | str] = list(reversed(self._in_order(self.children.get(None, []))))
        while stack:
            entry = stack.pop()
            if isinstance(entry, str):
                yield entry
                continue
            item = self.program.items[entry]
            back, front = self._body(entry, item)
            yield f"<g {_names('item', entry, item)}>{_title(item)}{back}"
            stack.append(front + "</g>")
            stack.extend(reversed(self._in_order(self.children.get(entry, []))))

    def hyperedges(self) -> Iterator[str]:
        """All hyperedges, those behind first."""
        if not self.program.hyperedges:
            return
        lines = Lines.of(self.routing, self.projection)
        surfaces = depths_of(self.scene, self.projection, frozenset({"item"}))
        before = lines.before(surfaces)
        tubes = depths_of(self.scene, self.projection, frozenset({"hyperedge"}))
        shown = before & lines.before(tubes, slack=2.0)
        shown &= ~lines.under(self.program.style.halo)
        starts = lines.starts[self.routing.segment_starts]
        sums = np.add.reduceat(lines.places[:, 2], starts[:-1]) / np.maximum(np.diff(starts), 1)
        for number in np.argsort(-sums, kind="stable").tolist():
            hyperedge = self.program.hyperedges[number]
            color = self._color(self.nodes[("hyperedge", hyperedge.id)])
            first, last = self.routing.segment_starts[number : number + 2]
            pieces = "".join(
                self._band(lines, segment, shown, before, color) for segment in range(first, last)
            )
            yield f"<g {_names('hyperedge', number, hyperedge)}>{_title(hyperedge)}{pieces}</g>"

    def _band(self, lines: Lines, segment: int, shown: Flags, before: Flags, color: Floats) -> str:
        places = slice(lines.starts[segment], lines.starts[segment + 1])
        points, halves = lines.places[places, :2], lines.halves[places]
        fill, edge = hex_of(color), hex_of(color * 0.55)
        found = []
        for first, last in runs(shown[places]):
            part = slice(first, last + 1)
            left, right = sides(points[part], halves[part])
            thin = float(halves[part].mean())
            found.append(
                f'<path fill="{fill}" d="{_path(np.concatenate([left, right[::-1]]), True)}"/>'
                f'<path class="side" stroke="{edge}" d="{_path(left)}{_path(right)}"/>'
            )
            if thin > 2.0:
                inset = points[part] - (right - points[part]) * 0.25
                found.append(
                    f'<path class="light" stroke-width="{0.5 * thin:.1f}" d="{_path(inset)}"/>'
                )
        if self.program.style.hidden_lines == "dashed":
            for first, last in runs(~before[places]):
                path = _path(points[first : last + 1])
                found.append(f'<path class="hidden" stroke="{edge}" d="{path}"/>')
        return "".join(found)

    def _body(self, number: int, item: Item) -> tuple[str, str]:
        """What is drawn before an item's contents, and what after them."""
        node = self.nodes[("item", item.id)]
        color = self._color(node)
        place = self.placement.labels[number]
        center, rotation = self.placement.centers[number], self.rotations[number]
        faces = faces_of(self.placement.solids[number], rotation, center, self.projection)
        label = ""
        if place is not None and self.program.style.labels:
            label = self._label(place, center, rotation, node)
        back = "".join(_face(face, color) for face in faces if not face.covers)
        front = "".join(_face(face, color) for face in faces if face.covers)
        return back + label, front

    def _label(self, place: LabelPlace, center: Floats, rotation: Floats, node: Node) -> str:
        """The label as text on its plane, where that faces the camera."""
        plane = rotation @ matrices(np.array(place.rotation))
        middle = center + rotation @ np.array(place.position)
        lying = plane[:, 2] * place.size[2] / 2
        if self.projection.sees_front((middle + lying)[None], plane[:, 2][None])[0] <= 0:
            return ""
        x, y = plane[:, 0], -plane[:, 1]
        origin, right, down = self.projection(
            np.array([middle + lying, middle + lying + x, middle + lying + y])
        )[:, :2]
        a, b = right - origin
        c, d = down - origin
        matrix = " ".join(f"{value:.3f}" for value in (a, b, c, d, *origin))
        line = lettering(place.text.text)
        size = place.text.height / CAPITAL
        low, high = np.asarray(line.bounds)[:, 1] * place.text.height
        baseline = (low + high) / 2
        ink = self._ink(node)
        return (
            f'<text transform="matrix({matrix})" y="{baseline:.3f}" font-size="{size:.3f}"'
            f' textLength="{place.size[0]:.3f}" lengthAdjust="spacingAndGlyphs" fill="{ink}">'
            f"{_text(place.text.text)}</text>"
        )

    def _color(self, node: Node) -> Floats:
        """SRGB (3,) of a node's body; grey where it has none."""
        if not node.primitives:
            return np.full(3, 0.7)
        material = self.scene.materials[node.primitives[0].material]
        return srgb_from_linear(np.array(material.base_color[:3]))

    def _ink(self, node: Node) -> str:
        material = self.scene.materials[node.primitives[-1].material]
        return hex_of(srgb_from_linear(np.array(material.base_color[:3])))

    def _in_order(self, numbers: Sequence[int]) -> list[int]:
        """Siblings from back to front."""
        centers = self.placement.centers[list(numbers)]
        depths = self.projection(centers)[:, 2] if len(numbers) else np.zeros(0)
        return [numbers[place] for place in np.argsort(-depths, kind="stable")]


def _face(face: Face, color: Floats) -> str:
    tone = color * (0.62 + 0.38 * face.light) + 0.10 * max(face.light - 0.6, 0.0)
    path = "".join(_path(ring, True) for ring in face.rings)
    return f'<path fill="{hex_of(np.clip(tone, 0.0, 1.0))}" d="{path}"/>' if path else ""


def _path(points: Floats, closed: bool = False) -> str:
    """Straight lines through points (p, 2): relative, in tenths of a pixel."""
    tenths = np.round(points * 10).astype(np.int64)
    steps = np.diff(tenths, axis=0)
    x, y = tenths[0].tolist()
    relative = " ".join(f"{a / 10:g},{b / 10:g}" for a, b in steps.tolist())
    return f"M{x / 10:g},{y / 10:g}l{relative}{'z' if closed else ''}"


def _names(what: str, number: int, named: Item | Hyperedge) -> str:
    """Attributes of a group. Ids of the document may hold anything; ours may not."""
    classes = what if named.kind is None else f"{what} kind-{_word(named.kind)}"
    return f'id="{what}-{number}" class="{classes}" data-id={quoteattr(_clean(named.id))}'


def _title(named: Item | Hyperedge) -> str:
    return f"<title>{_text(named.label or named.id)}</title>"


def _text(text: str) -> str:
    return escape(_clean(text))


def _clean(text: str) -> str:
    """Without the characters that XML 1.0 cannot hold."""
    return _FORBIDDEN.sub("\N{REPLACEMENT CHARACTER}", text)


def _word(text: str) -> str:
    """A class name."""
    return re.sub(r"[^A-Za-z0-9_-]", "-", text)


_FORBIDDEN = re.compile(r"[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
