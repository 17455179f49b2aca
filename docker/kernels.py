"""Compiles every kernel that a service needs, by doing once what it does."""

from __future__ import annotations

import json
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from app.cli import main

EXAMPLES = Path("examples")
CURVES: tuple[dict[str, Any], ...] = (
    {"curves": "prose", "fidelity": "paper", "tube": "patches"},
    {"curves": "symbolic", "closest": "plane"},
    {"routing": "planes"},
)
OUTPUTS = ("a.glb", "a.svg", "a.png", "a.stl")


def work(folder: Path) -> Iterator[list[str]]:
    """What is asked of the command line."""
    for name in ("hello.json", "id3-clause-2.json", "in-space.json"):
        document = str(EXAMPLES / name)
        yield ["layout", document, "--patches", "-o", str(folder / "a.json")]
        for output in OUTPUTS:
            yield ["render", document, "-o", str(folder / output)]
    for name in ("hif/lesmis.json", "yosys/up3down5.json"):
        known = ["--from", name.split("/")[0]]
        yield ["layout", str(EXAMPLES / name), *known, "-o", str(folder / "a.json")]
        yield ["render", str(EXAMPLES / name), *known, "-o", str(folder / "a.png")]
        packed = ["--merge", "--compress", "meshopt"]
        yield ["render", str(EXAMPLES / name), *known, *packed, "-o", str(folder / "a.glb")]
        program = folder / "program.json"
        yield ["convert", str(EXAMPLES / name), *known, "-o", str(program)]
        for number, layout in enumerate(CURVES):
            other = folder / f"{number}.json"
            other.write_text(json.dumps(json.loads(program.read_text()) | {"layout": layout}))
            yield ["layout", str(other), "--patches", "-o", str(folder / "a.json")]
            yield ["render", str(other), "-o", str(folder / "a.glb")]
    netlist = [str(EXAMPLES / "yosys/up3down5.json"), "--from", "yosys", "--placement", "layers"]
    yield ["render", *netlist, "-o", str(folder / "a.png")]


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as scratch:
        for words in work(Path(scratch)):
            main(words, standalone_mode=False)
