import numpy as np
import trimesh

from app.solids.welding import edges_of, is_closed, part, weld

TETRAHEDRON = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]], dtype=np.uint32)
CORNERS = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], dtype=np.float32)


def test_vertices_at_one_position_become_one() -> None:
    vertices = np.concatenate([CORNERS, CORNERS])
    faces = TETRAHEDRON + np.array([[0], [4], [0], [4]], dtype=np.uint32)
    positions, welded = weld(vertices, faces)
    np.testing.assert_array_equal(positions, CORNERS)
    np.testing.assert_array_equal(welded, TETRAHEDRON)


def test_both_zeros_are_one_position() -> None:
    vertices = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [-0.0, 0, -0.0]], dtype=np.float32)
    assert len(weld(vertices, TETRAHEDRON)[0]) == 3


def test_faces_without_three_corners_are_left_out() -> None:
    vertices = CORNERS.copy()
    vertices[3] = vertices[0]
    assert len(weld(vertices, TETRAHEDRON)[1]) == 2


def test_a_tetrahedron_is_closed_and_no_part_of_it_is() -> None:
    assert is_closed(TETRAHEDRON)
    for left in range(4):
        assert not is_closed(np.delete(TETRAHEDRON, left, axis=0))


def test_a_face_that_is_turned_around_opens_it() -> None:
    turned = TETRAHEDRON.copy()
    turned[0] = turned[0, ::-1]
    assert not is_closed(turned)


def test_what_is_closed_twice_over_an_edge_is_not_closed() -> None:
    beside = np.array([0, 1, 4, 5], dtype=np.uint32)[TETRAHEDRON]
    assert not is_closed(np.concatenate([TETRAHEDRON, beside]))


def test_edges_are_those_of_all_faces() -> None:
    assert edges_of(TETRAHEDRON[:1]).tolist() == [[0, 2], [2, 1], [1, 0]]


def test_vertices_that_rounding_puts_at_one_position_are_parted() -> None:
    ball = trimesh.creation.icosphere(2)
    vertices, faces = np.array(ball.vertices), np.asarray(ball.faces, dtype=np.uint32)
    vertices[0] = vertices[faces[0, 1]] * (1 - 1e-9)
    far = vertices + np.array([8.0, 0, 0])
    assert len(np.unique(far.astype(np.float32), axis=0)) < len(far)
    parted = part(far, faces)
    assert parted is not None
    assert len(np.unique(parted, axis=0)) == len(far)
    np.testing.assert_allclose(parted, far, atol=1e-5)


def test_vertices_that_are_apart_are_only_rounded() -> None:
    parted = part(CORNERS.astype(np.float64) * 3.3, TETRAHEDRON)
    assert parted is not None
    np.testing.assert_array_equal(parted, (CORNERS.astype(np.float64) * 3.3).astype(np.float32))


def test_what_rounding_leaves_no_form_of_is_not_parted() -> None:
    ball = trimesh.creation.icosphere(2)
    far = 1e-5 * np.asarray(ball.vertices) + 10.0
    assert part(far, np.asarray(ball.faces, dtype=np.uint32)) is None
