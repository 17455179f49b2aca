import numpy as np

from app.solids.mesh import Mesh


def test_nothing_has_its_bounds_at_the_origin() -> None:
    np.testing.assert_array_equal(Mesh.none().bounds, np.zeros((2, 3)))
