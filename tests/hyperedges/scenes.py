"""Points to join: random ones, and ones that are trouble."""

from __future__ import annotations

from typing import Literal

import numpy as np

from app.arrays import Floats
from app.hyperedges.curves import lay_out
from app.hyperedges.segments import Curves
from app.placement.placement import Placement

Reading = Literal["prose", "symbolic"]
Fidelity = Literal["best", "paper"]
Measure = Literal["space", "plane"]
READINGS: tuple[Reading, ...] = ("prose", "symbolic")
FIDELITIES: tuple[Fidelity, ...] = ("best", "paper")
MEASURES: tuple[Measure, ...] = ("space", "plane")
PLANE = 3.0


def upwards(count: int) -> Floats:
    return np.tile([0.0, 0.0, 1.0], (count, 1))


def lay_out_one(
    points: Floats,
    plane: float = PLANE,
    *,
    reading: Reading = "prose",
    fidelity: Fidelity = "paper",
    closest: Measure = "space",
    search: Literal["tree", "direct"] = "tree",
    directions: Floats | None = None,
) -> Curves:
    points = np.asarray(points, dtype=np.float64)
    return lay_out(
        points,
        upwards(len(points)) if directions is None else directions,
        np.array([0, len(points)]),
        np.array([plane]),
        reading=reading,
        fidelity=fidelity,
        closest=closest,
        search=search,
    )


def troubles(count: int) -> dict[str, Floats]:
    """Sets of points that have ties, coincidences, or scales far apart."""
    chance = np.random.default_rng(count)
    numbers = np.arange(count)
    nothing = np.zeros(count)
    return {
        "random": chance.uniform(-5, 5, (count, 3)),
        "all at one place": np.tile([1.0, 2.0, 3.0], (count, 1)),
        "all at the origin": np.zeros((count, 3)),
        "few places": chance.integers(0, 3, (count, 3)).astype(np.float64),
        "two places": np.column_stack([numbers % 2 * 4.0, nothing, nothing]),
        "lattice": np.round(chance.uniform(-6, 6, (count, 3))),
        "line": np.column_stack([numbers, nothing, nothing]).astype(np.float64),
        "vertical line": np.column_stack([nothing, nothing, numbers]).astype(np.float64),
        "in the join plane": np.column_stack([chance.uniform(0, 9, (count, 2)), nothing + PLANE]),
        "ring": np.column_stack([np.cos(numbers), np.sin(numbers), nothing]),
        "two far clusters": chance.normal(0, 1e-3, (count, 3)) + 1e3 * (numbers % 2)[:, None],
        "huge": chance.uniform(-1e6, 1e6, (count, 3)),
        "tiny": chance.uniform(-1e-9, 1e-9, (count, 3)),
        "vanishing": chance.uniform(-1e-160, 1e-160, (count, 3)),
        "all scales": np.exp(chance.uniform(-30, 13, (count, 3))),
        "signed zeros": np.where(chance.random((count, 3)) < 0.5, -0.0, 0.0),
    }


def placement(
    points: Floats,
    starts: list[int],
    *,
    radius: float = 0.08,
    items: Floats | None = None,
    sizes: Floats | None = None,
) -> Placement:
    """Attachments that point up, and items as blocks (n, 3) of ``sizes`` (n, 3), unturned."""
    centers = np.zeros((0, 3)) if items is None else items
    return Placement(
        centers=centers,
        rotations=np.tile([0.0, 0.0, 0.0, 1.0], (len(centers), 1)),
        sizes=np.ones((len(centers), 3)) if sizes is None else sizes,
        solids=(),
        labels=(),
        attachment_positions=np.asarray(points, dtype=np.float64),
        attachment_directions=upwards(len(points)),
        attachment_starts=np.array(starts),
        attachment_items=np.zeros(len(points), dtype=np.int64),
        radii=np.full(len(starts) - 1, radius),
    )
