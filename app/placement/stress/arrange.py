"""Items of a hypergraph by stress: each component for itself, side by side, nothing overlapping."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from app.arrays import Flags, Floats, Indices
from app.placement.stress.axes import turned_to_axes
from app.placement.stress.boxes import Boxes, move_apart
from app.placement.stress.crossings import crossings_of
from app.placement.stress.descent import descend
from app.placement.stress.pairs import Pairs, Progress, pairs_of
from app.placement.stress.shelves import shelved
from app.placement.stress.star import Star, components_of, part_of, star_of

BESIDE = 1.2
"""Between components that stand side by side, document units."""

LEAST = 0.3
"""Of an item's radius, as ideal lengths count it."""

CROWDED = 1.2
"""Places for tubes over a ball of radius 1 that ideal lengths reckon with, times their room."""

ROOM = 0.56
"""Of that room, over a tube's diameter and clearance."""


AROUND_HUBS = 3.0
"""Room for the tubes around an item, over what its radius is more than the least for them."""


USUAL = 1.15
"""Of the spacing: so many times farther apart than stress and gaps alone would have it, tubes find
ways between nearly always."""

STARTS, TRIED = 12, 600_000
"""Starts of descent on the plane, at most, and pairs of nodes in all of them."""


def silent() -> None:
    """Progress that nobody listens to."""


@dataclass(frozen=True, slots=True, eq=False)
class Hypergraph:
    """n items with ``boxes``, in d dimensions, and what joins them.

    ``radii`` (n,) are their own, as ideal lengths count them. The items of hyperedge k are
    ``members[starts[k] : starts[k + 1]]``, each of them once. ``thickness`` is a tube's diameter
    with its clearance. ``places`` (n, d) are those of items that are ``placed`` (n,) already; of
    these the ``held`` ones (n,) stay there, others leave where they are too near to something.
    ``spacing``: how many times as far apart as usual items are.
    """

    radii: Floats
    boxes: Boxes
    starts: Indices
    members: Indices
    thickness: float
    places: Floats
    placed: Flags
    held: Flags
    spacing: float = 1.0

    @property
    def dimensions(self) -> int:
        """Two or three."""
        return int(self.places.shape[1])


def crowded_radii(degrees: Indices, thickness: float) -> Floats:
    """Radii (n,) of balls with room for the ends of so many tubes, ``degrees`` (n,)."""
    return np.asarray(np.maximum(LEAST, ROOM * thickness * np.sqrt(degrees / CROWDED)))


def arranged(graph: Hypergraph, progress: Progress = silent) -> Floats:
    """Places (n, d) of all items; what is held stays to the last bit, the rest is around it.

    Without anything placed, the middle of all is at the origin. The first axis is the widest; of
    three the second, the depth, is the least.
    """
    count = len(graph.radii)
    x = graph.places.copy()
    if count == 0:
        return x
    degrees = np.bincount(graph.members, minlength=count)
    graph = replace(graph, spacing=USUAL * graph.spacing)
    crowded = graph.spacing * crowded_radii(degrees, graph.thickness)
    radii = np.maximum(graph.radii, crowded)
    graph = replace(
        graph,
        boxes=_with_room(graph.boxes, AROUND_HUBS * (crowded - LEAST) + (graph.spacing - 1.0)),
    )
    star = star_of(radii, graph.starts, graph.members, graph.spacing)
    apart: list[tuple[Indices, Floats]] = []
    near: list[Indices] = []
    for nodes in components_of(star):
        items = nodes[nodes < count]
        if graph.placed[items].any():
            near.append(_around_placed(x, star, nodes, graph.placed, progress))
        elif len(items):
            apart.append((items, _alone(graph, star, nodes, items, progress)))
    if near:
        items = np.sort(np.concatenate(near))
        part = x[items]
        move_apart(part, graph.boxes.of_items(items), ~graph.held[items], progress)
        x[items] = np.where(graph.held[items, None], x[items], part)
    _pack(x, graph, apart, np.sort(np.concatenate(near)) if near else None)
    return x


def _with_room(boxes: Boxes, rooms: Floats) -> Boxes:
    """The same boxes with more room, ``rooms`` (n,) by item, around bodies."""
    rooms = np.where(boxes.are_bodies, rooms[boxes.owners], 0.0)[:, None]
    return boxes._replace(lows=boxes.lows - rooms, highs=boxes.highs + rooms)


def _alone(
    graph: Hypergraph, star: Star, nodes: Indices, items: Indices, progress: Progress
) -> Floats:
    """Places (k, d) of a component's items about their middle."""
    dimensions = graph.dimensions
    if len(nodes) == 1:
        return np.zeros((1, dimensions))
    part = part_of(star, nodes)
    pairs = pairs_of(part, progress)
    x = _descended(part, pairs, dimensions, progress)
    order = (0, 1) if dimensions == 2 else (0, 2, 1)
    found = np.ascontiguousarray(turned_to_axes(x, order)[: len(items)])
    move_apart(found, graph.boxes.of_items(items), np.ones(len(items), dtype=np.bool_), progress)
    return found


