"""Rotations as unit quaternions x, y, z, w."""

from __future__ import annotations

import numpy as np

from app.arrays import Floats


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
