"""Random hypergraphs to place by stress."""

from __future__ import annotations

import numpy as np
from hypothesis import strategies as st

from app.arrays import Flags, Floats
from app.placement.stress.arrange import Hypergraph
from app.placement.stress.boxes import Boxes


@st.composite
def hypergraphs(draw: st.DrawFn, dimensions: int, most: int = 30) -> Hypergraph:
    """Up to so many items, with labels, in some hyperedges; nothing is placed yet."""
    count = draw(st.integers(1, most))
    seed = draw(st.integers(0, 10**6))
    hyperedges = draw(st.integers(0, 2 * count)) if count > 1 else 0
    return hypergraph(count, hyperedges, dimensions, seed)


def hypergraph(count: int, hyperedges: int, dimensions: int, seed: int) -> Hypergraph:
    """So many items and hyperedges of two to five of them."""
    chance = np.random.default_rng(seed)
    members = [
        np.sort(chance.choice(count, chance.integers(2, min(5, count) + 1), replace=False))
        for _ in range(hyperedges)
    ]
    starts = np.concatenate([[0], np.cumsum([len(each) for each in members])]).astype(np.int64)
    bodies = chance.uniform(0.2, 1.0, (count, dimensions))
    labels = chance.uniform(0.05, 1.5, (count, dimensions))
    low = np.zeros(dimensions)
    low[0] = 0.3
    boxes = Boxes(
        np.concatenate([-bodies, -labels - low]),
        np.concatenate([bodies, labels - low]),
        np.tile(np.arange(count), 2),
        np.repeat([True, False], count),
    )
    nothing: Flags = np.zeros(count, dtype=np.bool_)
    joined = np.concatenate([*members, np.zeros(0, dtype=np.int64)]).astype(np.int64)
    places: Floats = np.zeros((count, dimensions))
    return Hypergraph(bodies.mean(axis=1), boxes, starts, joined, 0.21, places, nothing, nothing)
