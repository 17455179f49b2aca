"""Draft pictures of 1024 by 768 pixels, beside VTK's of the same scenes without a window.

From a scene to pixels, both without any caches: ours with soft shadows, darkness around what stands
on the ground, halos, and glass in its order; VTK's plain, and with hard shadows. Both draw by the
OpenGL that is there: in software, if there is no GPU. The pictures are left in the folder for
temporary files, to be looked at.
"""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from app.formats import registry
from app.output.draft import draw, draw_views
from app.output.draft_view import sampling
from app.output.png import encode_png
from app.scene.motion import cameras_of
from app.scene.scene import Scene
from app.settings import Settings
from app.staging import make_scene
from benchmarks.test_large_scenes import document

EXAMPLES = Path(__file__).parents[1] / "examples"
SIZE = WIDTH, HEIGHT = 1024, 768
SCENES = {"ID3, clause 2": 20, "1,000 tubes": 10, "10,000 tubes": 3}
"""Scenes, and how often each is drawn. Tubes are by threes those of a hyperedge."""


@lru_cache(maxsize=1)
def scene(name: str) -> Scene:
    """One of the `SCENES`."""
    if name in SCENES and name.endswith("tubes"):
        data = document(int(name.split(maxsplit=1)[0].replace(",", "")) // 3 + 1)
    else:
        data = (EXAMPLES / "id3-clause-2.json").read_bytes()
    program = registry.read("tubeloom", data, Settings())
    return make_scene(program, WIDTH / HEIGHT, height=HEIGHT)


def _measure(benchmark: Any, name: str, maker: str, drawn: Callable[[Scene], Any]) -> None:
    benchmark.group = f"{name}: {WIDTH} by {HEIGHT} pixels"
    shown = scene(name)
    picture = benchmark.pedantic(
        lambda: drawn(shown), rounds=SCENES[name], warmup_rounds=2, iterations=1
    )
    count = sum(len(part.mesh.faces) for node in shown.nodes for part in node.primitives)
    benchmark.extra_info["triangles"] = f"{count:,}"
    pixels = np.asarray(picture)[..., :3]
    assert pixels.shape == (HEIGHT, WIDTH, 3)
    assert np.ptp(pixels.reshape(-1, 3), axis=0).min() > 100, "Nothing is to be seen."
    folder = Path(tempfile.gettempdir()) / "tubeloom-draft"
    folder.mkdir(exist_ok=True)
    Image.fromarray(pixels).save(folder / f"{name} by {maker}.png")


@pytest.mark.parametrize("name", SCENES)
def test_tubeloom(benchmark: Any, name: str) -> None:
    """Ours."""
    _measure(benchmark, name, "Tubeloom", lambda shown: draw(shown, *SIZE, sampling(*SIZE)))


@pytest.mark.parametrize("name", SCENES)
def test_vtk(benchmark: Any, name: str) -> None:
    """What a user of Python would pick: no shadows."""
    vtk_scene = pytest.importorskip("benchmarks.vtk_scene", exc_type=ImportError)
    _measure(benchmark, name, "VTK", lambda shown: vtk_scene.draw(shown, *SIZE))


@pytest.mark.parametrize("name", SCENES)
def test_vtk_with_shadows(benchmark: Any, name: str) -> None:
    """The nearest to ours that VTK has."""
    vtk_scene = pytest.importorskip("benchmarks.vtk_scene", exc_type=ImportError)
    drawn = "VTK with shadows"
    _measure(benchmark, name, drawn, lambda shown: vtk_scene.draw(shown, *SIZE, shadows=True))


def test_png(benchmark: Any) -> None:
    """Ours: the picture as a file."""
    benchmark.group = f"PNG of {WIDTH} by {HEIGHT} pixels"
    picture = draw(scene("ID3, clause 2"), *SIZE, sampling(*SIZE))
    file = benchmark.pedantic(lambda: encode_png(picture), rounds=20, warmup_rounds=2)
    benchmark.extra_info["kB"] = len(file) // 1000


def test_png_by_pillow(benchmark: Any, tmp_path: Path) -> None:
    """At zlib's level 3."""
    benchmark.group = f"PNG of {WIDTH} by {HEIGHT} pixels"
    picture, path = draw(scene("ID3, clause 2"), *SIZE, sampling(*SIZE)), tmp_path / "picture.png"
    benchmark.pedantic(lambda: picture.save(path, compress_level=3), rounds=20, warmup_rounds=2)
    benchmark.extra_info["kB"] = path.stat().st_size // 1000


def test_turntable(benchmark: Any) -> None:
    """Once around, as pixels."""
    shown = scene("ID3, clause 2")
    cameras = cameras_of(shown, "turntable", 36)
    benchmark.group = "36 frames of 640 by 480 pixels"
    frames = benchmark.pedantic(
        lambda: sum(1 for _ in draw_views(shown, cameras, 640, 480)), rounds=3, warmup_rounds=1
    )
    benchmark.extra_info["for each"] = f"{1e3 * benchmark.stats.stats.median / frames:.0f} ms"
