import numpy as np
import pytest

from app.arrays import Floats
from app.placement.turning import Vector, then, turned
from app.scene.scene import Camera
from app.staging import make_scene
from tests.placement.test_place import example

WIDTH, HEIGHT = 1024, 768


def pixels(camera: Camera, points: Floats) -> Floats:
    """Where ``points`` (n, 3) are in a picture of ``HEIGHT`` pixels, about its middle."""
    assert camera.vertical_angle is not None
    ahead = np.subtract(camera.target, camera.position)
    ahead /= np.linalg.norm(ahead)
    right = np.cross(ahead, camera.up)
    right /= np.linalg.norm(right)
    seen = points - np.array(camera.position)
    focus = HEIGHT / 2 / np.tan(camera.vertical_angle / 2)
    across = np.stack([seen @ right, seen @ np.cross(right, ahead)], axis=1)
    return np.asarray(focus * across / (seen @ ahead)[:, None])


@pytest.mark.parametrize("name", ["id3-clause-1", "id3-clause-2"])
def test_capitals_are_nine_pixels_high_in_a_picture_of_the_papers_program(name: str) -> None:
    program, made = example(name)
    camera = make_scene(program, WIDTH / HEIGHT).camera
    for label, center, rotation in zip(made.labels, made.centers, made.rotations, strict=True):
        if label is None:
            continue
        x, y, z, w = rotation.tolist()
        turn = (x, y, z, w)
        middle = center + turned(turn, label.position)
        up: Vector = (0.0, label.text.height / 2, 0.0)
        half = np.array(turned(then(turn, label.rotation), up))
        bottom, top = pixels(camera, np.stack([middle - half, middle + half]))
        assert np.hypot(*(top - bottom)) >= 9
