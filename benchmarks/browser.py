"""What browsers take: ``python -m benchmarks.browser``.

Chromium draws with the processor here, some 5 µs a triangle, beside the service on the same cores.
"""

from __future__ import annotations

import json
import subprocess
import tempfile
from collections import defaultdict
from pathlib import Path
from statistics import median
from typing import Any

from tests.browser.conftest import SCRIPTS, environment
from tests.service import running_service

CLAUSE = Path(__file__).parents[1] / "examples" / "id3-clause-2.json"


def measured() -> dict[str, Any]:
    """What the script found, with a service of its own."""
    with (
        tempfile.TemporaryDirectory() as folder,
        running_service(Path(folder), workers=2) as service,
    ):
        done = subprocess.run(
            ["node", str(SCRIPTS / "figures.mjs")],
            env={**environment(service.url), "CLAUSE": CLAUSE.read_text()},
            capture_output=True,
            text=True,
            check=True,
        )
    found: dict[str, Any] = json.loads(done.stdout)
    return found


def tables(found: dict[str, Any]) -> str:
    """For people."""
    times, bytes_of = defaultdict(list), {}
    for each in found["first"]:
        times[each["path"]].append(each["milliseconds"])
        bytes_of[each["path"]] = each["bytes"]
    lines = ["First picture of ID3 clause 2, from asking for the page (median of 5 browsers):"]
    for path, values in times.items():
        script = bytes_of[path] / 1000
        lines.append(f"  {path:16} {median(values):6.0f} ms, {script:.0f} kB of script (gzip)")
    lines.append("From an edit to its scene, ready to be drawn (median of 9); a frame by itself:")
    for each in found["edits"]:
        size = f"({each['triangles']} triangles, {each['calls']} calls)"
        took = f"{each['ready']:6.0f} ms, frame {each['frame']:5.0f} ms"
        lines.append(f"  {each['hyperedges']:6} hyperedges {took} {size}")
    crowd = found["crowd"]
    size = (
        f"{crowd['triangles']} triangles in {crowd['calls']} calls, {crowd['bytes'] / 1e6:.1f} MB"
    )
    took = f"ready after {crowd['milliseconds'] / 1000:.1f} s"
    lines.append(f"{crowd['hyperedges']} hyperedges: {size}, {took}")
    return "\n".join(lines)


if __name__ == "__main__":
    print(tables(measured()))