def _descended(star: Star, pairs: Pairs, dimensions: int, progress: Progress) -> Floats:
    """Places (k, d) of the nodes of a component, where their stress is little.

    On the plane, of as many starts as there is time for, that with the fewest crossings.
    """
    count = len(star.starts) - 1
    starts = min(max(TRIED // len(pairs.first), 1), STARTS) if dimensions == 2 else 1
    owners = np.repeat(np.arange(count), np.diff(star.starts))
    once = owners < star.neighbours
    best, fewest = np.zeros((count, dimensions)), -1
    for start in range(starts):
        x = _begun(count, dimensions, start * count) * float(pairs.distances.mean())
        descend(x, pairs, np.ones(count, dtype=np.bool_), progress)
        crossings = 0
        if starts > 1:
            crossings = int(crossings_of(x, owners[once], star.neighbours[once]))
        if fewest < 0 or crossings < fewest:
            best, fewest = x, crossings
    return best


def _begun(count: int, dimensions: int, after: int = 0) -> Floats:
    """Points (n, d) spread over a cube, no two alike: where descent begins.

    Those ``after`` so many others.
    """
    steps = np.arange(after + 1, after + count + 1)[:, None] * _STEPS[dimensions]
    return np.asarray(2.0 * (steps - np.floor(steps)) - 1.0)


_STEPS = {
    2: np.array([0.7548776662466927, 0.5698402909980532]),
    3: np.array([0.8191725133961645, 0.6710436067037893, 0.5497004779019703]),
}
"""Roberts' sequences: generalized golden ratios."""


def _around_placed(
    x: Floats, star: Star, nodes: Indices, held: Flags, progress: Progress
) -> Indices:
    """Place those items of a component that have no place, in place, and give all its items."""
    items = nodes[nodes < len(x)]
    free = np.ones(len(nodes), dtype=np.bool_)
    free[: len(items)] = ~held[items]
    if not free[: len(items)].any():
        return items
    part = part_of(star, nodes)
    places = np.full((len(nodes), x.shape[1]), np.nan)
    places[: len(items)][~free[: len(items)]] = x[items[held[items]]]
    _fill(places, part)
    pairs = pairs_of(part, progress)
    matter = free[pairs.first] | free[pairs.second]
    kept = type(pairs)(
        pairs.first[matter], pairs.second[matter], pairs.distances[matter], pairs.weights[matter]
    )
    descend(places, kept, free, progress)
    x[items[~held[items]]] = places[: len(items)][free[: len(items)]]
    return items


def _fill(places: Floats, star: Star) -> None:
    """Give nodes without a place (NaN) one beside neighbours that have, from these outwards."""
    jitter = _begun(len(places), places.shape[1])
    unknown = np.isnan(places[:, 0])
    owners = np.repeat(np.arange(len(places)), np.diff(star.starts))
    while unknown.any():
        rows = np.flatnonzero(unknown[owners] & ~unknown[star.neighbours])
        sums = np.zeros_like(places)
        np.add.at(sums, owners[rows], places[star.neighbours[rows]])
        counts = np.bincount(owners[rows], minlength=len(places))
        new = counts > 0
        places[new] = sums[new] / counts[new, None] + jitter[new]
        unknown[new] = False


def _pack(
    x: Floats, graph: Hypergraph, apart: list[tuple[Indices, Floats]], near: Indices | None
) -> None:
    """Put components on shelves: about the origin, or below what is ``near`` others, in place."""
    if not apart:
        return
    across = [0, graph.dimensions - 1]
    edges = [_edges(found, graph.boxes.of_items(items)) for items, found in apart]
    lows, highs = (np.array([pair[side] for pair in edges]) for side in (0, 1))
    middles = shelved((highs - lows)[:, across], BESIDE)
    sizes = (highs - lows)[:, across]
    left, top = (middles[:, 0] - sizes[:, 0] / 2).min(), (middles[:, 1] + sizes[:, 1] / 2).max()
    right = (middles[:, 0] + sizes[:, 0] / 2).max()
    bottom = (middles[:, 1] - sizes[:, 1] / 2).min()
    corner = np.array([(left + right) / 2, (top + bottom) / 2])
    depth = 0.0
    if near is not None:
        low, high = _edges(x[near], graph.boxes.of_items(near))
        corner = np.array([(left + right - low[0] - high[0]) / 2, top - low[across[1]] + BESIDE])
        depth = float(low[1] + high[1]) / 2
    for (items, found), low, high, middle in zip(apart, lows, highs, middles, strict=True):
        shift = -(low + high) / 2
        if graph.dimensions == 3:
            shift[1] += depth
        shift[across] += middle - corner
        x[items] = found + shift


def _edges(x: Floats, boxes: Boxes) -> tuple[Floats, Floats]:
    """The least and the largest corner (d,) of all boxes."""
    at = x[boxes.owners]
    return (at + boxes.lows).min(axis=0), (at + boxes.highs).max(axis=0)
