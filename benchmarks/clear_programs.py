"""Routes and certifies hundreds of random programs, and prints what became of them.

``python -m benchmarks.clear_programs --count 200`` is the whole of it; the exit status is 1 where
our routing leaves a program that is not certified clear, or a curve that pinches its tube.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Sequence
from dataclasses import dataclass
from statistics import mean, median, quantiles

import numpy as np
from tqdm import tqdm

from app.hyperedges.clearance.certificate import certify
from app.hyperedges.route import route
from app.hyperedges.routing import Routing
from app.placement.placement import Placement
from benchmarks.__main__ import duration
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


def by_us(placement: Placement) -> Routing:
    """Curves kept apart."""
    return route(placement, curves="steiner", clearance=CLEARANCE)


WAYS = {"paper's heights": by_paper, "ours": by_us}


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
    parser.add_argument("--count", type=int, default=200, help="programs of each size")
    parser.add_argument("--sizes", type=int, nargs="+", default=[10, 30, 100])
    parser.add_argument("--reach", choices=["spread", "local"], default="spread")
    parser.add_argument("--ways", choices=list(WAYS), nargs="+", default=list(WAYS))
    asked = parser.parse_args(arguments)
    reach: Reach = asked.reach
    for name in asked.ways:  # kernels compile, or come from their cache, before anything is timed
        run(name, random_program(5, 0, reach).placement(), 0)
    rows: list[tuple[str, list[Outcome]]] = []
    for size in asked.sizes:
        found: dict[str, list[Outcome]] = {name: [] for name in asked.ways}
        for seed in tqdm(range(asked.count), desc=f"{size} hyperedges", leave=False, disable=None):
            placement = random_program(size, seed, reach).placement()
            for name in asked.ways:
                found[name].append(run(name, placement, seed))
        rows += [(f"{size} hyperedges, {name}", found[name]) for name in asked.ways]
    print(table(rows))
    bad = [
        f"{title}: seeds {[one.seed for one in outcomes if _is_bad(one.figures)]}"
        for title, outcomes in rows
        if title.endswith("ours") and any(_is_bad(one.figures) for one in outcomes)
    ]
    if bad:
        print("\nNot clear, or pinched:\n" + "\n".join(bad))
    return int(bool(bad))


def _is_bad(found: RouteFigures) -> bool:
    return not found.certified or found.pinched > 0


if __name__ == "__main__":
    raise SystemExit(main())
