"""The shortest tree of a few points, with a proof: what our short trees are measured by.

Trees whose leaves are the points and whose joins have three arms are built one point at a time
(Smith 1992). Another point never makes a tree shorter, so nothing has to be added to a tree whose
lower bound is no less than the length of the best tree known.

The lower bound is the dual of Fermat's problem on a tree: for forces of strength one or less along
the edges that cancel at every join, every placing of the joins has a length of the sum of p · f of
the leaves or more. Pulling along the edges of a nearly shortest placing gives forces that nearly
cancel; what is left over is spread over the leaves with weak forces, and all are scaled down where
one has become too strong. So the proof does not depend on how the placing was found.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from app.arrays import Floats, Indices
from app.hyperedges.steiner.growth import put_on_edge
from app.hyperedges.steiner.relaxation import FINE, relax, tree_length, walk

SMOOTHING = 1e-8
"""ε of the relaxation: less would cost forces along short edges more digits than it gains."""

GAP = 1e-7
"""Trees that are shorter than the best by less than this share are not looked for."""


@dataclass(frozen=True, slots=True)
class Shortest:
    """The best tree's ``length``; ``bound``, than which no tree is shorter; ``trees`` weighed."""

    length: float
    bound: float
    trees: int


def shortest_tree(points: Floats) -> Shortest:
    """How long the shortest tree of ``points`` (n, 2) or (n, 3) is, n from 2 to about 10.

    >>> square = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    >>> round(shortest_tree(square).length, 6)
    2.732051
    """
    n, dimensions = points.shape
    placed = np.zeros((n, 3))
    placed[:, :dimensions] = points
    scale = float(np.ptp(placed, axis=0).max())
    if n < 3 or scale == 0.0:
        length = float(np.linalg.norm(placed[0] - placed[-1]))
        return Shortest(length, length, 0)
    length, bound, trees = _search(
        _spread((placed - placed.mean(axis=0)) / scale),
        np.array([[1, -1, -1], [0, -1, -1]]),
        np.inf,
    )
    return Shortest(length * scale, bound * scale, trees)


def _spread(points: Floats) -> Floats:
    """The points in an order in which each is far from all before, for bounds that grow early."""
    away = np.linalg.norm(points, axis=1)
    order: list[int] = []
    for _ in range(len(points)):
        order.append(int(away.argmax()))
        away = np.minimum(away, np.linalg.norm(points - points[order[-1]], axis=1))
        away[order] = -1.0
    return points[order]


def _search(points: Floats, arms: Indices, best: float) -> tuple[float, float, int]:
    """Weigh all trees that arise from one of the first points, or leave them out.

    Returns the length of the best tree, ``best`` if none is better; a lower bound for all of them;
    and how many were weighed.
    """
    trees = [_with_point(arms, a, b) for a in range(len(arms)) for b in arms[a] if b > a]
    weighed = [_weigh(points, tree) for tree in trees]
    count = len(trees)
    if 2 * len(points) - 2 == len(trees[0]):
        lengths, bounds = zip(*weighed, strict=True)
        return min(best, *lengths), min(bounds), count
    bound = np.inf
    for k in sorted(range(len(trees)), key=lambda k: weighed[k][1]):
        low = weighed[k][1]
        if low < best * (1.0 - GAP):
            best, low, more = _search(points, trees[k], best)
            count += more
        bound = min(bound, low)
    return best, bound, count


def _with_point(arms: Indices, a: int, b: int) -> Indices:
    """The tree with another point, whose join is on the edge from a to b."""
    count = len(arms) // 2 + 1
    # The point takes the first join's number, and so on.
    numbers = np.arange(-1, len(arms))
    numbers[count + 1 :] += 1
    grown = np.full((2 * count, 3), -1)
    grown[numbers[1:]] = numbers[arms + 1]
    put_on_edge(grown, 2 * count - 1, int(numbers[a + 1]), int(numbers[b + 1]), count)
    return grown


def _weigh(points: Floats, arms: Indices) -> tuple[float, float]:
    """Length and lower bound of a tree of the first points."""
    nodes = len(arms)
    count = nodes // 2 + 1
    at = np.zeros((nodes, 3))
    at[:count] = points[:count]
    order, parents = np.empty(count, np.int64), np.empty(nodes, np.int64)
    walk(arms, count, order, parents)
    joins = order[: count - 2]
    for i in joins[::-1]:
        # In the middle of what hangs from it, so that no join begins on another.
        at[i] = at[[j for j in arms[i] if j != parents[i]]].mean(axis=0)
    relax(at, arms, count, order, parents, 0.1, SMOOTHING, FINE)
    edges = at - at[parents]
    edges[0] = at[0] - at[arms[0, 0]]
    forces = edges / np.sqrt((edges**2).sum(axis=1, keepdims=True) + SMOOTHING**2)
    rest = forces[:count].sum(axis=0)
    room = 1.0 + 1e-9 - np.linalg.norm(forces[:count], axis=1)
    forces[:count] -= room[:, None] / room.sum() * rest
    for i in joins[::-1]:
        forces[i] = sum(forces[j] for j in arms[i] if j != parents[i])
    strongest = max(1.0, float(np.linalg.norm(forces, axis=1).max()))
    bound = float((at[:count] * forces[:count]).sum()) / strongest
    return float(tree_length(at, arms, count, 0.0)), bound
