"""What others make of the same hyperedges: ELK and libavoid in the plane, Graphviz in both spaces.

None of them knows tubes, nor attachments of which each hyperedge has its own. ELK and sfdp put the
items elsewhere; a hyperedge is drawn as edges from one port (ELK), or as a star (the others).
"""

from __future__ import annotations

import json
import shutil
import subprocess
from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path
from types import TracebackType
from typing import Any, Self

import numpy as np
import pytest

from app.arrays import Floats, Indices
from app.hyperedges.routing import Routing
from benchmarks.random_programs import RandomProgram

FOLDER = Path(__file__).parent / "node"
POINTS = 72.0
"""Graphviz's points in an inch; a document unit is an inch here."""

Line = tuple[int, Floats]
"""The hyperedge that a line belongs to, and its corners (c, 2) or (c, 3)."""


class NodePeer:
    """A script in ``benchmarks/node`` that answers one line of JSON with another."""

    def __init__(self, script: str) -> None:
        if shutil.which("node") is None:
            pytest.skip("Node.js is not installed: apt-get install nodejs npm")
        if not (FOLDER / "node_modules").exists():
            pytest.skip(f"{script} needs its packages: cd benchmarks/node && npm ci")
        self._process = subprocess.Popen(
            ["node", script], cwd=FOLDER, stdin=subprocess.PIPE, stdout=subprocess.PIPE
        )

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._process.kill()
        self._process.communicate()

    def lines(self, request: bytes) -> list[Line]:
        """The lines that it draws for a program, as `flat` tells it."""
        stdin, stdout = self._process.stdin, self._process.stdout
        if stdin is None or stdout is None:
            raise RuntimeError("The script has no pipes.")
        stdin.write(request)
        stdin.flush()
        answer = stdout.readline()
        if not answer:
            raise RuntimeError("The script ended; its reason stands above.")
        return [(k, np.array(corners)) for k, corners in json.loads(answer)]


def flat(program: RandomProgram) -> bytes:
    """The program seen from above, as the scripts in ``benchmarks/node`` read it."""
    places = [
        [item, *at]
        for item, at in zip(program.items.tolist(), program.positions.tolist(), strict=True)
    ]
    starts = program.starts.tolist()
    document = {
        "items": np.column_stack([program.centers[:, :2], program.sizes[:, :2]]).tolist(),
        "hyperedges": [
            [place[:3] for place in places[begin:end]] for begin, end in pairwise(starts)
        ],
    }
    return json.dumps(document).encode() + b"\n"


def stars(program: RandomProgram) -> str:
    """The program as a graph for Graphviz: hyperedge k is a star around the node ``jk``."""
    rows = ["graph {", 'node [shape=box, label="", fixedsize=true];']
    for number, (center, size) in enumerate(
        zip(program.centers.tolist(), program.sizes.tolist(), strict=True)
    ):
        x, y = center[0] * POINTS, center[1] * POINTS
        rows.append(f'i{number} [pos="{x},{y}", width={size[0]}, height={size[1]}];')
    starts = program.starts.tolist()
    for k, (begin, end) in enumerate(pairwise(starts)):
        x, y, _ = program.positions[begin:end].mean(axis=0) * POINTS
        rows.append(f'j{k} [shape=point, width=0.01, pos="{x},{y}"];')
        rows += [f'i{item} -- j{k} [id="{k}"];' for item in program.items[begin:end].tolist()]
    return "\n".join([*rows, "}"])


def graphviz(command: Sequence[str], graph: str) -> dict[str, Any]:
    """What a program of Graphviz says of ``graph``."""
    if shutil.which(command[0]) is None:
        pytest.skip(f"{command[0]} is not installed: apt-get install graphviz")
    done = subprocess.run(
        [*command, "-Tjson"], input=graph.encode(), capture_output=True, check=True
    )
    found: dict[str, Any] = json.loads(done.stdout)
    return found


