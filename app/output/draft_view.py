"""How a picture is taken: projection, supersampling, and tiles where it is too large for one go."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from app.arrays import Floats
from app.output.draft_scene import Normalization
from app.scene.scene import Camera

Pixels: TypeAlias = NDArray[np.uint8]
"""(height, width, 4), from top to bottom: sRGB multiplied by opacity, and opacity."""

ALWAYS_DOUBLED, LARGEST_DOUBLED = 1 << 20, 1 << 22
"""Pixels of pictures that are drawn at twice their size: always, and if it is the cheaper way."""

MOST_SAMPLED = 1 << 20
"""Triangles that are drawn with four samples to a pixel into pictures beyond these."""


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


@dataclass(frozen=True, slots=True)
class Sampling:
    """How edges become smooth: drawn ``scale`` times as large, with ``samples`` in a pixel.

    ``tile_side`` is the most pixels along a side that are drawn at once.
    """

    scale: int
    samples: int
    tile_side: int


PLAIN = Sampling(scale=1, samples=1, tile_side=4096)
DOUBLED = Sampling(scale=2, samples=1, tile_side=4096)
SAMPLED = Sampling(scale=1, samples=4, tile_side=2048)
"""Tiles take 128 MB, and are of a size that any OpenGL draws."""


def sampling(width: int, height: int, triangles: int) -> Sampling:
    """The smoothest that a picture of this size, of this many triangles, has time for.

    Drawing at twice the size is the smoother, inside of edges too, and costs by the pixel; four
    samples cost by the triangle. (In software, beyond a plain picture: 0.6 microseconds for each
    pixel of the one, 2 for each triangle of the other.) A picture that is large in both ways is
    left as it is, to be smooth when seen smaller.
    """
    pixels = width * height
    if pixels <= ALWAYS_DOUBLED or (pixels <= LARGEST_DOUBLED and 4 * triangles > pixels):
        return DOUBLED
    if pixels <= LARGEST_DOUBLED or triangles <= MOST_SAMPLED:
        return SAMPLED
    return PLAIN


@dataclass(frozen=True, slots=True)
class Tiling:
    """``columns`` by ``rows`` tiles of one size, in pixels, that cover a picture.

    The last may stand over its edge: a renderer likes to keep its size.
    """

    columns: int
    rows: int
    width: int
    height: int

    def corners(self) -> Iterator[tuple[int, int]]:
        """Left and top of each tile, row by row."""
        for row in range(self.rows):
            for column in range(self.columns):
                yield column * self.width, row * self.height


def tiling(width: int, height: int, side: int) -> Tiling:
    """As few tiles as there can be with no side longer than ``side``.

    >>> tiling(5000, 100, 4096)
    Tiling(columns=2, rows=1, width=2500, height=100)
    """
    columns, rows = -(-width // side), -(-height // side)
    return Tiling(columns, rows, -(-width // columns), -(-height // rows))


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
