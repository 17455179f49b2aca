"""The paper's tubes: each segment a pair of bicubic Bezier patches, one its top, one its bottom.

What a reader of the picture sees of the two rules for their control points: by the ``paper``'s rule
a tube keeps its thickness at its ends and where it is straight, but is pinched in bends, by a
quarter at the narrowest place of an ordinary curve, and more in tight ones. By the ``fitted`` rule
it is nearly as even as a swept tube; only bends as tight as the tube is thick show that one patch
is too stiff for them. Neither is quite round: half a circle as one cubic is up to 1.8 percent too
wide. At joins the rims of the paper's patches differ by as much; the fitted ones share theirs.
"""

from __future__ import annotations

from typing import Literal

import numpy as np

from app.arrays import Floats
from app.hyperedges.routing import Routing
from app.tubes.circle import cap_rings, latitudes
from app.tubes.ends import Ends, ends_of
from app.tubes.offsets import fitted_offsets, paper_offsets
from app.tubes.patch_kernel import fill_patches, half_circles
from app.tubes.stacks import room_for, stack_rings, strips
from app.tubes.tessellation import tessellation_of
from app.tubes.tubes import Tubes

Rule = Literal["paper", "fitted"]

# |up| for an |offset| of one: the cubic then reaches exactly one radius above the middle.
_UP = 4.0 / 3.0


def patch_pairs(routing: Routing, rule: Rule) -> Floats:
    """Control points of the patch pairs of s segments, (s, 2, 4, 4, 3), top before bottom.

    Rows follow the segment's four control points. Columns of the top are -offset, -offset + up,
    +offset + up, +offset from them; the bottom has the same outer columns, and inner ones that are
    twice up lower. ``rule`` is ``paper`` for the offsets of the paper's words, or ``fitted`` for
    offsets that keep the tube's radius; see `app.tubes.offsets`.
    """
    counts = np.diff(routing.segment_starts)
    hyperedges = np.repeat(np.arange(len(counts)), counts)
    return _pairs(routing, routing.radii[hyperedges], ends_of(routing, hyperedges), rule)


def patch_tubes(routing: Routing, rule: Rule, tolerance: float | Floats) -> Tubes:
    """The patch pairs of `patch_pairs` as triangles, with normals from their partial derivatives.

    Top and bottom share the vertices of their seams. Ends are closed: rounded at attachments, flat
    at joins, where other tubes hide them. Rings and sides are those of `app.tubes.sweep.sweep`.
    Raises ValueError where the tolerance is not positive.
    """
    plan = tessellation_of(routing, tolerance)
    ends = plan.ends
    radii = routing.radii[plan.hyperedges]
    caps = ends.free * cap_rings(plan.sides)[:, None]
    starts = routing.segment_starts
    stacks = stack_rings(starts, plan.sides, plan.rings.counts, caps, np.ones_like(ends.free))
    vertices, normals, faces = room_for(stacks)
    fill_patches(
        _pairs(routing, radii, ends, rule),
        routing.control_points,
        radii,
        ends.tangents,
        ends.free,
        ends.tiny,
        plan.rings.counts,
        plan.rings.loads,
        plan.rings.sharp,
        stacks.sides,
        stacks.rings,
        stacks.cap_rings,
        stacks.vertices,
        stacks.faces,
        stacks.first_vertices,
        half_circles(),
        latitudes(),
        strips(),
        vertices,
        normals,
        faces.reshape(-1),
    )
    return Tubes(vertices, normals, faces, stacks.vertices[starts], stacks.faces[starts])


def _pairs(routing: Routing, radii: Floats, ends: Ends, rule: Rule) -> Floats:
    offsets_by = paper_offsets if rule == "paper" else fitted_offsets
    offsets, ups = offsets_by(routing.control_points, radii, ends)
    left, right = routing.control_points - offsets, routing.control_points + offsets
    up = _UP * ups
    top = np.stack([left, left + up, right + up, right], axis=2)
    bottom = np.stack([left, left - up, right - up, right], axis=2)
    return np.stack([top, bottom], axis=1)
