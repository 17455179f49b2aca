"""Documents that show every shape in one material, and their pictures as they should look.

`python -m tests.golden.shelf` draws these anew: look at every one before you keep it.
"""

from __future__ import annotations

import sys
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, get_args

import httpx

from app.program.model import MaterialName
from tests.service import running_service

PICTURES = Path(__file__).with_name("pictures")
MATERIALS = get_args(MaterialName)
QUALITIES = ("draft", "final")
COLUMNS, ROWS = 3, 3
SIZES = {"draft": (384, 344), "final": (216, 194)}

SHAPES: dict[str, dict[str, Any]] = {
    "box": {"type": "box", "size": [1.3, 1.0, 1.0]},
    "tray": {"type": "tray", "size": [1.5, 1.3, 0.5]},
    "sphere": {"type": "sphere", "radius": 0.65},
    "cylinder": {"type": "cylinder", "radius": 0.55, "height": 1.1},
    "cone": {"type": "cone", "radius": 0.65, "height": 1.2},
    "arrow": {"type": "arrow", "length": 1.6, "radius": 0.45},
    "text": {"type": "text", "height": 0.9, "depth": 0.4},
    "csg": {
        "type": "csg",
        "tree": {
            "type": "difference",
            "of": [
                {"type": "box", "size": [1.2, 1.2, 1.0]},
                {"type": "sphere", "radius": 0.6, "position": [0.3, -0.3, 0.5]},
            ],
        },
    },
    "tube": {"type": "box", "size": [0.3, 0.3, 0.3]},
}


def document(material: str) -> dict[str, Any]:
    """Nine things of ``material`` on a shelf: eight items, and a hyperedge of three."""
    places = {
        name: [2.2 * (number % COLUMNS), -2.4 * (number // COLUMNS), HALF_HEIGHTS[name]]
        for number, name in enumerate(SHAPES)
    }
    x, y, _ = places["tube"]
    feet = {f"foot{number}": [x + dx, y + dy, 0.15] for number, (dx, dy) in enumerate(FEET)}
    items = [
        {"id": name, "shape": SHAPES[name], "position": place, "material": material}
        for name, place in places.items()
        if name != "tube"
    ]
    items += [
        {"id": name, "shape": SHAPES["tube"], "position": place} for name, place in feet.items()
    ]
    next(item for item in items if item["id"] == "text")["label"] = "Ag"
    if material not in {"wood", "stone"}:
        for item, color in zip(items, COLORS, strict=False):
            item["color"] = color
    return {
        "items": items,
        "hyperedges": [
            {
                "id": "tube",
                "radius": 0.16,
                "material": material,
                "attachments": [{"item": name} for name in feet],
            }
        ],
        # Pictures of materials are to stay as they are when routing gets better.
        "layout": {"routing": "planes"},
        "view": {"projection": "orthographic", "from": [0.15, -1, 1.1], "margin": 0.03},
    }


HALF_HEIGHTS = {
    "box": 0.5,
    "tray": 0.25,
    "sphere": 0.65,
    "cylinder": 0.55,
    "cone": 0.6,
    "arrow": 0.45,
    "text": 0.2,
    "csg": 0.5,
    "tube": 0.15,
}
FEET = ((-0.6, -0.3), (0.6, -0.4), (0.1, 0.6))
COLORS = ("#e4572e", "#3a7ca5", "#e8b23a", "#6a994e", "#9d4edd", "#00a6a6", "#c2185b", "#5f7c3a")


def query(quality: str) -> str:
    """What is asked of the service."""
    width, height = SIZES[quality]
    return f"/v1/render?format=png&quality={quality}&width={width}&height={height}&samples=64"


def path(material: str, quality: str) -> Path:
    """Where the picture is kept."""
    return PICTURES / f"{material}-{quality}.png"


def main() -> None:
    """Draw all of them, or only those whose names contain an argument."""
    PICTURES.mkdir(exist_ok=True)
    with (
        TemporaryDirectory() as folder,
        running_service(Path(folder), gl_platform="osmesa") as service,
        service.client() as client,
    ):
        for material in MATERIALS:
            for quality in QUALITIES:
                target = path(material, quality)
                if not sys.argv[1:] or any(part in target.name for part in sys.argv[1:]):
                    _draw(client, material, quality, target)


def _draw(client: httpx.Client, material: str, quality: str, target: Path) -> None:
    response = client.post(query(quality), json=document(material))
    response.raise_for_status()
    target.write_bytes(response.content)


if __name__ == "__main__":
    main()
