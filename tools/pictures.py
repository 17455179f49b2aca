"""Draws the pictures of the README and the docs anew from the examples: `make pictures`."""

from __future__ import annotations

import io
from pathlib import Path

from PIL import Image

from app.answers import Answer, RenderOptions
from app.output.effort import Effort
from app.output.media import SceneFormat
from app.pipeline import render
from app.settings import Settings

ROOT = Path(__file__).parents[1]
PICTURES = (
    ("id3-clause-2", "tubeloom", 1024, 768),
    ("id3-clause-1", "tubeloom", 800, 600),
    ("yosys/up3down5", "yosys", 1024, 768),
    ("shapes", "tubeloom", 800, 600),
)
LAYERS = ("up3down5-layers", "yosys/up3down5", 1024, 640)
"""A netlist as a schematic: the picture's name, the example, width and height."""


FINAL_SAMPLES = 64


def main() -> None:
    """Draw each at twice its size and halve it, so that the finest edges are smooth."""
    document = (ROOT / "examples" / "id3-clause-2-materials.json").read_bytes()
    wishes = RenderOptions(SceneFormat.PNG, quality="final", effort=Effort(samples=FINAL_SAMPLES))
    _keep("id3-clause-2-final.png", document, wishes)
    drawn = (ROOT / "examples" / "id3-clause-2.json").read_bytes()
    _keep("id3-clause-2.svg", drawn, RenderOptions(SceneFormat.SVG))
    for name, source, width, height in PICTURES:
        options = RenderOptions(SceneFormat.PNG, 2 * width, 2 * height, source=source)
        _halve(Path(name).name, name, options)
    name, example, width, height = LAYERS
    layers = (("placement", "layers"),)
    options = RenderOptions(SceneFormat.PNG, 2 * width, 2 * height, source="yosys", wishes=layers)
    _halve(name, example, options)


def _halve(name: str, example: str, options: RenderOptions) -> None:
    answer = render((ROOT / "examples" / f"{example}.json").read_bytes(), options, Settings())
    assert isinstance(answer, Answer)
    picture = Image.open(io.BytesIO(answer.body))
    target = ROOT / "docs" / "pictures" / f"{name}.png"
    size = options.width // 2, options.height // 2
    picture.resize(size, Image.Resampling.LANCZOS).save(target, optimize=True)


def _keep(name: str, document: bytes, options: RenderOptions) -> None:
    answer = render(document, options, Settings(deadline_seconds=600))
    assert isinstance(answer, Answer)
    (ROOT / "docs" / "pictures" / name).write_bytes(answer.body)


if __name__ == "__main__":
    main()
