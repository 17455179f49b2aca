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
PLACEMENTS = (
    ("hif/lesmis", "sheet", 1024, 768),
    ("hif/lesmis", "ground", 1024, 768),
    ("hif/lesmis", "space", 1024, 768),
    ("hif/lesmis", "rows", 1024, 768),
    ("hif/e-coli", "sheet", 1024, 768),
    ("yosys/up3down5", "layers", 1024, 640),
)
"""Examples, named by their formats, and how their items are placed."""

FINAL_SAMPLES = 64


def main() -> None:
    """Draw each at twice its size and halve it, so that the finest edges are smooth."""
    document = (ROOT / "examples" / "id3-clause-2-materials.json").read_bytes()
    final = RenderOptions(SceneFormat.PNG, quality="final", effort=Effort(samples=FINAL_SAMPLES))
    _keep("id3-clause-2-final.png", document, final)
    drawn = (ROOT / "examples" / "id3-clause-2.json").read_bytes()
    _keep("id3-clause-2.svg", drawn, RenderOptions(SceneFormat.SVG))
    for name, source, width, height in PICTURES:
        document = (ROOT / "examples" / f"{name}.json").read_bytes()
        options = RenderOptions(SceneFormat.PNG, 2 * width, 2 * height, source=source)
        _keep_halved(f"{Path(name).name}.png", document, options)
    for name, placement, width, height in PLACEMENTS:
        document = (ROOT / "examples" / f"{name}.json").read_bytes()
        source = Path(name).parent.name
        wishes = (("placement", placement),)
        options = RenderOptions(
            SceneFormat.PNG, 2 * width, 2 * height, source=source, wishes=wishes
        )
        _keep_halved(f"{Path(name).name}-{placement}.png", document, options)


def _keep_halved(name: str, document: bytes, options: RenderOptions) -> None:
    answer = render(document, options, Settings(deadline_seconds=600))
    assert isinstance(answer, Answer)
    picture = Image.open(io.BytesIO(answer.body))
    half = picture.resize((options.width // 2, options.height // 2), Image.Resampling.LANCZOS)
    half.save(ROOT / "docs" / "pictures" / name, optimize=True)


def _keep(name: str, document: bytes, options: RenderOptions) -> None:
    answer = render(document, options, Settings(deadline_seconds=600))
    assert isinstance(answer, Answer)
    (ROOT / "docs" / "pictures" / name).write_bytes(answer.body)


if __name__ == "__main__":
    main()
