"""Scenes for printers as binary STL: triangles in millimetres, and nothing else."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from app.output.media import Parts
from app.output.shells import Shell, shells
from app.scene.scene import Scene

RECORD = np.dtype(
    [("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")], align=False
)
"""A triangle: 50 bytes."""

_HEADER = b"Binary STL by Tubeloom. Millimetres, z up.".ljust(80)


def write_stl(scene: Scene, parts: Parts = "all", scale: float = 10.0) -> bytes:
    """Closed shells as binary STL (media type ``model/stl``), ``scale`` millimetres to a unit.

    Shells follow one another in the order of the document, items first; the lowest corner of all
    is at the origin, z is up. Shells may overlap, as a tube does the item that it ends in; no
    hyperedge overlaps itself. Raises `Unprintable` as `shells` does.
    """
    records = [_records(shell) for shell in shells(scene, parts, scale)]
    count = sum(len(part) for part in records)
    return b"".join([_HEADER, np.uint32(count).astype("<u4").tobytes(), *_bytes(records)])


def _bytes(records: list[np.ndarray[tuple[int], np.dtype[np.void]]]) -> Iterator[bytes]:
    for part in records:
        yield part.tobytes()


def _records(shell: Shell) -> np.ndarray[tuple[int], np.dtype[np.void]]:
    corners = shell.vertices[shell.faces]
    wide = corners.astype(np.float64)
    crossed = np.cross(wide[:, 1] - wide[:, 0], wide[:, 2] - wide[:, 0])
    lengths = np.linalg.norm(crossed, axis=1, keepdims=True)
    found = np.zeros(len(corners), dtype=RECORD)
    # A triangle without area has no normal: zeros tell readers to find their own.
    found["normal"] = np.divide(crossed, lengths, out=np.zeros_like(crossed), where=lengths > 0.0)
    found["corners"] = corners
    return found
