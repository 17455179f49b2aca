"""Tubes as stacks of rings: how many vertices and faces they have, and which faces."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numba import njit
from numpy.typing import NDArray

from app.arrays import Faces, Indices, Singles
from app.tubes.circle import FEWEST_SIDES, MOST_SIDES


@dataclass(frozen=True, slots=True, eq=False)
class Stacks:
    """Where the rings of s segments go in the arrays of all tubes.

    A segment's vertices are its first pole if it has one, ring after ring, its last pole if it has
    one. ``sides`` (s,) are the vertices of each of its rings, ``rings`` (s,) counts them,
    ``cap_rings`` (s, 2) says how many of them round its ends, ``poles`` (s, 2) which ends have a
    pole. ``vertices`` and ``faces`` (s + 1,) are where it begins in the shared arrays;
    ``first_vertices`` (s,) is where it begins within its hyperedge.

    Segments with equal sides, rings and poles have equal faces, up to where their vertices begin.
    """

    sides: Indices
    rings: Indices
    cap_rings: Indices
    poles: NDArray[np.bool_]
    vertices: Indices
    faces: Indices
    first_vertices: Indices


def stack_rings(
    segment_starts: Indices,
    sides: Indices,
    rings: Indices,
    cap_rings: Indices,
    poles: NDArray[np.bool_],
) -> Stacks:
    """Stacks of ``rings`` (s,) and the rings of their ends ``cap_rings`` (s, 2) on top of that.

    ``segment_starts`` (h + 1,) says which segments are of one hyperedge; ``sides`` and the others
    are by segment.
    """
    rings = rings + cap_rings.sum(axis=1)
    pole_counts = poles.sum(axis=1)
    vertices = _starts(rings * sides + pole_counts)
    faces = _starts((2 * (rings - 1) + pole_counts) * sides)
    first_vertices = vertices[:-1] - np.repeat(
        vertices[segment_starts[:-1]], np.diff(segment_starts)
    )
    return Stacks(sides, rings, cap_rings, poles, vertices, faces, first_vertices)


def _starts(counts: Indices) -> Indices:
    starts = np.zeros(len(counts) + 1, dtype=np.int64)
    np.cumsum(counts, out=starts[1:])
    return starts


def room_for(stacks: Stacks) -> tuple[Singles, Singles, Faces]:
    """Vertices (v, 3), normals (v, 3) and faces (f, 3), still to be filled.

    One piece of memory: fetching it from the system costs more than filling it, and large pieces
    come in large pages, or are the one that was given back last.
    """
    vertices, faces = 3 * int(stacks.vertices[-1]), 3 * int(stacks.faces[-1])
    room = np.empty(2 * vertices + faces, dtype=np.float32)
    return (
        room[:vertices].reshape(-1, 3),
        room[vertices : 2 * vertices].reshape(-1, 3),
        room[2 * vertices :].view(np.uint32).reshape(-1, 3),
    )


@lru_cache(maxsize=1)
def strips() -> NDArray[np.uint32]:
    """Faces between two rings, as vertex numbers from the first ring on: [sides, number]."""
    table = np.zeros((MOST_SIDES + 1, 6 * MOST_SIDES), dtype=np.uint32)
    for sides in range(FEWEST_SIDES, MOST_SIDES + 1, 2):
        here = np.arange(sides)
        beside = np.roll(here, -1)
        quads = [here, beside, here + sides, beside, beside + sides, here + sides]
        table[sides, : 6 * sides] = np.stack(quads, axis=1).ravel()
    table.setflags(write=False)
    return table


@njit(cache=True, error_model="numpy")
def write_faces(
    strips: NDArray[np.uint32],
    faces: NDArray[np.uint32],
    at: int,
    vertex: int,
    sides: int,
    rings: int,
    first_pole: bool,
    last_pole: bool,
) -> None:
    """Write the faces of one stack into flat ``faces`` from face ``at`` on.

    ``vertex`` is the number of its first vertex. Unsigned indices throughout: twice as fast.
    """
    one, two, three, six = np.uint64(1), np.uint64(2), np.uint64(3), np.uint64(6)
    row, i, numbers = np.uint64(sides), np.uint64(3 * at), np.uint64(6 * sides)
    a = np.uint32(vertex)
    if first_pole:
        pole = a
        a = np.uint32(a + one)
        for k in range(row):
            faces[i], faces[i + one] = strips[row, six * k + one] + a, strips[row, six * k] + a
            faces[i + two] = pole
            i += three
    for _ in range(rings - 1):
        for k in range(numbers):
            faces[i + k] = strips[row, k] + a
        i += numbers
        a = np.uint32(a + row)
    if last_pole:
        pole = np.uint32(a + row)
        for k in range(row):
            faces[i], faces[i + one] = strips[row, six * k] + a, strips[row, six * k + one] + a
            faces[i + two] = pole
            i += three