def drawn_lines(found: dict[str, Any]) -> list[Line]:
    """Graphviz's curves (B-splines of cubics) as lines of 8 pieces for each cubic."""
    t = np.linspace(0.0, 1.0, 9)[:, None]
    lines: list[Line] = []
    for edge in found["edges"]:
        for operation in edge.get("_draw_", []):
            if operation["op"] != "b":
                continue
            points = np.array(operation["points"]) / POINTS
            for a, b, c, d in zip(
                points[:-3:3], points[1::3], points[2::3], points[3::3], strict=False
            ):
                curve = (
                    (1 - t) ** 3 * a + 3 * t * (1 - t) ** 2 * b + 3 * t * t * (1 - t) * c + t**3 * d
                )
                lines.append((int(edge["id"]), curve))
    return lines


def placed(found: dict[str, Any], program: RandomProgram) -> Routing:
    """Straight tubes in space between the places that sfdp found, at the program's own density.

    Scaled so that items are as far from the nearest other one, on average, as in the program.
    """
    at = {one["name"]: np.fromstring(one["pos"], sep=",") for one in found["objects"]}
    count, hyperedges = len(program.centers), len(program.radii)
    items = np.array([at[f"i{number}"] for number in range(count)])
    joins = np.array([at[f"j{k}"] for k in range(hyperedges)])
    scale = _nearest(program.centers) / _nearest(items)
    arities = np.diff(program.starts)
    owners = np.repeat(np.arange(hyperedges), arities)
    ends = np.stack([items[program.items], joins[owners]], axis=1) * scale
    steps = np.linspace(0.0, 1.0, 4)[:, None]
    ranks = np.arange(len(owners)) - program.starts[owners]
    return Routing(
        control_points=ends[:, :1] * (1 - steps) + ends[:, 1:] * steps,
        segment_starts=program.starts,
        segment_ends=np.column_stack([ranks, arities[owners]]),
        join_positions=joins * scale,
        join_tangents=np.tile([1.0, 0.0, 0.0], (hyperedges, 1)),
        join_starts=np.arange(hyperedges + 1),
        join_planes=joins[:, 2] * scale,
        radii=program.radii,
    )


def _nearest(points: Floats) -> float:
    """Mean distance of points from their nearest neighbours."""
    apart = np.linalg.norm(points[:, None] - points[None], axis=2)
    np.fill_diagonal(apart, np.inf)
    return float(apart.min(axis=1).mean())


def crossings(lines: Sequence[Line]) -> tuple[int, int]:
    """How many pairs of hyperedges have lines in the plane that cross or touch; how many are in it.

    All pairs of straight pieces are looked at: for hundreds of hyperedges.
    """
    begins = np.concatenate([corners[:-1] for _, corners in lines])
    ends = np.concatenate([corners[1:] for _, corners in lines])
    owners = np.repeat([k for k, _ in lines], [len(corners) - 1 for _, corners in lines])
    pairs: set[tuple[int, int]] = set()
    for row in range(len(owners)):
        hit = _meeting(begins[row], ends[row], begins[row + 1 :], ends[row + 1 :])
        others = np.unique(owners[row + 1 :][hit])
        mine = int(owners[row])
        pairs.update((min(mine, k), max(mine, k)) for k in others.tolist() if k != mine)
    return len(pairs), len({k for pair in pairs for k in pair})


def _meeting(a: Floats, b: Floats, c: Floats, d: Floats) -> Indices:
    """Which of the pieces from ``c`` to ``d`` (m, 2) the piece from ``a`` to ``b`` (2,) meets."""
    apart = (np.maximum(c, d) < np.minimum(a, b) - 1e-9) | (
        np.minimum(c, d) > np.maximum(a, b) + 1e-9
    )
    near = np.flatnonzero(~apart.any(axis=1))
    c, d = c[near], d[near]
    one = _side(a, b, c) * _side(a, b, d)
    other = _side(c, d, a) * _side(c, d, b)
    return near[(one <= 1e-12) & (other <= 1e-12)]


def _side(a: Floats, b: Floats, c: Floats) -> Floats:
    return np.asarray(
        (b[..., 0] - a[..., 0]) * (c[..., 1] - a[..., 1])
        - (b[..., 1] - a[..., 1]) * (c[..., 0] - a[..., 0])
    )
