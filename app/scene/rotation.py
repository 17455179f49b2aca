"""Rotations as unit quaternions x, y, z, w."""

from __future__ import annotations

import numpy as np

from app.arrays import Floats


def matrices(quaternions: Floats) -> Floats:
    """Rotation matrices (…, 3, 3) of unit quaternions (…, 4): they turn columns.

    >>> matrices(np.array([0.0, 0.0, 0.0, 1.0])).tolist()
    [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
    """
    q = np.asarray(quaternions, dtype=np.float64)
    x, y, z, w = q[..., 0], q[..., 1], q[..., 2], q[..., 3]
    found = np.empty((*q.shape[:-1], 3, 3))
    found[..., 0, 0] = 1 - 2 * (y * y + z * z)
    found[..., 1, 1] = 1 - 2 * (x * x + z * z)
    found[..., 2, 2] = 1 - 2 * (x * x + y * y)
    found[..., 0, 1], found[..., 1, 0] = 2 * (x * y - z * w), 2 * (x * y + z * w)
    found[..., 0, 2], found[..., 2, 0] = 2 * (x * z + y * w), 2 * (x * z - y * w)
    found[..., 1, 2], found[..., 2, 1] = 2 * (y * z - x * w), 2 * (y * z + x * w)
    return found


def quaternion(matrix: Floats) -> tuple[float, float, float, float]:
    """The unit quaternion of a rotation matrix (3, 3), with w ≥ 0.

    Shepperd (1978): the component that is surely not small first, the others from it.

    >>> quaternion(np.diag([1.0, -1.0, -1.0]))
    (1.0, 0.0, 0.0, 0.0)
    """
    m = np.asarray(matrix, dtype=np.float64)
    # Four times the products of the components with each other, x, y, z, w.
    products = np.empty((4, 4))
    products[:3, :3] = m + m.T
    products[:3, 3] = products[3, :3] = [m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1]]
    diagonal = 1 + np.array([[1, -1, -1], [-1, 1, -1], [-1, -1, 1], [1, 1, 1]]) @ np.diag(m)
    products[range(4), range(4)] = diagonal
    found = products[int(diagonal.argmax())]
    found = found / np.linalg.norm(found) * (-1.0 if found[3] < 0 else 1.0)
    x, y, z, w = (found + 0.0).tolist()
    return x, y, z, w
