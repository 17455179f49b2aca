"""Draws the pictures of the README and the docs anew from the examples: `make pictures`."""

from __future__ import annotations

import io
from pathlib import Path

from PIL import Image

from app.answers import Answer, RenderOptions
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


def main() -> None:
    """Draw each at twice its size and halve it, so that the finest edges are smooth."""
    for name, source, width, height in PICTURES:
        options = RenderOptions(SceneFormat.PNG, 2 * width, 2 * height, source=source)
        answer = render((ROOT / "examples" / f"{name}.json").read_bytes(), options, Settings())
        assert isinstance(answer, Answer)  # noqa: S101 - nobody has it already
        picture = Image.open(io.BytesIO(answer.body))
        target = ROOT / "docs" / "pictures" / f"{Path(name).name}.png"
        picture.resize((width, height), Image.Resampling.LANCZOS).save(target, optimize=True)


if __name__ == "__main__":
    main()
