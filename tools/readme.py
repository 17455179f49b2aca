"""Tries what the README shows, and every example, on a service that runs: readme.py URL.

Needs no more than `make run` has put in place, so it may be run before anything else is installed.
"""

from __future__ import annotations

import io
import json
import os
import re
import subprocess
import sys
import tempfile
import time
import urllib.request
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from PIL import Image, ImageSequence

ROOT = Path(__file__).parents[1]
USUAL_URL = "http://127.0.0.1:8000"

WITHIN_SECONDS = 600.0
"""For one command or picture, on a machine that has much else to do."""

FORMATS = ("format=png", "format=svg", "format=glb")
SLOW_FORMATS = (
    "format=png&quality=final&samples=4&width=256&height=192",
    "format=webp&frames=3&width=128&height=96",
    "format=mp4&frames=3&width=128&height=96",
)
"""Asked of one example only: what they need of the machine is the same for all."""

FEWEST_COLORS = 50
FEWEST_DRAWN = 0.01
"""Share of the pixels that are not background, in the emptiest example."""


def shell_blocks(page: Path) -> list[str]:
    """The fenced blocks of shell commands of a page."""
    return re.findall(r"^```sh\n(.*?)^```", page.read_text(), re.MULTILINE | re.DOTALL)


def run_block(block: str, url: str, folder: Path) -> subprocess.CompletedProcess[str]:
    """Run a block as it stands, but with another service, in ``folder``."""
    for name in ("examples", ".venv"):
        (folder / name).symlink_to(ROOT / name)
    script = block.replace(USUAL_URL, url)
    script = re.sub(r"\bcurl\b", "curl --silent --show-error --fail-with-body", script)
    return subprocess.run(
        ["bash", "-euo", "pipefail", "-c", script],
        cwd=folder, capture_output=True, text=True, check=False, timeout=WITHIN_SECONDS,
    )  # fmt: skip


def check_picture(data: bytes) -> None:
    """Raise `ValueError` unless every frame of a picture shows something."""
    for frame in ImageSequence.Iterator(Image.open(io.BytesIO(data))):
        pixels = np.asarray(frame.convert("RGB")).reshape(-1, 3)
        colors, counts = np.unique(pixels, axis=0, return_counts=True)
        drawn = 1.0 - counts.max() / len(pixels)
        if len(colors) < FEWEST_COLORS or drawn < FEWEST_DRAWN:
            raise ValueError(f"only {len(colors)} colours, and {drawn:.1%} drawn")


def check_file(data: bytes) -> None:
    """Raise `ValueError` unless what came is a scene, a drawing, a document or a picture."""
    if data.startswith(b"glTF"):
        count = json.loads(data[20 : 20 + int.from_bytes(data[12:16], "little")])["meshes"]
        if not count:
            raise ValueError("the scene has no meshes")
    elif data[4:12] == b"ftypiso5" or data[4:8] == b"ftyp":
        if b"av01" not in data:
            raise ValueError("the film has no video track")
    elif data.startswith((b"<svg", b"<?xml")):
        if data.count(b"<path") < 2:
            raise ValueError("the drawing has no lines")
    elif data.startswith(b"{"):
        json.loads(data)
    else:
        check_picture(data)


def example_queries() -> Iterator[tuple[Path, str]]:
    """Each example, and what is asked of it."""
    for path in sorted((ROOT / "examples").rglob("*.json")):
        source = path.parent.name if path.parent.name in {"yosys", "hif"} else "tubeloom"
        slow = SLOW_FORMATS if path.stem == "id3-clause-2-materials" else ()
        for query in (*FORMATS, *slow):
            yield path, f"{query}&from={source}"


def render(url: str, path: Path, query: str) -> bytes:
    """What the service answers. Raises `OSError` where it refuses."""
    request = urllib.request.Request(f"{url}/v1/render?{query}", path.read_bytes())
    with urllib.request.urlopen(request, timeout=WITHIN_SECONDS) as answer:
        return bytes(answer.read())


def main(url: str) -> int:
    """Try all, print a line for each, and return how many fail."""
    failed = 0

    def report(name: str, start: float, problem: str) -> None:
        nonlocal failed
        failed += bool(problem)
        took = time.monotonic() - start
        sys.stdout.write(f"{took:7.1f} s  {name}{': FAILED: ' + problem if problem else ''}\n")
        sys.stdout.flush()

    for number, block in enumerate(shell_blocks(ROOT / "README.md"), 1):
        if block.startswith("make "):
            continue
        start = time.monotonic()
        with tempfile.TemporaryDirectory() as folder:
            done = run_block(block, url, Path(folder))
            problem = (done.stdout + done.stderr) if done.returncode else ""
            try:
                for path in Path(folder).iterdir():
                    if path.is_file():
                        check_file(path.read_bytes())
            except (ValueError, OSError) as error:
                problem += str(error)
        report(f"README.md, block {number}", start, problem)
    for path, query in example_queries():
        start, problem = time.monotonic(), ""
        try:
            check_file(render(url, path, query))
        except (ValueError, OSError) as error:
            problem = str(error)
        report(f"{path.relative_to(ROOT)}?{query}", start, problem)
    with urllib.request.urlopen(f"{url}/readyz", timeout=WITHIN_SECONDS) as answer:
        ready = json.load(answer)
    report("/readyz", time.monotonic(), "" if ready["status"] == "ready" else json.dumps(ready))
    return failed


if __name__ == "__main__":
    os.chdir(ROOT)
    sys.exit(main(*(sys.argv[1:] or [USUAL_URL])) and 1)
