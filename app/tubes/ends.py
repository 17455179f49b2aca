"""What each segment begins and ends at: a place, a tangent, and whether it needs a rounded end."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit
from numpy.typing import NDArray

from app.arrays import Floats, Indices
from app.hyperedges.routing import Routing

# Differences below this share of the coordinates are what rounding leaves of equal points.
_ROUNDING = 1e-12


@dataclass(frozen=True, slots=True, eq=False)
class Ends:
    """Both ends of s segments.

    ``positions`` and unit ``axes`` (s, 2, 3); ``senses`` (s, 2) are 1.0 where the segment runs
    along its axis, -1.0 where it runs against it. All segments of a join have the same position and
    axis to the bit. ``free`` (s, 2) is true at attachments. ``tiny`` (s,) is the squared length
    below which a difference of control points has no direction.
    """

    positions: Floats
    axes: Floats
    senses: Floats
    free: NDArray[np.bool_]
    tiny: Floats

    @property
    def tangents(self) -> Floats:
        """Unit vectors in which the segments run, (s, 2, 3)."""
        return self.axes * self.senses[:, :, None]


def ends_of(routing: Routing, hyperedges: Indices) -> Ends:
    """Both ends of all segments; ``hyperedges`` (s,) says which hyperedge each is of.

    A tangent without a direction gives way to the direction of the next control point that has
    one, and at last to the z axis.
    """
    count = len(routing.control_points)
    positions = np.empty((count, 2, 3))
    axes = np.empty((count, 2, 3))
    senses = np.empty((count, 2))
    free = np.empty((count, 2), dtype=np.bool_)
    tiny = np.empty(count)
    _fill_ends(
        routing.control_points,
        hyperedges,
        routing.segment_ends,
        routing.join_positions,
        routing.join_tangents,
        routing.join_starts,
        routing.attachment_counts,
        positions,
        axes,
        senses,
        free,
        tiny,
    )
    return Ends(positions, axes, senses, free, tiny)


@njit(cache=True, error_model="numpy")
def _fill_ends(
    control_points: Floats,
    hyperedges: Indices,
    segment_ends: Indices,
    join_positions: Floats,
    join_tangents: Floats,
    join_starts: Indices,
    attachment_counts: Indices,
    positions: Floats,
    axes: Floats,
    senses: Floats,
    free: NDArray[np.bool_],
    tiny: Floats,
) -> None:
    for s in range(len(control_points)):
        tiny[s] = _tiny(control_points, s)
        first_join = join_starts[hyperedges[s]]
        attachments = attachment_counts[hyperedges[s]]
        for end in range(2):
            _own_tangent(control_points, s, end, tiny[s], axes)
            senses[s, end] = 1.0
            free[s, end] = segment_ends[s, end] < attachments
            if free[s, end]:
                for axis in range(3):
                    positions[s, end, axis] = control_points[s, 3 * end, axis]
            else:
                join = first_join + segment_ends[s, end] - attachments
                for axis in range(3):
                    positions[s, end, axis] = join_positions[join, axis]
                senses[s, end] = _take_axis(join_tangents, join, axes, s, end)


@njit(cache=True, error_model="numpy")
def _tiny(control_points: Floats, s: int) -> float:
    largest = 0.0
    for i in range(4):
        for axis in range(3):
            largest = max(largest, abs(control_points[s, i, axis]))
    return (_ROUNDING * largest) ** 2


@njit(cache=True, error_model="numpy")
def _own_tangent(control_points: Floats, s: int, end: int, tiny: float, axes: Floats) -> None:
    for i in range(1, 4):
        start, stop = (3 - i, 3) if end else (0, i)
        x = control_points[s, stop, 0] - control_points[s, start, 0]
        y = control_points[s, stop, 1] - control_points[s, start, 1]
        z = control_points[s, stop, 2] - control_points[s, start, 2]
        square = x * x + y * y + z * z
        if square > tiny:
            length = np.sqrt(square)
            axes[s, end, 0], axes[s, end, 1], axes[s, end, 2] = x / length, y / length, z / length
            return
    axes[s, end, 0], axes[s, end, 1], axes[s, end, 2] = 0.0, 0.0, 1.0


@njit(cache=True, error_model="numpy")
def _take_axis(join_tangents: Floats, join: int, axes: Floats, s: int, end: int) -> float:
    """Replace a segment's own tangent by the join's; say in which sense the segment follows it."""
    x, y, z = join_tangents[join, 0], join_tangents[join, 1], join_tangents[join, 2]
    square = x * x + y * y + z * z
    if not 0.5 < square < 2.0:
        x, y, z, square = 0.0, 0.0, 1.0, 1.0
    length = np.sqrt(square)
    x, y, z = x / length, y / length, z / length
    along = x * axes[s, end, 0] + y * axes[s, end, 1] + z * axes[s, end, 2]
    axes[s, end, 0], axes[s, end, 1], axes[s, end, 2] = x, y, z
    return -1.0 if along < 0.0 else 1.0
