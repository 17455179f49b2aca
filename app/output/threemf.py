"""Scenes for printers as 3MF: named and coloured parts in millimetres.

The 3MF core specification, version 1.3: a ZIP archive in the manner of the Open Packaging
Conventions, with the model as XML.
"""

from __future__ import annotations

import io
import re
import zipfile
from collections.abc import Iterator
from xml.sax.saxutils import quoteattr

import numpy as np

from app.output.media import Parts
from app.output.shells import Shell, shells
from app.scene.color import hex_of, srgb_from_linear
from app.scene.scene import Material, Scene

_CONTENT_TYPES = (
    '<?xml version="1.0" encoding="UTF-8"?>\n'
    '<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">'
    '<Default Extension="rels" '
    'ContentType="application/vnd.openxmlformats-package.relationships+xml"/>'
    '<Default Extension="model" '
    'ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/>'
    "</Types>"
)

_RELATIONSHIPS = (
    '<?xml version="1.0" encoding="UTF-8"?>\n'
    '<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">'
    '<Relationship Target="/3D/3dmodel.model" Id="model" '
    'Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/>'
    "</Relationships>"
)

_MODEL = (
    '<?xml version="1.0" encoding="UTF-8"?>\n'
    '<model unit="millimeter" xml:lang="en-US" '
    'xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02">'
)

_NOT_IN_XML = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")

_LONG_AGO = (1980, 1, 1, 0, 0, 0)
"""The time of all entries, so that equal scenes have equal bytes."""

_MATERIALS = 1
"""The number of the group of materials; objects are numbered from the next."""


def write_3mf(scene: Scene, parts: Parts = "all", scale: float = 10.0) -> bytes:
    """Closed shells as 3MF (media type ``model/3mf``), ``scale`` millimetres to a unit.

    One object with a component for each shell (a hyperedge; an item's body; its label), which
    carries the id of what it is of, and its colour. All else is as in `write_stl`.
    """
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w") as archive:
        entries = {
            "[Content_Types].xml": iter([_CONTENT_TYPES]),
            "_rels/.rels": iter([_RELATIONSHIPS]),
            "3D/3dmodel.model": _model(scene, parts, scale),
        }
        for name, pieces in entries.items():
            entry = zipfile.ZipInfo(name, _LONG_AGO)
            entry.compress_type = zipfile.ZIP_DEFLATED
            with archive.open(entry, "w", force_zip64=True) as opened:
                for piece in pieces:
                    opened.write(piece.encode())
    return file.getvalue()


def _model(scene: Scene, parts: Parts, scale: float) -> Iterator[str]:
    materials = {material: number for number, material in enumerate(scene.materials)}
    yield _MODEL
    yield f'<metadata name="Title">{_text(scene.name)}</metadata><resources>'
    yield f'<basematerials id="{_MATERIALS}">'
    for material in materials:
        yield f'<base name={_quoted(material.name)} displaycolor="{_color(material)}"/>'
    yield "</basematerials>"
    number = _MATERIALS
    for number, shell in enumerate(shells(scene, parts, scale), start=_MATERIALS + 1):
        yield (
            f'<object id="{number}" type="model" name={_quoted(shell.name)} '
            f'pid="{_MATERIALS}" pindex="{materials[shell.material]}">'
        )
        yield from _mesh(shell)
        yield "</object>"
    if number == _MATERIALS:
        yield "</resources><build/></model>"
        return
    whole = number + 1
    yield f'<object id="{whole}" type="model" name={_quoted(scene.name or "Program")}><components>'
    for component in range(_MATERIALS + 1, whole):
        yield f'<component objectid="{component}"/>'
    yield f'</components></object></resources><build><item objectid="{whole}"/></build></model>'


def _mesh(shell: Shell) -> Iterator[str]:
    # Nine digits tell any two numbers of single precision apart. A format for all rows at once is
    # three times as fast as one for each.
    vertices, faces = shell.vertices, shell.faces
    yield "<mesh><vertices>"
    yield '<vertex x="%.9g" y="%.9g" z="%.9g"/>' * len(vertices) % tuple(vertices.ravel().tolist())
    yield "</vertices><triangles>"
    yield '<triangle v1="%d" v2="%d" v3="%d"/>' * len(faces) % tuple(faces.ravel().tolist())
    yield "</triangles></mesh>"


def _color(material: Material) -> str:
    color = hex_of(srgb_from_linear(np.array(material.base_color[:3])))
    return f"{color}{round(255 * material.base_color[3]):02x}".upper()


def _quoted(text: str) -> str:
    return quoteattr(_NOT_IN_XML.sub("\N{REPLACEMENT CHARACTER}", text))


def _text(text: str) -> str:
    return _quoted(text)[1:-1]
