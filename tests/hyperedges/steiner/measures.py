"""What a tree is measured by, in plain NumPy."""

from __future__ import annotations

import numpy as np

from app.arrays import Floats, Indices
from app.hyperedges.steiner.trees import Trees, short_trees


def lengths(points: Floats, starts: Indices, trees: Trees) -> Floats:
    """Of each hyperedge's tree."""
    found = []
    for k in range(len(starts) - 1):
        nodes = np.concatenate(
            [
                points[starts[k] : starts[k + 1]],
                trees.joins[trees.join_starts[k] : trees.join_starts[k + 1]],
            ]
        )
        edges = nodes[trees.edges[trees.edge_starts[k] : trees.edge_starts[k + 1]]]
        found.append(np.linalg.norm(edges[:, 1] - edges[:, 0], axis=1).sum())
    return np.array(found)


def short_tree(points: Floats) -> Trees:
    return short_trees(points, np.array([0, len(points)]))


def short_length(points: Floats) -> float:
    return float(lengths(points, np.array([0, len(points)]), short_tree(points))[0])


def spanning_length(points: Floats) -> float:
    """Of the minimum spanning tree, Prim's way."""
    near = np.linalg.norm(points - points[0], axis=1)
    near[0] = np.inf
    total = 0.0
    for _ in range(len(points) - 1):
        i = int(near.argmin())
        total += near[i]
        near[i] = np.inf
        waiting = near < np.inf
        away = np.linalg.norm(points[waiting] - points[i], axis=1)
        near[waiting] = np.minimum(near[waiting], away)
    return total


def is_tree(edges: Indices, nodes: int) -> bool:
    """Whether the edges join all nodes and are one fewer."""
    if len(edges) != nodes - 1:
        return False
    component = list(range(nodes))
    for a, b in edges.tolist():
        one, other = component[a], component[b]
        component = [one if c == other else c for c in component]
    return len(set(component)) == 1
