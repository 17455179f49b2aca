"""Routes and certifies hundreds of random programs, and prints what became of them.

``python -m benchmarks.clear_programs --count 200`` is the whole of it for items on the ground, and
``python -m benchmarks.clear_programs --programs space --count 50`` for items that float. The exit
status is 1 where our routing leaves a program that is not certified clear, a curve that pinches its
tube, or, where it is elastic, a hyperedge that touches itself; these are named as they are found.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from statistics import mean, median, quantiles
from typing import Literal

import numpy as np
from tqdm import tqdm

from app.hyperedges.clearance.certificate import certify
from app.hyperedges.route import route
from app.hyperedges.routing import Routing
from app.placement.placement import Placement
from benchmarks.__main__ import duration
from benchmarks.random_in_space import random_in_space
from benchmarks.random_programs import CLEARANCE, Reach, random_program
from benchmarks.route_figures import RouteFigures, figures


@dataclass(frozen=True, slots=True)
class Outcome:
    """One program by one way of routing; times in seconds."""

    seed: int
    figures: RouteFigures
    routing: float
    certifying: float


COLUMNS = (
    "",
    "certified clear",
    "cut another",
    "too near",
    "touch themselves",
    "routing",
    "95th percentile",
    "certifying",
    "highest join plane",
    "at most",
    "segments",
    "pinched",
    "curves over trees",
)


def by_paper(placement: Placement) -> Routing:
    """The paper's curves at its heights, which are 1, 2, 3 and so on."""
    heights = np.arange(1.0, len(placement.radii) + 1)
    return route(placement, curves="prose", fidelity="paper", join_heights=heights)


def by_us(
    placement: Placement, routing: Literal["planes", "elastic", "auto"] = "planes"
) -> Routing:
    """Curves kept apart."""
    return route(placement, curves="steiner", clearance=CLEARANCE, routing=routing)


WAYS: dict[str, Callable[[Placement], Routing]] = {
    "paper's heights": by_paper,
    "planes": by_us,
    "elastic": partial(by_us, routing="elastic"),
    "auto": partial(by_us, routing="auto"),
}

PROGRAMS: dict[str, tuple[Callable[[int, int, Reach], Placement], list[str]]] = {
    "ground": (
        lambda size, seed, reach: random_program(size, seed, reach).placement(),
        ["paper's heights", "planes", "elastic"],
    ),
    "space": (
        lambda size, seed, reach: random_in_space(size, seed, reach).placement(),
        ["elastic"],
    ),
}
"""Which programs there are, and the ways in which they are routed if none is asked for."""


def run(name: str, placement: Placement, seed: int) -> Outcome:
    """Route and certify one program."""
    begun = time.perf_counter()
    routing = WAYS[name](placement)
    routed = time.perf_counter()
    proof = certify(routing, placement, CLEARANCE)
    certified = time.perf_counter()
    found = figures(routing, placement, CLEARANCE, proof)
    return Outcome(seed, found, routed - begun, certified - routed)


def table(rows: Sequence[tuple[str, Sequence[Outcome]]]) -> str:
    """A Markdown table with one row for each title and its outcomes."""
    lines = [f"| {' | '.join(COLUMNS)} |", "|---" + "|--:" * (len(COLUMNS) - 1) + "|"]
    for title, outcomes in rows:
        found = [outcome.figures for outcome in outcomes]
        hyperedges = sum(one.hyperedges for one in found)
        times = sorted(outcome.routing for outcome in outcomes)
        cells = (
            title,
            f"{sum(one.certified for one in found)} of {len(found)}",
            f"{sum(one.cut for one in found) / hyperedges:.1%}",
            f"{sum(one.near for one in found) / hyperedges:.1%}",
            str(sum(one.own for one in found)),
            duration(median(times)),
            duration(quantiles(times, n=20)[-1] if len(times) >= 20 else times[-1]),
            duration(median(outcome.certifying for outcome in outcomes)),
            f"{mean(one.highest for one in found):.1f}",
            f"{max(one.highest for one in found):.1f}",
            f"{mean(one.segments for one in found):.0f}",
            str(sum(one.pinched for one in found)),
            f"{sum(one.length for one in found) / sum(one.tree for one in found):.2f}",
        )
        lines.append(f"| {' | '.join(cells)} |")
    return "\n".join(lines)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run what the command line asks for."""
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.clear_programs", description=__doc__
    )
    parser.add_argument("--programs", choices=list(PROGRAMS), default="ground")
    parser.add_argument("--count", type=int, default=200, help="programs of each size")
    parser.add_argument("--first", type=int, default=0, help="the first one's number")
    parser.add_argument("--sizes", type=int, nargs="+", default=[10, 30, 100])
    parser.add_argument("--reach", choices=["spread", "local"], default="spread")
    parser.add_argument("--ways", choices=list(WAYS), nargs="+")
    asked = parser.parse_args(arguments)
    reach: Reach = asked.reach
    placed, usual = PROGRAMS[asked.programs]
    ways = asked.ways or usual
    for name in ways:  # kernels compile, or come from their cache, before anything is timed
        run(name, placed(5, 0, reach), 0)
    rows: list[tuple[str, list[Outcome]]] = []
    failed = False
    for size in asked.sizes:
        found: dict[str, list[Outcome]] = {name: [] for name in ways}
        seeds = range(asked.first, asked.first + asked.count)
        for seed in tqdm(seeds, desc=f"{size} hyperedges", leave=False, disable=None):
            placement = placed(size, seed, reach)
            for name in ways:
                outcome = run(name, placement, seed)
                found[name].append(outcome)
                faults = _faults(name, outcome.figures)
                if faults:
                    failed = True
                    tqdm.write(f"{size} hyperedges, {name}, seed {seed}: {faults}")
        rows += [(f"{size} hyperedges, {name}", found[name]) for name in ways]
    print(table(rows))
    return int(failed)


def _faults(way: str, found: RouteFigures) -> str:
    """What must not be, in words; nothing is asked of the paper's curves."""
    if way == "paper's heights":
        return ""
    faults = [] if found.certified else [f"{found.near} hyperedges too near"]
    if found.pinched:
        faults.append(f"{found.pinched} segments pinched")
    if found.own and way != "planes":
        faults.append(f"{found.own} hyperedges touch themselves")
    return ", ".join(faults)


if __name__ == "__main__":
    raise SystemExit(main())
