"""How a picture is taken: projection, supersampling, and tiles where it is too large for one go."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TypeAlias, TypeVar

import numpy as np
from numpy.typing import NDArray

from app.arrays import Floats, Singles
from app.output.draft_scene import Normalization
from app.scene.scene import Camera

Value = TypeVar("Value", bound=np.generic)

Uniform: TypeAlias = int | float | Floats
"""What a shader is told of one thing: a number, a vector, a matrix, or a list of vectors."""

Pixels: TypeAlias = NDArray[np.uint8]
"""(height, width, 4), from top to bottom: sRGB multiplied by opacity, and opacity."""

SAMPLES, MOST_SIDE = 4, 1280
"""Samples in a pixel, and the pixels along a side that are drawn at once: some 100 MB."""

LARGEST_SAMPLED = 1 << 23
"""Pixels of pictures that are drawn with several samples; larger ones will be seen smaller."""


@dataclass(frozen=True, slots=True, eq=False)
class Frame:
    """What of the world is seen: matrices (4, 4) to the camera, and on to the picture.

    ``eye`` is (position, 1) of a perspective camera, (direction toward it, 0) of another.
    """

    view: Floats
    projection: Floats
    eye: Floats

    def window(self, left: float, top: float, right: float, bottom: float) -> Frame:
        """Only this part of the picture, each from 0 to 1, enlarged to the whole.

        >>> whole = Frame(np.eye(4), np.eye(4), np.zeros(4))
        >>> whole.window(0.5, 0, 1, 0.5).projection @ [0.5, 0.5, 0, 1]
        array([0., 0., 0., 1.])
        """
        scale_x, scale_y = 1 / (right - left), 1 / (bottom - top)
        part = np.diag([scale_x, scale_y, 1.0, 1.0])
        part[:2, 3] = (1 - left - right) * scale_x, (top + bottom - 1) * scale_y
        return Frame(self.view, part @ self.projection, self.eye)

    def numbers(self, size: tuple[int, int]) -> dict[str, Uniform]:
        """What shaders must know, for a picture of ``size`` (width, height)."""
        return {
            "to_clip": self.projection @ self.view,
            "to_world": self._from_window(size),
            "eye": self.eye,
            "pixel": 2.0 / (size[1] * float(self.projection[1, 1])),
            "depth_rows": self.projection[2:, 2:].reshape(4),
        }

    def ground_depths(self, height: float, size: tuple[int, int]) -> Floats:
        """(a, b, c, is it seen): depths of the ground are (a, b, c)·(x, y, 1) in the window.

        A plane is one in the window too, whatever the projection.
        """
        a, b, c, d = np.array([0.0, 0.0, 1.0, -height]) @ self._from_window(size)
        above = self.eye[2] - self.eye[3] * height > 0.0
        if not above or abs(c) < 1e-12:
            return np.zeros(4)
        return np.array([-a / c, -b / c, -d / c, 1.0])

    def _from_window(self, size: tuple[int, int]) -> Floats:
        """Pixels and depth from 0 to 1, and 1, to places in the draft, but for a factor."""
        width, height = size
        to_clip = np.array(
            [[2 / width, 0, 0, -1], [0, 2 / height, 0, -1], [0, 0, 2, -1], [0, 0, 0, 1.0]]
        )
        return np.asarray(np.linalg.inv(self.projection @ self.view) @ to_clip)

    def distances(self, depths: Singles) -> Floats:
        """How far along its axis is what has these ``depths`` (…) from 0 to 1; for 1, infinite."""
        clip = 2.0 * depths.astype(np.float64) - 1.0
        # The projection's last two rows, solved for the distance: z and w are linear in it.
        (a, b), (c, d) = self.projection[2:, 2:]
        away = (b - clip * d) / (a - clip * c)
        return np.where(depths < 1.0, away, np.inf)


def frame(camera: Camera, normalization: Normalization, points: Floats, aspect: float) -> Frame:
    """What the camera sees of a scene whose corners ``points`` (p, 3) are in the draft's axes.

    Depth runs from the nearest to the farthest of them, whatever the camera's own range.
    """
    position = normalization.points(np.asarray(camera.position, dtype=np.float64))
    target = normalization.points(np.asarray(camera.target, dtype=np.float64))
    back = (position - target) / np.linalg.norm(position - target)
    right = np.cross(np.asarray(camera.up, dtype=np.float64), back)
    if np.linalg.norm(right) < 1e-9:  # looking along ``up``: any other up will do
        right = np.cross(np.roll(camera.up, 1), back)
    right /= np.linalg.norm(right)
    view = np.eye(4)
    view[:3, :3] = right, np.cross(back, right), back
    view[:3, 3] = -view[:3, :3] @ position
    depths = -(points @ view[2, :3] + view[2, 3])
    slack = 1e-3 + 0.01 * float(np.ptp(depths))
    near, far = float(depths.min()) - slack, float(depths.max()) + slack
    if camera.vertical_angle is not None:
        far = max(far, 2e-3)
        near = max(near, 1e-3 * far)
        projection = _shift(camera) @ _perspective(camera.vertical_angle, aspect, near, far)
        return Frame(view, projection, np.append(position, 1.0))
    if camera.height is None:
        raise ValueError("A camera has a vertical angle or a height.")
    height = camera.height / normalization.size
    projection = _shift(camera) @ _orthographic(height, aspect, near, far)
    return Frame(view, projection, np.append(back, 0.0))


def sampling(width: int, height: int) -> int:
    """How many samples in each pixel there is time for."""
    return SAMPLES if width * height <= LARGEST_SAMPLED else 1


@dataclass(frozen=True, slots=True)
class Tiling:
    """``columns`` by ``rows`` tiles of one size, in pixels, that cover a picture.

    The last may stand over its edge: a renderer likes to keep its size.
    """

    picture: tuple[int, int]
    columns: int
    rows: int
    width: int
    height: int

    def corners(self) -> Iterator[tuple[int, int]]:
        """Left and top of each tile, row by row."""
        for row in range(self.rows):
            for column in range(self.columns):
                yield column * self.width, row * self.height

    def frames(self, whole: Frame) -> Iterator[Frame]:
        """What each tile shows, row by row."""
        width, height = self.picture
        for left, top in self.corners():
            right, bottom = left + self.width, top + self.height
            yield whole.window(left / width, top / height, right / width, bottom / height)

    def joined(self, tiles: Sequence[NDArray[Value]]) -> NDArray[Value]:
        """The picture (height, width, …) of these tiles, row by row."""
        if len(tiles) == 1:
            return tiles[0]
        width, height = self.picture
        joined = np.empty((height, width, *tiles[0].shape[2:]), dtype=tiles[0].dtype)
        for (left, top), tile in zip(self.corners(), tiles, strict=True):
            place = joined[top : top + self.height, left : left + self.width]
            place[:] = tile[: place.shape[0], : place.shape[1]]
        return joined


def tiling(width: int, height: int, side: int) -> Tiling:
    """As few tiles as there can be with no side longer than ``side``.

    >>> tiling(5000, 100, 4096)
    Tiling(picture=(5000, 100), columns=2, rows=1, width=2500, height=100)
    """
    columns, rows = -(-width // side), -(-height // side)
    return Tiling((width, height), columns, rows, -(-width // columns), -(-height // rows))


def _shift(camera: Camera) -> Floats:
    """Moves the picture against the camera's shift."""
    moved = np.eye(4)
    moved[:2, 3] = np.negative(camera.shift)
    return moved


def _perspective(angle: float, aspect: float, near: float, far: float) -> Floats:
    focus = 1 / np.tan(angle / 2)
    return np.array(
        [
            [focus / aspect, 0, 0, 0],
            [0, focus, 0, 0],
            [0, 0, (far + near) / (near - far), 2 * far * near / (near - far)],
            [0, 0, -1, 0],
        ]
    )


def _orthographic(height: float, aspect: float, near: float, far: float) -> Floats:
    return np.array(
        [
            [2 / (height * aspect), 0, 0, 0],
            [0, 2 / height, 0, 0],
            [0, 0, -2 / (far - near), -(far + near) / (far - near)],
            [0, 0, 0, 1],
        ]
    )
