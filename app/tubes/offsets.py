"""Where a patch pair's control points go: aside of the curve, and up from there.

Each of a curve's four control points has an *offset*, square to the curve there, and an *up*,
square to both. Both rules give them for s segments, (s, 4, 3) each, the length of the radius.
"""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from app.arrays import Floats
from app.tubes.ends import Ends
from app.tubes.rings import hodograph
from app.tubes.track import TRACK_ROWS, align, follow

# Shorter sums and differences of unit vectors than this have no direction worth following.
_STRAIGHT = 1e-6

# Where the fitted rule compares its patches with the tube.
_PLACES = np.linspace(0.0, 1.0, 25)


def paper_offsets(control_points: Floats, radii: Floats, ends: Ends) -> tuple[Floats, Floats]:
    """The paper's rule: at both ends perpendicular, inside halfway between the neighbours.

    ``radii`` (s,) are the segments'. The paper leaves open which perpendicular, and what holds
    where three control points are in line: here every row follows its neighbour with the least
    turn, so that the same side stays the same side and no surface is twisted; a straight segment's
    offsets are level, and of both ways round the one is taken whose top is above its bottom.
    """
    tangents, halfway, bent = _bisectors(control_points, ends)
    rows = np.empty_like(control_points)
    level = _level(tangents[:, 0])
    first = np.where(
        bent[:, 1][:, None],
        _swing(halfway[:, 1], tangents[:, 1], tangents[:, 0]),
        _swing(
            _swing(halfway[:, 2], tangents[:, 2], tangents[:, 1]), tangents[:, 1], tangents[:, 0]
        ),
    )
    first = np.where((bent[:, 1] | bent[:, 2])[:, None], first, level)
    first = _square(first, tangents[:, 0], level)
    rows[:, 0] = np.where(_points_up(np.cross(first, tangents[:, 0]))[:, None], first, -first)
    for row in range(1, 4):
        followed = _swing(rows[:, row - 1], tangents[:, row - 1], tangents[:, row])
        same = _dot(followed, halfway[:, row]) >= 0.0
        wanted = np.where(same[:, None], halfway[:, row], -halfway[:, row])
        rows[:, row] = np.where(bent[:, row][:, None], wanted, followed)
        rows[:, row] = _square(rows[:, row], tangents[:, row], _level(tangents[:, row]))
    ups = np.cross(rows, tangents)
    return radii[:, None, None] * rows, radii[:, None, None] * ups


def fitted_offsets(control_points: Floats, radii: Floats, ends: Ends) -> tuple[Floats, Floats]:
    """Offsets fitted to the swept tube: least squares against its frames along the segment.

    ``radii`` (s,) are the segments'. At both ends they are square to the curve and depend on the
    tangent alone, so that the three tubes of a join meet in the same rim.
    """
    normals, binormals = _frames_at(
        control_points, ends.positions, ends.axes, ends.senses, ends.tangents, ends.tiny, _PLACES
    )
    return _fit(radii[:, None, None] * normals), _fit(-radii[:, None, None] * binormals)


def _fit(targets: Floats) -> Floats:
    """Control points (s, 4, 3) of the cubics from first to last of ``targets`` (s, m, 3)."""
    t = _PLACES[1:-1]
    ends = np.stack([(1 - t) ** 3, t**3], axis=1)
    inner = np.stack([3 * t * (1 - t) ** 2, 3 * t**2 * (1 - t)], axis=1)
    left = targets[:, 1:-1] - ends @ targets[:, [0, -1]]
    fitted = np.empty((len(targets), 4, 3))
    fitted[:, [0, 3]] = targets[:, [0, -1]]
    fitted[:, 1:3] = np.linalg.pinv(inner) @ left
    return fitted


