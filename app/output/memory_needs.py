"""How much memory a picture takes, and whether there is that much.

Native renderers do not survive every allocation that fails, so they are not to meet one: what does
not fit is refused before. Figures are upper bounds, measured on Debian 12 with two cores as growth
of a worker's data segment (`VmData`), which is what its limit counts.
"""

from __future__ import annotations

import math
import os
import resource
from pathlib import Path

from app.output.draft_view import MOST_SIDE, sampling
from app.scene.scene import Scene

MIB = 1 << 20

WORKER = 320 * MIB
"""Of a worker that is warm and has drawn nothing."""

THREAD = 8 * MIB
"""Stack of each thread that a renderer starts; it starts one for each core, up to 32."""

OPENGL = 145 * MIB
"""Context, compiled shaders, and the smallest map of shadows."""

SHADOWS = 12 * MIB
"""By which the largest map of shadows is larger."""

DRAFT_SAMPLE, DRAFT_PIXEL = 24, 20
"""Bytes for each sample, and besides for each pixel, of a tile that is drawn at once."""

PAGE_PIXEL = 20
"""Bytes for each pixel of the whole picture: joined, converted and encoded."""

MITSUBA = 165 * MIB
TRACED_PIXEL, TRACED_AT_ONCE = 320, 1 << 20
"""Bytes for each pixel that is traced at once, and how many those are at most."""

DENOISED_PIXEL, DENOISER = 740, 768
"""Bytes for each pixel that is denoised at once, and the MiB that all of them may take."""

FINAL_PIXEL = 84
"""Bytes for each pixel of the whole picture: light, its squares, guides, and what is made of it."""

DRAFT_SCENE, FINAL_SCENE = (80, 30), (100, 250)
"""Bytes for each vertex, and for each triangle: arrays twice, and a tree of boxes over them."""


def draft_bytes(width: int, height: int, *, has_begun: bool = False) -> int:
    """What drawing a draft takes at most; less where the renderer ``has_begun``."""
    tile = math.ceil(width / math.ceil(width / MOST_SIDE)) * math.ceil(
        height / math.ceil(height / MOST_SIDE)
    )
    samples = sampling(width, height)
    start = 0 if has_begun else OPENGL + _threads() * THREAD
    start += SHADOWS if max(width, height) > 682 else 0
    return start + tile * (DRAFT_SAMPLE * samples + DRAFT_PIXEL) + PAGE_PIXEL * width * height


def final_bytes(width: int, height: int, *, denoise: bool, has_begun: bool = False) -> int:
    """What drawing a final picture takes at most; less where the renderer ``has_begun``."""
    pixels = width * height
    traced = min(pixels, TRACED_AT_ONCE) * TRACED_PIXEL
    denoised = min(pixels * DENOISED_PIXEL, DENOISER * MIB) if denoise else 0
    start = 0 if has_begun else MITSUBA + _threads() * THREAD
    return start + traced + denoised + FINAL_PIXEL * pixels


def scene_bytes(scene: Scene, vertex: int, triangle: int) -> int:
    """What a renderer keeps of a scene, with so many bytes for each vertex and triangle."""
    meshes = [primitive.mesh for node in scene.nodes for primitive in node.primitives]
    return sum(vertex * len(mesh.vertices) + triangle * len(mesh.faces) for mesh in meshes)


class NotEnoughMemoryError(MemoryError):
    """What is to be drawn needs ``total`` bytes, with all that the process holds."""

    def __init__(self, total: int) -> None:
        super().__init__(f"{total} bytes are needed.")
        self.total = total


def require(size: int) -> None:
    """Raise `NotEnoughMemoryError` where this process may not take so many bytes more."""
    limit, _ = resource.getrlimit(resource.RLIMIT_DATA)
    total = held_bytes() + size
    if limit != resource.RLIM_INFINITY and total > limit:
        raise NotEnoughMemoryError(total)


def held_bytes() -> int:
    """What this process holds of what its limit counts; 0 where the system does not tell."""
    try:
        status = Path("/proc/self/status").read_text()
    except OSError:
        return 0
    found = (line.split()[1] for line in status.splitlines() if line.startswith("VmData:"))
    return 1024 * int(next(found, 0))


def _threads() -> int:
    return min(os.cpu_count() or 1, 32)
