import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from app.placement.turning import from_degrees, reach, then, turned

degrees = st.floats(-720, 720)
angles = st.tuples(degrees, degrees, degrees)
vectors = st.tuples(*[st.floats(-100, 100)] * 3)


@given(angles, vectors)
def test_turns_are_about_x_then_y_then_z(
    turn: tuple[float, float, float], vector: tuple[float, float, float]
) -> None:
    expected = Rotation.from_euler("xyz", turn, degrees=True).apply(vector)
    np.testing.assert_allclose(turned(from_degrees(*turn), vector), expected, atol=1e-9)


@given(angles, angles, vectors)
def test_one_turn_after_another(
    first: tuple[float, float, float],
    second: tuple[float, float, float],
    vector: tuple[float, float, float],
) -> None:
    one, two = from_degrees(*first), from_degrees(*second)
    np.testing.assert_allclose(
        turned(then(two, one), vector), turned(two, turned(one, vector)), atol=1e-9
    )


def test_a_box_turned_by_a_quarter_reaches_as_far_the_other_way() -> None:
    np.testing.assert_allclose(reach(from_degrees(0, 0, 90), (3.0, 1.0, 2.0)), (1, 3, 2))