@njit(cache=True, error_model="numpy")
def _frames_at(
    control_points: Floats,
    positions: Floats,
    axes: Floats,
    senses: Floats,
    tangents: Floats,
    tiny: Floats,
    parameters: Floats,
) -> tuple[Floats, Floats]:
    """First and second normals of s segments at m parameters, (s, m, 3) each."""
    count = len(parameters)
    normals = np.empty((len(control_points), count, 3))
    binormals = np.empty_like(normals)
    slopes, track = np.empty(9), np.empty((TRACK_ROWS, count))
    for s in range(len(control_points)):
        hodograph(control_points, s, slopes)
        follow(control_points, positions, tangents, s, tiny[s], slopes, parameters, count, track)
        # A patch pair that is turned by half a turn is itself again: two sides.
        turned = align(axes, senses, s, 2, count, track) % 2
        for i in range(count):
            sign = -1.0 if turned and i == count - 1 else 1.0
            for axis in range(3):
                normals[s, i, axis] = sign * track[6 + axis, i]
                binormals[s, i, axis] = sign * track[9 + axis, i]
    return normals, binormals


def _bisectors(control_points: Floats, ends: Ends) -> tuple[Floats, Floats, NDArray[np.bool_]]:
    """Tangents and directions halfway between the neighbours, (s, 4, 3), and where these exist.

    A tangent inside halves the turn of the control polygon, so halfway is square to it.
    """
    legs = np.diff(control_points, axis=1)
    squares = np.einsum("slx,slx->sl", legs, legs)
    short = (squares <= ends.tiny[:, None])[:, :, None]
    middle = _unit(ends.tangents.sum(axis=1), ends.tangents[:, 0])
    instead = np.stack([ends.tangents[:, 0], middle, ends.tangents[:, 1]], axis=1)
    legs = np.where(short, instead, legs / np.sqrt(np.where(squares > 0, squares, 1.0))[:, :, None])
    halfway = np.zeros_like(control_points)
    halfway[:, 1:3] = legs[:, 1:] - legs[:, :-1]
    bent = np.asarray(np.einsum("srx,srx->sr", halfway, halfway) > _STRAIGHT**2)
    halfway = _unit(halfway, np.zeros_like(halfway))
    tangents = np.empty_like(control_points)
    tangents[:, [0, 3]] = ends.tangents
    # Where the polygon doubles back, any direction square to halfway will do.
    tangents[:, 1:3] = _unit(legs[:, 1:] + legs[:, :-1], _level(halfway[:, 1:3]))
    return tangents, halfway, bent


def _unit(vectors: Floats, instead: Floats) -> Floats:
    lengths = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return np.where(
        lengths > _STRAIGHT, vectors / np.where(lengths > _STRAIGHT, lengths, 1.0), instead
    )


def _level(directions: Floats) -> Floats:
    """Unit vectors square to ``directions`` (…, 3) and to the z axis; x where these are one."""
    x, y = directions[..., 1], -directions[..., 0]
    return _unit(np.stack([x, y, np.zeros_like(x)], axis=-1), np.array([1.0, 0.0, 0.0]))


def _swing(vectors: Floats, before: Floats, after: Floats) -> Floats:
    """Turn ``vectors``, square to ``before``, as ``before`` turns most shortly to ``after``."""
    middle = _unit(before + after, np.zeros_like(before))
    return vectors - 2.0 * _dot(vectors, middle)[:, None] * middle


def _square(vectors: Floats, tangents: Floats, instead: Floats) -> Floats:
    """``vectors`` without what rounding left along ``tangents``, as unit vectors."""
    along = _dot(vectors, tangents)[:, None]
    return _unit(vectors - along * tangents, instead)


def _dot(a: Floats, b: Floats) -> Floats:
    return np.asarray(np.einsum("sx,sx->s", a, b))


def _points_up(vectors: Floats) -> NDArray[np.bool_]:
    """Whether ``vectors`` point up; of level ones, whether they point to +y, or to +x."""
    z = np.where(np.abs(vectors[:, 2]) > _STRAIGHT, vectors[:, 2], 0.0)
    y = np.where(np.abs(vectors[:, 1]) > _STRAIGHT, vectors[:, 1], 0.0)
    return np.asarray((z > 0) | ((z == 0) & ((y > 0) | ((y == 0) & (vectors[:, 0] >= 0)))))
