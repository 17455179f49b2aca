"""Swept tubes: a circle that runs along each segment, square to it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from app.arrays import Faces, Floats, Singles
from app.hyperedges.routing import Routing
from app.tubes.circle import cap_rings, circles, latitudes
from app.tubes.stacks import Stacks, room_for, stack_rings, strips
from app.tubes.sweep_kernel import fill_swept
from app.tubes.tessellation import Tessellation, tessellation_of
from app.tubes.tubes import Tubes


def sweep(routing: Routing, tolerance: float | Floats) -> Tubes:
    """Tubes of a circle swept along every segment, with normals that stand square on the curve.

    What one sees: tubes of the same thickness everywhere, round at attachments, and at joins three
    of them that pass into each other without a step, for they share the last ring there, equal to
    the bit in positions and normals. Frames turn as little as can be along a segment, and there is
    no seam.

    No chord around a tube is off by more than ``tolerance`` (document units; one for all, or one
    for each hyperedge, (h,)), nor one along it;
    `app.tubes.circle.MOST_SIDES` and a millionth of a segment's length bound how fine it gets.
    Segments of zero length become balls; no position is NaN, and every normal is a unit vector.
    Equal counts of rings and sides give equal faces. Raises ValueError where the tolerance is not
    positive.
    """
    plan = tessellation_of(routing, tolerance)
    starts = routing.segment_starts
    stacks, vertices, normals, faces = stack_tubes(routing, plan, plan.ends.free)
    return Tubes(vertices, normals, faces, stacks.vertices[starts], stacks.faces[starts])


def stack_tubes(
    routing: Routing, plan: Tessellation, rounded: NDArray[np.bool_]
) -> tuple[Stacks, Singles, Singles, Faces]:
    """Stacks of rings with vertices, normals and faces; those ends that are ``rounded`` (s, 2)."""
    ends = plan.ends
    caps = rounded * cap_rings(plan.sides)[:, None]
    stacks = stack_rings(routing.segment_starts, plan.sides, plan.rings.counts, caps, rounded)
    vertices, normals, faces = room_for(stacks)
    fill_swept(
        0,
        len(plan.sides),
        routing.control_points,
        plan.hyperedges,
        routing.radii,
        ends.positions,
        ends.axes,
        ends.senses,
        ends.tangents,
        ends.tiny,
        plan.rings.counts,
        plan.rings.loads,
        plan.rings.sharp,
        stacks.sides,
        stacks.rings,
        stacks.cap_rings,
        stacks.poles,
        stacks.vertices,
        stacks.faces,
        stacks.first_vertices,
        circles(),
        latitudes(),
        strips(),
        vertices.reshape(-1),
        normals.reshape(-1),
        faces.reshape(-1),
    )
    return stacks, vertices, normals, faces
