"""Labels as solid letters."""

from __future__ import annotations

import numpy as np

from app.solids.glyphs import glyph
from app.solids.lettering import lettering
from app.solids.mesh import Mesh
from app.solids.solid import Text


def text_mesh(text: Text) -> Mesh:
    """All letters, each closed by itself; no triangles where there is nothing to see."""
    line = lettering(text.text)
    letters = [
        glyph(face, number) for face, number in zip(line.typefaces, line.glyphs, strict=True)
    ]
    if not letters:
        return Mesh.none()
    counts = [len(letter.vertices) for letter in letters]
    origins = np.zeros((len(letters), 3))
    origins[:, :2] = line.origins - line.bounds.mean(axis=0)
    vertices = np.concatenate([letter.vertices for letter in letters])
    vertices += np.repeat(origins, counts, axis=0)
    vertices *= (text.height, text.height, text.depth / 2)
    firsts = np.cumsum(counts) - counts
    faces = np.concatenate([letter.faces for letter in letters])
    faces += np.repeat(firsts, [len(letter.faces) for letter in letters])[:, None].astype(np.uint32)
    return Mesh(
        vertices.astype(np.float32), np.concatenate([letter.normals for letter in letters]), faces
    )
