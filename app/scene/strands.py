"""How far along its tubes each vertex of a hyperedge is, and how far around them.

Strands run along a tube from one end to the other: side k of one ring goes on as side k of the
next, and at a join as whichever sides of the other tubes begin at the same places.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from app.arrays import Floats, Indices
from app.solids.mesh import Mesh

_NEXT_TO_NOTHING = 1e-9  # document units: a path of no length would be no path


@dataclass(frozen=True, slots=True, eq=False)
class Strands:
    """How far v vertices are ``along`` the tubes (v,), and ``around`` them (v,).

    Along in document units from the first ring; around from 0 at one strand to 1 opposite.
    """

    along: Floats
    around: Floats


def strands_of(mesh: Mesh) -> Strands | None:
    """Strands of the tubes of one hyperedge, or ``None`` if the mesh is not made of rings.

    Tubes that share no ring with others (the paper's patches at joins) begin anew.
    """
    rings = _rings(mesh)
    return None if rings is None else _measured(mesh, rings)


@dataclass(frozen=True, slots=True, eq=False)
class _Rings:
    """``vertices`` (r, n) of each ring, of which ``before`` (p,) are each followed by the next.

    ``poles`` are all other vertices, that round a tube's ends.
    """

    vertices: Indices
    before: Indices
    poles: Indices


def _rings(mesh: Mesh) -> _Rings | None:
    """Every second triangle between two rings is of a vertex, the next ring's, and one beside."""
    first, second = mesh.faces[:, :2].astype(np.int64).T
    steps = second - first
    forward = steps[steps > 1]
    if len(forward) == 0:
        return None
    sides = int(np.bincount(forward).argmax())
    has_next = np.zeros(len(mesh.vertices), dtype=np.bool_)
    has_next[first[steps == sides]] = True
    is_ring = has_next.copy()
    is_ring[sides:] |= has_next[:-sides]
    vertices = np.flatnonzero(is_ring)
    if len(vertices) % sides or 2 * has_next.sum() < 0.8 * (len(mesh.faces) - 2 * sides):
        return None
    rings = vertices.reshape(-1, sides)
    follows = has_next[rings]
    if (rings[:, -1] - rings[:, 0] != sides - 1).any() or (follows != follows[:, :1]).any():
        return None
    return _Rings(rings, np.flatnonzero(follows[:, 0]), np.flatnonzero(~is_ring))


def _measured(mesh: Mesh, rings: _Rings) -> Strands:
    count, sides = rings.vertices.shape
    here, there = _shared(mesh, rings)
    middles = mesh.vertices[rings.vertices].mean(axis=1, dtype=np.float64)
    steps = np.linalg.norm(middles[rings.before + 1] - middles[rings.before], axis=1)
    along = _along(
        count,
        np.concatenate([rings.before, here // sides]),
        np.concatenate([rings.before + 1, there // sides]),
        np.concatenate([steps, np.zeros(len(here))]),
    )
    numbers = np.arange(count * sides).reshape(count, sides)
    # Few tubes have a grain, and this takes longer to import than all else that scenes need.
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    joined = coo_array(
        (
            np.ones(rings.before.size * sides + len(here)),
            (
                np.concatenate([numbers[rings.before].ravel(), here]),
                np.concatenate([numbers[rings.before + 1].ravel(), there]),
            ),
        ),
        shape=(count * sides, count * sides),
    )
    _, strand = connected_components(joined, directed=False)
    # A strand is that side of the tube which it has where it begins.
    _, begin = np.unique(strand, return_index=True)
    side = (begin % sides)[strand]
    around = np.minimum(side, sides - side) * (2 / sides)
    found = Strands(np.zeros(len(mesh.vertices)), np.zeros(len(mesh.vertices)))
    found.along[rings.vertices] = along[:, None]
    found.around[rings.vertices.ravel()] = around
    _place_poles(mesh, rings, found)
    return found


def _shared(mesh: Mesh, rings: _Rings) -> tuple[Indices, Indices]:
    """Pairs of vertices, as numbers among the rings', at the same place to the bit."""
    count, sides = rings.vertices.shape
    is_middle = np.zeros(count, dtype=np.bool_)
    is_middle[rings.before + 1] = True
    is_first = ~is_middle
    is_last = np.ones(count, dtype=np.bool_)
    is_last[rings.before] = False
    rims = np.flatnonzero(is_first | is_last)
    numbers = (rims[:, None] * sides + np.arange(sides)).ravel()
    places = mesh.vertices[rings.vertices[rims].ravel()]
    _, which = np.unique(places, axis=0, return_inverse=True)
    order = np.argsort(which.reshape(-1), kind="stable")
    same: NDArray[np.bool_] = np.diff(which.reshape(-1)[order]) == 0
    return numbers[order][:-1][same], numbers[order][1:][same]


def _along(count: int, here: Indices, there: Indices, lengths: Floats) -> Floats:
    """Distances (count,) from the first ring of each connected tree."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components, dijkstra

    ways = coo_array((lengths + _NEXT_TO_NOTHING, (here, there)), shape=(count, count)).tocsr()
    _, tree = connected_components(ways, directed=False)
    _, roots = np.unique(tree, return_index=True)
    return np.asarray(dijkstra(ways, directed=False, indices=roots, min_only=True))


def _place_poles(mesh: Mesh, rings: _Rings, found: Strands) -> None:
    """Poles are as far along as the ring next to them, and as far around as its first side."""
    is_pole = np.zeros(len(mesh.vertices), dtype=np.bool_)
    is_pole[rings.poles] = True
    faces = mesh.faces[is_pole[mesh.faces[:, 2]]].astype(np.int64)
    found.along[faces[:, 2]] = found.along[faces[:, 0]]
    found.around[faces[:, 2]] = 0.5
