"""Routing: how much of it is clear, how fast, how high and how smooth; and what others leave.

The rows of others say in the plane how many pairs of hyperedges cross or touch, and in space how
many tubes touch, by the certificate that ours are measured with.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from app.formats import registry
from app.hyperedges.clearance.certificate import certify
from app.hyperedges.routing import Routing
from app.layout import Layout, lay_out
from app.layout_changes import changes_between
from app.notations.loader import load_notation
from app.placement.place import place
from app.placement.placement import Placement
from app.program.model import Program
from app.program.reading import read_program
from app.settings import Settings
from benchmarks import peers
from benchmarks.clear_programs import by_paper, by_us
from benchmarks.random_in_space import RandomSpace, random_in_space
from benchmarks.random_programs import CLEARANCE, RandomProgram, Reach, random_program
from benchmarks.route_figures import figures

EXAMPLES = Path(__file__).parents[1] / "examples"
SIZES: list[tuple[int, Reach]] = [
    (10, "spread"),
    (30, "spread"),
    (100, "spread"),
    (1_000, "spread"),
    (1_000, "local"),
    (10_000, "local"),
]
FEW = SIZES[:3]
SCENES = {
    "id3-clause-1": "tubeloom",
    "id3-clause-2": "tubeloom",
    "yosys/up3down5": "yosys",
    "hif/e-coli": "hif",
    "hif/lesmis": "hif",
}

ROUTED: dict[tuple[int, Reach], Routing] = {}
"""What was routed for one row, for others of its table: the largest take minutes."""

each_size = pytest.mark.parametrize(("hyperedges", "reach"), SIZES)
each_few = pytest.mark.parametrize(("hyperedges", "reach"), FEW)


def table(hyperedges: int, reach: Reach) -> str:
    """The table that a row belongs to."""
    return f"Routing {hyperedges:,} hyperedges, {reach}"


def rounds(hyperedges: int) -> int:
    """How often a row is measured."""
    return 20 if hyperedges <= 30 else 5 if hyperedges <= 100 else 1


@each_size
def test_ours(benchmark: Any, hyperedges: int, reach: Reach) -> None:
    """Curves kept apart, certified."""
    benchmark.group = table(hyperedges, reach)
    placement = random_program(hyperedges, 0, reach).placement()
    by_us(random_program(5, 0).placement())
    routing = benchmark.pedantic(by_us, (placement,), rounds=rounds(hyperedges))
    ROUTED[hyperedges, reach] = routing
    benchmark.extra_info.update(figures(routing, placement, CLEARANCE).notes)


@each_size
def test_certificate_of_ours(benchmark: Any, hyperedges: int, reach: Reach) -> None:
    """The proof alone."""
    benchmark.group = table(hyperedges, reach)
    placement = random_program(hyperedges, 0, reach).placement()
    routing = ROUTED.get((hyperedges, reach)) or by_us(placement)
    proof = benchmark.pedantic(
        certify, (routing, placement, CLEARANCE), rounds=rounds(hyperedges), warmup_rounds=1
    )
    benchmark.extra_info["smallest distance"] = f"{proof.minimum:.4f}"


@pytest.mark.parametrize("number", [17, 459, 711])
@pytest.mark.parametrize("make", [random_program, random_in_space], ids=["ground", "space"])
def test_one_hyperedge_more(
    benchmark: Any, make: Callable[[int, int, Reach], RandomProgram | RandomSpace], number: int
) -> None:
    """From an edit to the new layout, by relaxation: what is new is routed beside all others."""
    benchmark.group = "One hyperedge more among 1,000, local"
    before, program = _before_the_last(make, number)
    after = benchmark.pedantic(lay_out, (program, before), rounds=5, warmup_rounds=1)
    changed = changes_between(before, after).hyperedges.changed
    proof = certify(after.routing, after.placement, CLEARANCE)
    benchmark.extra_info["others that moved"] = str(len(changed))
    benchmark.extra_info["clear"] = "yes" if proof.certified else "no"


@pytest.mark.parametrize("make", [random_program, random_in_space], ids=["ground", "space"])
def test_an_item_moved(
    benchmark: Any, make: Callable[[int, int, Reach], RandomProgram | RandomSpace]
) -> None:
    """An item moves a little, and its hyperedges with it."""
    benchmark.group = "An item moved among 1,000 hyperedges, local"
    before, _ = _before_the_last(make, 459)
    item = before.program.items[300]
    x, y, z = item.position or (0.0, 0.0, 0.0)
    moved = item.model_copy(update={"position": (x, y, z + 0.05)})
    items = (*before.program.items[:300], moved, *before.program.items[301:])
    program = before.program.model_copy(update={"items": items})
    after = benchmark.pedantic(lay_out, (program, before), rounds=5, warmup_rounds=1)
    changes = changes_between(before, after)
    benchmark.extra_info["hyperedges that moved"] = str(len(changes.hyperedges.changed))


@cache
def _whole(make: Callable[[int, int, Reach], RandomProgram | RandomSpace]) -> Layout:
    document = json.dumps(make(1_000, 0, "local").document(routing="elastic")).encode()
    return lay_out(read_program(document, Settings()))


def _before_the_last(
    make: Callable[[int, int, Reach], RandomProgram | RandomSpace], number: int
) -> tuple[Layout, Program]:
    """A layout without one hyperedge, and the program with it."""
    whole = _whole(make)
    rest = tuple(one for k, one in enumerate(whole.program.hyperedges) if k != number)
    fewer = whole.program.model_copy(update={"hyperedges": rest})
    new = whole.program.hyperedges[number]
    program = whole.program.model_copy(update={"hyperedges": (*rest, new)})
    return lay_out(fewer, whole), program


@each_size
def test_papers_heights(benchmark: Any, hyperedges: int, reach: Reach) -> None:
    """The paper's curves at heights 1, 2, 3 and so on."""
    benchmark.group = table(hyperedges, reach)
    placement = random_program(hyperedges, 0, reach).placement()
    routing = benchmark.pedantic(by_paper, (placement,), rounds=rounds(hyperedges), warmup_rounds=1)
    benchmark.extra_info.update(figures(routing, placement, CLEARANCE).notes)


