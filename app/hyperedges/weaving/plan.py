"""The plan of all hyperedges: where their curves run as seen from above.

Each hyperedge is a short tree between its feet, the places where its curves have risen from their
attachments and are vertical. Its joins stand away from feet and from each other, so that a tube has
room to bend between them.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from app.arrays import Floats, Indices
from app.hyperedges.steiner.trees import short_trees

BEND = 1.6
"""Radius of tight bends, over the tube's: a little more than the 1.5 that is asked for."""

NEXT = 2.0
"""Distance in radii from a join within which its edges follow its tangent."""


class Plan(NamedTuple):
    """Trees of h hyperedges over a attachments, seen from above.

    ``places`` (n, 2): the nodes of hyperedge k are ``node_starts[k]`` to ``node_starts[k + 1]``,
    its feet first, in the order of its attachments, then its joins. ``edges`` (e, 2) number the
    nodes within their hyperedge; ``edge_starts`` (h + 1,). ``links`` (n, 3) are each node's edges,
    numbered over all, -1 where feet have but one. ``starts`` (h + 1,) is where each hyperedge's
    attachments begin; ``lifts`` (a,) are the heights at which feet begin.
    """

    places: Floats
    node_starts: Indices
    edges: Indices
    edge_starts: Indices
    links: Indices
    starts: Indices
    lifts: Floats


def draw_plan(positions: Floats, directions: Floats, starts: Indices, radii: Floats) -> Plan:
    """The plan for attachments ``positions`` and unit ``directions`` (a, 3) of hyperedges.

    ``starts`` (h + 1,) say which are of one hyperedge; ``radii`` (h,) are its tubes'.
    """
    counts = np.diff(starts)
    feet, lifts = feet_of(positions, directions, np.repeat(radii, counts))
    trees = short_trees(feet, starts)
    numbers = np.arange(len(starts))
    node_starts = 2 * starts - 2 * numbers
    places = np.empty((node_starts[-1], 2))
    rows = np.arange(len(feet)) - np.repeat(starts[:-1] - node_starts[:-1], counts)
    places[rows] = feet
    is_join = np.ones(len(places), dtype=np.bool_)
    is_join[rows] = False
    places[is_join] = trees.joins
    links = _link(node_starts, trees.edges, trees.edge_starts)
    return Plan(places, node_starts, trees.edges, trees.edge_starts, links, starts, lifts)


def feet_of(positions: Floats, directions: Floats, radii: Floats) -> tuple[Floats, Floats]:
    """Where curves that leave attachments have turned upwards: (a, 2), and at which height (a,).

    Their tubes have ``radii`` (a,). Those that leave straight up are there at once.
    """
    # The farther an arc of one cubic turns, the tighter it is at its tightest.
    turns = BEND * radii * (1.0 + 0.06 * (1.0 - directions[:, 2]))
    flat = directions[:, :2]
    length = np.linalg.norm(flat, axis=1)
    # Whoever leaves straight down turns towards the viewer.
    aside = np.where(
        length[:, None] > 1e-9, flat / np.maximum(length, 1e-9)[:, None], np.array([0.0, -1.0])
    )
    feet = positions[:, :2] + aside * (turns * (1.0 - directions[:, 2]))[:, None]
    return feet, positions[:, 2] + turns * length


@njit(cache=True)
def _link(node_starts: Indices, edges: Indices, edge_starts: Indices) -> Indices:
    links = np.full((node_starts[-1], 3), -1)
    filled = np.zeros(node_starts[-1], np.int64)
    for k in range(len(node_starts) - 1):
        for e in range(edge_starts[k], edge_starts[k + 1]):
            for side in range(2):
                node = node_starts[k] + edges[e, side]
                links[node, filled[node]] = e
                filled[node] += 1
    return links
