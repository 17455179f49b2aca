"""Swept tubes: a circle that runs along each segment, square to it."""

from __future__ import annotations

from app.hyperedges.routing import Routing
from app.tubes.circle import cap_rings, circles, latitudes
from app.tubes.stacks import room_for, stack_rings, strips
from app.tubes.sweep_kernel import fill_swept
from app.tubes.tessellation import tessellation_of
from app.tubes.tubes import Tubes


def sweep(routing: Routing, tolerance: float) -> Tubes:
    """Tubes of a circle swept along every segment, with normals that stand square on the curve.

    What one sees: tubes of the same thickness everywhere, round at attachments, and at joins three
    of them that pass into each other without a step, for they share the last ring there, equal to
    the bit in positions and normals. Frames turn as little as can be along a segment, and there is
    no seam.

    No chord around a tube is off by more than ``tolerance`` (document units), nor one along it;
    `app.tubes.circle.MOST_SIDES` and a millionth of a segment's length bound how fine it gets.
    Segments of zero length become balls; no position is NaN, and every normal is a unit vector.
    Equal counts of rings and sides give equal faces. Raises ValueError where the tolerance is not
    positive.
    """
    plan = tessellation_of(routing, tolerance)
    ends = plan.ends
    caps = ends.free * cap_rings(plan.sides)[:, None]
    starts = routing.segment_starts
    stacks = stack_rings(starts, plan.sides, plan.rings.counts, caps, ends.free)
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
    return Tubes(vertices, normals, faces, stacks.vertices[starts], stacks.faces[starts])
