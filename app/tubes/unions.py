"""Tubes for printing: each hyperedge as one closed body."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from manifold3d import Error, Manifold, Mesh64, OpType

from app.arrays import Floats
from app.errors import Fault, Unprintable, pointer
from app.hyperedges.routing import Routing
from app.program import faults
from app.solids.mesh import Mesh
from app.solids.welding import edges_of, is_closed, normals_of, part
from app.tubes.bodies import bodies
from app.tubes.chains import Rings, chain_rings
from app.tubes.circle import tolerances_of
from app.tubes.stretches import Stretches, stretches_of
from app.tubes.tessellation import tessellation_of
from app.tubes.tubes import Tubes

_STEPS = 64.0
"""Of single precision that a radius must have, for a circle of so few is not round."""

_SHORTEST = 1e-4
"""Of a radius. An edge that is shorter may be gone once its ends are rounded."""

_SIMPLER = 1e-3
"""Of a radius. By so much a surface with such edges may move to be rid of them."""

_CRUMB = 1e-3
"""Of a body's volume. What floats beside it, or is hollow in it, and is smaller is rounding's."""

_REPORTS = 100
"""How often at most progress is told."""


@dataclass(frozen=True, slots=True, eq=False)
class TubePlan:
    """What hyperedges are united from: their rings and stretches. ``triangles`` goes in."""

    routing: Routing
    rings: Rings
    stretches: Stretches
    triangles: int


def plan_unions(routing: Routing, tolerance: float | Floats) -> TubePlan:
    """Rings of all tubes, cut where tubes run into themselves: quick, beside uniting them.

    ``tolerance`` (document units; one for all, or one for each hyperedge, (h,)) is that of
    `app.tubes.sweep.sweep`; where it is not positive, ValueError is raised.
    """
    plan = tessellation_of(routing, tolerance)
    rings = chain_rings(routing, plan)
    tolerances = np.repeat(tolerances_of(routing.radii, tolerance), np.diff(rings.chain_starts))
    stretches = stretches_of(rings, tolerances)
    # Two half balls of a quarter as many rows as sides, for each stretch.
    caps = rings.sides**2 * np.diff(stretches.starts)
    triangles = np.sum(2 * rings.sides * (rings.counts - 1) + caps)
    return TubePlan(routing, rings, stretches, int(triangles))


def unite(
    plan: TubePlan, names: Sequence[str], progress: Callable[[float], None] = lambda _share: None
) -> Tubes:
    """Each hyperedge as one body, closed, in one piece and nowhere overlapping itself.

    It is what a ball of the radius passes through, within twice the tolerance of the plan and a
    thousandth of the radius. A curve that bends more tightly than its tube is thick, or comes back
    to itself, makes no difference. Hollows are filled. Vertices are positions, no two alike;
    normals are the means of those of the faces around.

    ``names`` (h,) are for messages; ``progress`` is told the share that is done. Raises
    `Unprintable` with every hyperedge that has no such body: those so thin that single precision
    cannot tell their sides apart at the largest coordinate of all hyperedges, and any whose union
    is not in one piece, or not closed, after all.
    """
    meshes: list[Mesh] = []
    wrong: list[Fault] = []
    step = _step(plan.routing.control_points)
    count = len(plan.routing.radii)
    every = max(1, count // _REPORTS)
    for number in range(count):
        if number % every == 0:
            progress(number / count)
        try:
            meshes.append(_united(plan, number, step))
        except _NoBodyError as reason:
            detail = f"Hyperedge {names[number]!r} cannot be printed: {reason}"
            wrong.append(Fault(pointer("hyperedges", number), detail))
    if wrong:
        raise Unprintable(faults.first(wrong))
    return Tubes.of(meshes)


class _NoBodyError(Exception):
    """Why a hyperedge has no body."""


def _united(plan: TubePlan, number: int, step: float) -> Mesh:
    """The mesh of one hyperedge; ``step`` is that of coordinates. Raises `_NoBodyError`."""
    routing = plan.routing
    radius = float(routing.radii[number])
    if not radius >= _STEPS * step:
        raise _NoBodyError(
            f"its radius of {radius:g} is too small for single precision in so wide a scene."
        )
    chains = range(*plan.rings.chain_starts[number : number + 2])
    parts = [body for chain in chains for body in bodies(plan.rings, plan.stretches, chain)]
    union = Manifold.batch_boolean(parts, OpType.Add)
    if union.status() != Error.NoError:
        raise _NoBodyError(f"its union failed ({union.status().name}).")
    body = _largest(union)
    mesh = body.to_mesh64()
    if _shortest(mesh) < max(_SHORTEST * radius, 4.0 * step):
        mesh = _largest(body.as_original().simplify(_SIMPLER * radius)).to_mesh64()
    faces = mesh.tri_verts.astype(np.uint32)
    positions = part(mesh.vert_properties[:, :3], faces)
    if positions is None or not is_closed(faces):
        raise _NoBodyError("its surface cannot be closed in single precision.")
    return Mesh(positions, normals_of(positions, faces).astype(np.float32), faces)


def _step(control_points: Floats) -> float:
    """The step of single precision at the largest coordinate."""
    return float(np.spacing(np.float32(np.abs(control_points).max(initial=0.0))))


def _largest(union: Manifold) -> Manifold:
    """The body of a union, without what rounding has left in and around it."""
    found = union.decompose()
    if len(found) == 1:
        return union
    volumes = [part.volume() for part in found]
    body = int(np.argmax(volumes))
    others = volumes[:body] + volumes[body + 1 :]
    if not volumes[body] > 0.0 or max(others, default=0.0) > _CRUMB * volumes[body]:
        raise _NoBodyError("it is not in one piece.")
    return found[body]


def _shortest(mesh: Mesh64) -> float:
    """The length of the shortest edge."""
    start, stop = edges_of(mesh.tri_verts).T
    along = mesh.vert_properties[stop, :3] - mesh.vert_properties[start, :3]
    return float(np.sqrt(np.einsum("ex,ex->e", along, along).min()))
