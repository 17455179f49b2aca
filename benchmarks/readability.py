"""How readable layouts of examples are, in rows and in the other modes of placement, as a table.

``python -m benchmarks.readability [NAME …]``; all are among the examples.

Crossings, and those below 20 degrees, are of middle lines of different hyperedges; hidden is the
mean share of tubes that is behind others or items; labels are free of which less than a fifth is
covered. All from one direction, without perspective: the program's own, or that one of `VIEWS` with
the fewest crossings. Seconds are those of the layout, by the clock, when kernels are compiled.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np

from app.formats import registry
from app.hyperedges.clearance.certificate import certify
from app.hyperedges.pinches import find_pinches
from app.layout import lay_out
from app.readability.drawing import drawing_of
from app.readability.projection import Projection, directions
from app.readability.shape import Shapes, shapes_of
from app.readability.view import Readability, fewest_crossings, readability
from app.scene.camera import Axes, axes_from, axes_of, view_of
from app.settings import Settings

EXAMPLES = Path(__file__).parents[1] / "examples"

SCENES = {
    "id3-clause-2": "tubeloom",
    "yosys/up3down5": "yosys",
    "hif/e-coli": "hif",
    "hif/lesmis": "hif",
}
"""Files, and their formats."""

NETLIST = "yosys/up3down5"

Way = Literal["planes", "elastic", "ground", "sheet", "space", "layers"]
WAYS: tuple[Way, ...] = ("planes", "elastic", "ground", "sheet", "space", "layers")
"""In rows, routed in planes and by relaxation; and the other modes of placement, of which the last
is for netlists."""

VIEWS = 60

COLUMNS = (
    "",
    "seconds",
    "own view: crossings",
    "below 20°",
    "hidden",
    "labels free",
    f"best of {VIEWS}: crossings",
    "below 20°",
    "hidden",
    "labels free",
    "length over Steiner",
    "turning",
    "vertical",
    "certified",
    "pinches",
    "own contacts",
)


@dataclass(frozen=True, slots=True, eq=False)
class Row:
    """One example by one way of routing."""

    title: str
    seconds: float
    own: Readability
    best: Readability
    shapes: Shapes
    certified: bool
    pinches: int
    own_contacts: int


def measure(name: str, way: Way) -> Row:
    """Lay out one of `SCENES` and look at it."""
    data = (EXAMPLES / f"{name}.json").read_bytes()
    wishes: tuple[tuple[str, object], ...] = (("placement", way),)
    if way in {"planes", "elastic"}:
        wishes = (("placement", "rows"), ("routing", way))
    program = registry.read(SCENES[name], data, Settings(), wishes)
    begun = time.perf_counter()
    layout = lay_out(program)
    seconds = time.perf_counter() - begun
    placement, routing = layout.placement, layout.routing
    proof = certify(routing, placement, program.layout.clearance or 0.0)
    drawing = drawing_of(routing, placement)
    views = [_projection((x, y, z)) for x, y, z in directions(VIEWS).tolist()]
    return Row(
        f"{name.rpartition('/')[2]}, {way}",
        seconds,
        readability(drawing, _projection_of(axes_of(view_of(program, placement.mode)))),
        readability(drawing, views[fewest_crossings(drawing, views)]),
        shapes_of(routing, placement),
        proof.certified,
        len(find_pinches(routing).segments),
        len(proof.own.hyperedges),
    )


def table(rows: Sequence[Row]) -> str:
    """The rows as a Markdown table."""
    lines = [f"| {' | '.join(COLUMNS)} |", "|---" + "|--:" * (len(COLUMNS) - 1) + "|"]
    for row in rows:
        cells = (
            row.title,
            f"{row.seconds:.2f}",
            *_cells(row.own),
            *_cells(row.best),
            f"{row.shapes.stretch:.2f}",
            f"{row.shapes.mean_turning:.1f}",
            f"{row.shapes.upright_share:.0%}",
            "yes" if row.certified else "no",
            str(row.pinches),
            str(row.own_contacts),
        )
        lines.append(f"| {' | '.join(cells)} |")
    return "\n".join(lines)


def main(names: Sequence[str]) -> int:
    """Measure the examples of these names, or all, and print the table."""
    chosen = [name for name in SCENES if not names or name.rpartition("/")[2] in names]
    for way in WAYS:  # kernels compile, or come from their cache, before anything is timed
        measure(NETLIST if way == "layers" else "id3-clause-2", way)
    ways = {name: WAYS if SCENES[name] == "yosys" else WAYS[:-1] for name in chosen}
    print(table([measure(name, way) for name in chosen for way in ways[name]]))
    return 0


def _cells(seen: Readability) -> tuple[str, str, str, str]:
    return (
        f"{seen.crossings:,}",
        f"{seen.acute:,}",
        f"{seen.mean_hidden:.2f}",
        f"{seen.free_labels:.2f}",
    )


def _projection(direction: tuple[float, float, float]) -> Projection:
    return _projection_of(axes_from(direction))


def _projection_of(axes: Axes) -> Projection:
    return Projection(np.stack([axes.right, axes.up, axes.back]))


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
