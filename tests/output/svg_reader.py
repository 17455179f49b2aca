"""Reads our drawings as any program would: XML, path data, and who is painted over whom."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET  # our own files
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from manifold3d import CrossSection, FillRule, triangulate
from PIL import Image, ImageDraw

from app.arrays import Floats, Indices
from app.formats import registry
from app.output.svg import write_svg
from app.settings import Settings
from app.staging import Staged, stage

SVG = "{http://www.w3.org/2000/svg}"
EXAMPLES = Path(__file__).parents[2] / "examples"
WIDTH, HEIGHT = 1024, 768

_TOKEN = re.compile(r"[MLlCcz]|-?(?:\d+\.?\d*|\.\d+)")


@dataclass(frozen=True)
class Stroke:
    """A path: contours (k, 2), which may be filled, of item or hyperedge ``owner``."""

    owner: str
    classes: str
    contours: list[Floats]
    is_filled: bool
    is_stroked: bool


def drawn(data: bytes, width: int = WIDTH, height: int = HEIGHT) -> tuple[Staged, bytes]:
    """A document's layout and scene, and its drawing."""
    program = registry.read("tubeloom", data, Settings())
    staged = stage(program, width / height, height=height)
    laid = staged.layout
    svg = write_svg(program, laid.placement, laid.routing, staged.scene, width, height)
    return staged, svg


def groups(svg: bytes) -> list[ET.Element]:
    """The groups of items and hyperedges, in the order of painting."""
    return ET.fromstring(svg).findall(f"{SVG}g")


def strokes(svg: bytes) -> list[Stroke]:
    """All paths of items and hyperedges, in the order of painting."""
    return [
        Stroke(
            group.attrib["id"],
            path.get("class", ""),
            contours(path.attrib["d"]),
            path.get("fill") != "none",
            "stroke" in path.attrib,
        )
        for group in groups(svg)
        for path in group.findall(f"{SVG}path")
    ]


def contours(data: str) -> list[Floats]:
    """Path data as contours (k, 2) of straight pieces."""
    tokens = _TOKEN.findall(data)
    assert "".join(tokens) == re.sub(r"[\s,]", "", data), "There is something else in it."
    found: list[list[tuple[float, float]]] = []
    command, place, at = "", 0, (0.0, 0.0)
    while place < len(tokens):
        if tokens[place].isalpha():
            command = tokens[place]
            place += 1
        if command == "z":
            continue
        count = 6 if command == "c" else 2
        numbers = [float(token) for token in tokens[place : place + count]]
        place += count
        if command == "M":
            at = (numbers[0], numbers[1])
            found.append([at])
        elif command == "l":
            at = (at[0] + numbers[0], at[1] + numbers[1])
            found[-1].append(at)
        else:
            control = np.array([0.0, 0.0, *numbers]).reshape(4, 2) + at
            t = np.linspace(0, 1, 13)[1:, None]
            s = 1 - t
            curve = s**3 * control[0] + 3 * s * s * t * control[1]
            curve += 3 * s * t * t * control[2] + t**3 * control[3]
            found[-1] += [(x, y) for x, y in curve.tolist()]
            at = found[-1][-1]
    return [np.array(contour) for contour in found]


def painted(svg: bytes, scale: int = 2) -> tuple[Indices, list[str]]:
    """Whose fill is uppermost at each pixel (0: nobody's), and the owners' ids from 1 on."""
    names = [group.attrib["id"] for group in groups(svg)]
    picture = Image.new("I", (WIDTH * scale, HEIGHT * scale))
    pen = ImageDraw.Draw(picture)
    for stroke in strokes(svg):
        if not stroke.is_filled:
            continue
        region = CrossSection([ring for ring in stroke.contours if len(ring) > 2], FillRule.NonZero)
        if region.area() == 0:
            turned = [ring[::-1] for ring in stroke.contours if len(ring) > 2]
            region = CrossSection(turned, FillRule.NonZero)
        rings = region.to_polygons()
        if not rings:
            continue
        corners = np.concatenate(rings) * scale
        for triangle in triangulate(rings):
            points = [(x, y) for x, y in corners[triangle].tolist()]
            pen.polygon(points, fill=names.index(stroke.owner) + 1)
    return np.asarray(picture, dtype=np.int64), names
