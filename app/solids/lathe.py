"""Solids turned on a lathe: a profile led around a plan, with exact normals.

A plan may be a circle, as on a real lathe, or a rectangle with round or square corners: then a
profile led around it gives a block or a tray. Rounded edges are arcs of the profile and of the
plan, and lie exactly on their surface.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from app.arrays import Faces, Floats, Indices
from app.solids.mesh import Mesh

Profile = Floats
"""(k, 4): distance from the plan's core, z, and the outward unit normal in the same two axes.

It runs up the outside of the solid and closes it: distance 0 at both ends. A crease is a place
that stands twice, with its two normals.
"""


@dataclass(frozen=True, slots=True, eq=False)
class Plan:
    """The c columns that a profile is led along, counter-clockwise seen from above.

    A column stands at its core (c, 2) plus its spoke (c, 2) times the profile's distance, and its
    normal points along ``normals`` (c, 2); ``tips`` (c, 2) is where it points at a sharp tip, where
    each column serves the side between itself and the next. Columns of one number in
    ``core_numbers`` (c,) have the same core; of one number in ``spoke_numbers``, the same spoke.
    """

    cores: Floats
    spokes: Floats
    normals: Floats
    tips: Floats
    core_numbers: Indices
    spoke_numbers: Indices


def point(distance: float, z: float, normal: tuple[float, float]) -> Profile:
    """One place of a profile."""
    return np.array([[distance, z, *normal]])


def corner(distance: float, z: float, quarter: int, edge: float, segments: int) -> Profile:
    """A right-angled corner of a profile, rounded by ``edge`` (0: sharp) in ``segments`` steps.

    The profile turns left, from facing ``quarter`` (0: outward, 1: up, 2: inward, 3: down) to the
    next.
    """
    normals = quarters(quarter, 1, segments if edge > 0 else 1)
    center = np.array([distance, z]) - edge * (normals[0] + normals[-1])
    return np.column_stack([center + edge * normals, normals])


def quarters(first: int, count: int, segments: int) -> Floats:
    """Directions (count * segments + 1, 2) of a turn over quarter circles, from ``first`` on."""
    angles = (first + np.arange(count * segments + 1) / segments) * (np.pi / 2)
    directions = np.column_stack([np.cos(angles), np.sin(angles)])
    # Poles and flat faces are found by exact zeros.
    directions[np.abs(directions) < 1e-15] = 0.0
    return directions


@lru_cache(maxsize=16)
def circle(sides: int) -> Plan:
    """A circle of ``sides`` columns, a multiple of four, around the axis."""
    spokes = quarters(0, 4, sides // 4)[:-1]
    half = np.pi / sides
    rotation = np.array([[np.cos(half), np.sin(half)], [-np.sin(half), np.cos(half)]])
    return Plan(
        np.zeros((sides, 2)),
        spokes,
        spokes,
        spokes @ rotation,
        np.zeros(sides, dtype=np.int64),
        np.arange(sides),
    )


def rectangle(x: float, y: float, segments: int) -> Plan:
    """A rectangle around a core of half sizes ``x``, ``y``; corners square where segments is 0."""
    normals, signs = _around(segments)
    quadrants = np.repeat(np.arange(4), len(normals) // 4)
    return Plan(
        signs * (x, y),
        normals if segments else signs,
        normals,
        normals,
        quadrants,
        np.arange(len(normals)) if segments else quadrants,
    )


@lru_cache(maxsize=16)
def _around(segments: int) -> tuple[Floats, Floats]:
    """Normals of a rectangle's columns and the signs of their corners."""
    normals = np.concatenate([quarters(quarter, 1, max(segments, 1)) for quarter in range(4)])
    signs = np.array([(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)])
    return normals, np.repeat(signs, len(normals) // 4, axis=0)


def turn(plan: Plan, profile: Profile) -> Mesh:
    """The solid that ``profile`` makes around ``plan``."""
    vertices, normals, faces = turn_exactly(plan, profile)
    return Mesh(vertices.astype(np.float32), normals.astype(np.float32), faces)


def turn_exactly(plan: Plan, profile: Profile) -> tuple[Floats, Floats, Faces]:
    """The same in double precision: vertices (v, 3), normals (v, 3), faces (f, 3)."""
    distance, z, outward, upward = profile.T
    at_pole = distance == 0
    rows = np.cumsum(np.concatenate([[False], np.any(np.diff(profile[:, :2], axis=0), axis=1)]))
    faces, used = _topology(
        plan.core_numbers.tobytes(),
        plan.spoke_numbers.tobytes(),
        rows.tobytes(),
        at_pole.tobytes(),
        (at_pole & (outward == 0)).tobytes(),
    )
    shape = (len(profile), len(plan.cores))
    vertices, normals = np.empty((*shape, 3)), np.empty((*shape, 3))
    vertices[..., :2] = plan.cores + distance[:, None, None] * plan.spokes
    vertices[..., 2] = z[:, None]
    sideways = np.where(at_pole[:, None, None], plan.tips, plan.normals)
    normals[..., :2] = outward[:, None, None] * sideways
    normals[..., 2] = upward[:, None]
    return vertices.reshape(-1, 3)[used], normals.reshape(-1, 3)[used], faces


@lru_cache(maxsize=128)
def _topology(
    cores: bytes, spokes: bytes, rows: bytes, poles: bytes, flat: bytes
) -> tuple[Faces, Indices]:
    """Faces, and which of the grid's vertices they use; equal for all solids of one make.

    ``cores`` and ``spokes`` number those of the plan, ``rows`` the places of the profile (int64);
    ``poles`` and ``flat`` tell (bool) which places are at distance 0, and which of these face
    straight up or down. Bytes, to be looked up by. Faces without area are left out.
    """
    core = np.frombuffer(cores, dtype=np.int64)
    spoke = np.frombuffer(spokes, dtype=np.int64)
    row = np.frombuffer(rows, dtype=np.int64)
    columns = len(core)
    at_pole = np.frombuffer(poles, dtype=np.bool_)[:, None]
    column = np.where(at_pole, core, spoke)
    place = (row[:, None] * columns + column).ravel()

    grid = np.arange(len(row) * columns).reshape(len(row), columns)
    lower, upper = grid[:-1], grid[1:]
    beside, above = np.roll(lower, -1, axis=1), np.roll(upper, -1, axis=1)
    first, last = grid[0], grid[-1]
    faces = np.concatenate(
        [
            # Split so that at a tip above, the vertex of the side's own column remains.
            np.stack([lower, beside, upper], axis=-1).reshape(-1, 3),
            np.stack([beside, above, upper], axis=-1).reshape(-1, 3),
            np.column_stack([np.full(columns - 2, first[0]), first[2:], first[1:-1]]),
            np.column_stack([np.full(columns - 2, last[0]), last[1:-1], last[2:]]),
        ]
    )
    corners = place[faces]
    faces = faces[np.all(corners != np.roll(corners, 1, axis=1), axis=1)]

    _, leader = np.unique(core, return_index=True)
    is_flat = np.frombuffer(flat, dtype=np.bool_)[:, None]
    merged = np.where(is_flat, grid[:, leader[core]], grid).ravel()
    used, faces = np.unique(merged[faces], return_inverse=True)
    return faces.reshape(-1, 3).astype(np.uint32), used