@each_few
def test_elk_layered_orthogonal(benchmark: Any, hyperedges: int, reach: Reach) -> None:
    """In the plane; it places the items too."""
    _in_the_plane(benchmark, "elk.mjs", hyperedges, reach)


@pytest.mark.parametrize(("hyperedges", "reach"), FEW[:2])
def test_libavoid_orthogonal(benchmark: Any, hyperedges: int, reach: Reach) -> None:
    """In the plane, around the items where they are; 100 hyperedges take it minutes."""
    _in_the_plane(benchmark, "avoid.mjs", hyperedges, reach)


@each_few
def test_graphviz_neato(benchmark: Any, hyperedges: int, reach: Reach) -> None:
    """Curves in the plane, around the items where they are."""
    benchmark.group = table(hyperedges, reach)
    graph = peers.stars(random_program(hyperedges, 0, reach))
    found = benchmark.pedantic(
        peers.graphviz, (["neato", "-n", "-Gsplines=true"], graph), rounds=rounds(hyperedges)
    )
    _note_crossings(benchmark, peers.drawn_lines(found), hyperedges)


@each_few
def test_graphviz_sfdp_in_space(benchmark: Any, hyperedges: int, reach: Reach) -> None:
    """Straight tubes in space between places of its own choice."""
    benchmark.group = table(hyperedges, reach)
    program = random_program(hyperedges, 0, reach)
    command = ["sfdp", "-Gdim=3", "-Gdimen=3", "-Gstart=1", "-Gsplines=none"]
    found = benchmark.pedantic(
        peers.graphviz, (command, peers.stars(program)), rounds=rounds(hyperedges)
    )
    routing = peers.placed(found, program)
    seen = certify(routing, _without_items(program.placement()), 0.0).conflicts
    # Tubes that end at one item touch there, as they must: it has one place.
    items = [set(program.items[a:b].tolist()) for a, b in pairwise(program.starts)]
    touching = [
        (one, other)
        for one, other in zip(seen.first.tolist(), seen.second.tolist(), strict=True)
        if not items[one] & items[other]
    ]
    hit = {k for pair in touching for k in pair}
    benchmark.extra_info["touching"] = f"{len(touching)} pairs besides those at one item"
    benchmark.extra_info["cut"] = f"{len(hit) / hyperedges:.0%}"


@pytest.mark.parametrize("name", SCENES)
def test_scene(benchmark: Any, name: str) -> None:
    """An example, from its placement."""
    benchmark.group = "Routing the examples"
    benchmark.extra_info["of"] = name
    program = registry.read(SCENES[name], (EXAMPLES / f"{name}.json").read_bytes(), Settings())
    placement = place(program, load_notation(program.notation))
    by_us(random_program(5, 0).placement())
    routing = benchmark.pedantic(by_us, (placement,), rounds=3)
    benchmark.extra_info["hyperedges"] = len(program.hyperedges)
    benchmark.extra_info.update(figures(routing, placement, CLEARANCE).notes)


def _in_the_plane(benchmark: Any, script: str, hyperedges: int, reach: Reach) -> None:
    benchmark.group = table(hyperedges, reach)
    request = peers.flat(random_program(hyperedges, 0, reach))
    with peers.NodePeer(script) as peer:
        peer.lines(peers.flat(random_program(5, 0)))
        lines = benchmark.pedantic(peer.lines, (request,), rounds=min(rounds(hyperedges), 5))
    _note_crossings(benchmark, lines, hyperedges)


def _note_crossings(benchmark: Any, lines: list[peers.Line], hyperedges: int) -> None:
    pairs, hit = peers.crossings(lines)
    benchmark.extra_info["crossing or touching"] = f"{pairs} pairs"
    benchmark.extra_info["cut"] = f"{hit / hyperedges:.0%}"


def _without_items(placement: Placement) -> Placement:
    """The same attachments, but nothing in the way: sfdp puts the items elsewhere."""
    return replace(
        placement,
        centers=placement.centers[:0],
        rotations=placement.rotations[:0],
        sizes=placement.sizes[:0],
        solids=(),
        labels=(),
        attachment_items=np.zeros_like(placement.attachment_items),
    )
