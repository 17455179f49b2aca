"""From a document of very many hyperedges to GLB, beside what packs glTF elsewhere.

Three attachments each, so three segments, among a fifth as many items; without clearance. The
whole pipeline is measured: reading, placing, routing, tubes, assembling, writing.
"""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
from functools import lru_cache, partial
from pathlib import Path
from statistics import median
from typing import Any, get_args

import numpy as np
import pytest

from app.answers import Answer, RenderOptions
from app.output.gltf import write_glb
from app.output.gltf_packing import Packing
from app.output.media import Compression
from app.pipeline import render
from app.program.model import Program
from app.settings import Settings
from app.staging import make_scene
from benchmarks.test_gltf import trimesh_scene

GLTFPACK = Path(__file__).parent / "node" / "node_modules" / "gltfpack" / "cli.js"
SIZES = {1_000: 5, 10_000: 2, 100_000: 1}
"""Hyperedges, and how often each is measured after one round that is not."""

REACH = 4
"""Items to all sides among which a hyperedge ends."""

_SECONDS: dict[tuple[Compression, int], float] = {}


@lru_cache(maxsize=1)
def document(hyperedges: int) -> bytes:
    """Items on a grid, and hyperedges between three that are near each other."""
    items = hyperedges // 5
    side = int(np.ceil(np.sqrt(items)))
    chance = np.random.default_rng(1)
    middles = chance.integers(0, items, hyperedges)
    steps = chance.integers(-REACH, REACH + 1, (hyperedges, 8, 2))
    x = np.clip(middles[:, None] % side + steps[..., 0], 0, side - 1)
    y = np.clip(middles[:, None] // side + steps[..., 1], 0, (items - 1) // side)
    near = np.minimum(y * side + x, items - 1)
    # Should those be fewer than three, the first items help out.
    ends = [list(dict.fromkeys([*found, 0, 1, 2]))[:3] for found in near.tolist()]
    program = {
        "items": [
            {"id": f"i{number}", "position": [3.0 * (number % side), 3.0 * (number // side), 0.5]}
            for number in range(items)
        ],
        "hyperedges": [
            {"id": f"e{number}", "attachments": [{"item": f"i{end}"} for end in found]}
            for number, found in enumerate(ends)
        ],
        "layout": {"clearance": None, "curves": "prose"},
    }
    return json.dumps(program, separators=(",", ":")).encode()


def glb(hyperedges: int, compress: Compression) -> bytes:
    """What the service would answer."""
    found = render(document(hyperedges), RenderOptions(compress=compress), Settings())
    assert isinstance(found, Answer)
    return found.body


@pytest.mark.parametrize("hyperedges", SIZES)
@pytest.mark.parametrize("compress", get_args(Compression))
def test_document_to_glb(benchmark: Any, compress: Compression, hyperedges: int) -> None:
    """Ours."""
    benchmark.group = f"{hyperedges:,} hyperedges of three attachments"
    benchmark.name = f"test_document_to_glb,_compress={compress}"
    document(hyperedges)
    body = benchmark.pedantic(
        glb, (hyperedges, compress), rounds=SIZES[hyperedges], warmup_rounds=1
    )
    benchmark.extra_info["MB"] = round(len(body) / 1e6, 1)
    _SECONDS[compress, hyperedges] = median(benchmark.stats.stats.data)
    measured = [size for size in SIZES if (compress, size) in _SECONDS]
    if len(measured) == len(SIZES):
        times = [_SECONDS[compress, size] for size in measured]
        exponent = np.polyfit(np.log(measured), np.log(times), 1)[0]
        benchmark.extra_info["time grows by the power"] = round(float(exponent), 2)


@pytest.mark.parametrize("hyperedges", [1_000, 10_000])
def test_trimesh_writing_alone(benchmark: Any, hyperedges: int) -> None:
    """The exporter that Python users would pick, on the same meshes; a node for each hyperedge."""
    benchmark.group = f"{hyperedges:,} hyperedges of three attachments"
    program = Program.model_validate_json(document(hyperedges))
    theirs = trimesh_scene(make_scene(program, 4 / 3, height=768))
    export = partial(theirs.export, file_type="glb", include_normals=True)
    body = benchmark.pedantic(export, rounds=1)
    benchmark.extra_info["MB"] = round(len(body) / 1e6, 1)


@pytest.mark.parametrize("merge", [False, True])
@pytest.mark.parametrize("hyperedges", SIZES)
def test_gltfpack_packing_alone(
    benchmark: Any, hyperedges: int, merge: bool, tmp_path: Path
) -> None:
    """The tool of meshoptimizer itself, on our plain GLB; it keeps extras, and nodes with names.

    Merged or not before, since it merges nothing of which it keeps the names.
    """
    benchmark.group = f"{hyperedges:,} hyperedges of three attachments"
    benchmark.name = f"test_gltfpack_packing_alone,_{'merged by us' if merge else 'not merged'}"
    if shutil.which("node") is None or not GLTFPACK.exists():
        pytest.skip("gltfpack needs Node.js, and npm ci in benchmarks/node")
    if not merge and hyperedges > 10_000:
        pytest.skip("nobody draws so many nodes")
    program = Program.model_validate_json(document(hyperedges))
    source, target = tmp_path / "plain.glb", tmp_path / "packed.glb"
    source.write_bytes(write_glb(make_scene(program, 4 / 3, height=768), Packing("none", merge)))
    command = ["node", str(GLTFPACK), "-i", str(source), "-o", str(target), "-c", "-kn", "-ke"]
    benchmark.pedantic(subprocess.run, (command,), {"check": True}, rounds=1)
    benchmark.extra_info["MB"] = round(target.stat().st_size / 1e6, 1)


@pytest.mark.parametrize("hyperedges", [100_000])
def test_memory_of_a_process_of_its_own(benchmark: Any, hyperedges: int) -> None:
    """Started anew, so without kernels loaded and memory at hand: the slowest it gets."""
    benchmark.group = f"{hyperedges:,} hyperedges of three attachments"
    code = "from benchmarks.test_large_scenes import report; report()"
    command = [sys.executable, "-c", code, str(hyperedges)]
    done = benchmark.pedantic(
        subprocess.run, (command,), {"capture_output": True, "check": True}, rounds=1
    )
    peak = float(done.stdout)
    benchmark.extra_info["GB at most"] = round(peak / 1e9, 2)
    assert peak < 4e9


def report() -> None:
    """Print the most memory that a meshopt GLB takes, in bytes; for a process of its own."""
    glb(int(sys.argv[1]), "meshopt")
    # Not getrusage, which counts the process that started this one.
    status = Path("/proc/self/status").read_text(encoding="ascii")
    print(1024 * int(status.partition("VmHWM:")[2].split()[0]))
