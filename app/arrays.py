"""Aliases that say what an array holds; its shape stands in the docstring of whoever takes it."""

from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

Floats: TypeAlias = NDArray[np.float64]
"""Geometry before tessellation: positions, directions, control points."""

Singles: TypeAlias = NDArray[np.float32]
"""Geometry as graphics hardware wants it: vertices and normals."""

Indices: TypeAlias = NDArray[np.int64]
"""Positions in other arrays; ``starts`` arrays have one entry more than there are groups."""

Faces: TypeAlias = NDArray[np.uint32]
"""Triangles as three vertex numbers each, counter-clockwise seen from outside."""

Flags: TypeAlias = NDArray[np.bool_]
