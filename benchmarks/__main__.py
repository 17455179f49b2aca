"""Runs all benchmarks and prints their tables as Markdown: ``python -m benchmarks [FILE …]``.

Within a group everything is measured in the same run; ratios are of medians, to the first row. How
readable layouts are (`benchmarks.readability`) stands at the end, where no files are named.
"""

from __future__ import annotations

import json
import platform
import subprocess
import sys
import tempfile
from collections import defaultdict
from pathlib import Path
from statistics import median, quantiles
from typing import Any

HERE = Path(__file__).parent


def main(files: list[str]) -> int:
    """Measure, then print; the exit status is pytest's."""
    with tempfile.TemporaryDirectory() as folder:
        found = Path(folder) / "figures.json"
        status = subprocess.call(
            [
                *(sys.executable, "-m", "pytest", "-q", "--benchmark-quiet"),
                f"--benchmark-json={found}",
                *(files or [str(HERE)]),
            ],
            cwd=HERE.parent,
        )
        if found.exists() and found.stat().st_size:
            print(tables(json.loads(found.read_text())))
    if not files:
        print("\n**How readable layouts are**\n")
        sys.stdout.flush()
        status = subprocess.call([sys.executable, "-m", "benchmarks.readability"]) or status
    return status


def tables(figures: dict[str, Any]) -> str:
    """The figures of pytest-benchmark as one Markdown table for each group."""
    machine = figures["machine_info"]
    cpu = machine["cpu"]
    where = (machine["python_version"], platform.system(), platform.machine())
    processor = f"{cpu.get('brand_raw', 'unknown processor')}, {cpu.get('count', '?')} cores"
    lines = [f"Python {' '.join(where)}; {processor}."]
    groups: dict[str, list[dict[str, Any]]] = defaultdict(list)
    for benchmark in figures["benchmarks"]:
        groups[benchmark["group"]].append(benchmark)
    for name, members in groups.items():
        lines += [
            "",
            f"**{name}**",
            "",
            "| | median | 95th percentile | ratio | |",
            "|---|--:|--:|--:|---|",
        ]
        first = median(members[0]["stats"]["data"])
        for member in members:
            times = sorted(member["stats"]["data"])
            high = quantiles(times, n=20)[-1] if len(times) >= 20 else times[-1]
            note = ", ".join(f"{key} {value}" for key, value in member["extra_info"].items())
            lines.append(
                f"| {title(member['name'])} | {duration(median(times))} | {duration(high)} "
                f"| {median(times) / first:.1f} | {note} |"
            )
    return "\n".join(lines)


def title(name: str) -> str:
    """A test's name as people read it."""
    plain = name.partition("[")[0].removeprefix("test_").replace("_", " ")
    return plain[:1].upper() + plain[1:]


def duration(seconds: float) -> str:
    """Three digits and a unit.

    >>> duration(0.01234)
    '12.3 ms'
    """
    factor, unit = (1, "s") if seconds >= 1 else (1e3, "ms") if seconds >= 1e-3 else (1e6, "µs")
    return f"{seconds * factor:.3g} {unit}"


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
