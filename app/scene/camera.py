"""The camera: as near as lets the whole scene be seen, with the picture centred."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import TypeAlias

import numpy as np

from app.arrays import Floats
from app.placement.modes import Mode
from app.program.model import Program, View
from app.scene.scene import Camera

VIEWS: Mapping[Mode, tuple[float, float, float]] = MappingProxyType(
    {
        "rows": (0.2, -1.0, 1.0),
        "layers": (0.12, -1.0, 0.2),
        "ground": (0.2, -1.0, 1.0),
        "sheet": (0.1, -1.0, 0.25),
        "space": (0.2, -1.0, 0.6),
    }
)
"""Directions from the scene to the camera, where the document gives none."""

Farthest: TypeAlias = Callable[[Floats], Floats]
"""Answers which point (3,) of something lies farthest along a direction (3,)."""

NEAREST = 0.01
"""Of the scene's size: how near the camera comes to it, even where a wide angle would let it."""

SHORTEST = 0.05
"""Of the way to the scene: where the camera begins to see, though the ground may be nearer."""

POINT = 1e-6
"""Size, in document units, of what counts as a point: no document has so small an item."""

ALONE = 1.0
"""Size, in document units, of what is seen of a scene that has none."""


@dataclass(frozen=True, slots=True, eq=False)
class Axes:
    """The camera's own axes, unit vectors (3,): to the right, up, and back from the scene."""

    right: Floats
    up: Floats
    back: Floats


def axes_from(direction: tuple[float, float, float]) -> Axes:
    """Axes of a camera that sees the scene from ``direction``, with z up in the picture.

    Seen from straight above or below, +y is up; the zero direction counts as the default one.
    """
    reached = float(np.abs(direction).max())
    if reached == 0.0:
        return axes_from(VIEWS["rows"])
    back = np.array(direction) / reached
    back /= np.linalg.norm(back)
    steep = float(np.hypot(back[0], back[1])) < 1e-6
    right = np.cross([0.0, 1.0, 0.0] if steep else [0.0, 0.0, 1.0], back)
    right /= np.linalg.norm(right)
    return Axes(right, np.cross(back, right), back)


def axes_of(view: View) -> Axes:
    """Axes of the camera of a view; of one that does not say from where, the usual ones."""
    return axes_from(view.from_ or VIEWS["rows"])


def view_of(program: Program, mode: Mode) -> View:
    """The view that a program is seen in, which says from where.

    It is its own, or that of its placement's ``mode``; but a flat drawing is seen from straight
    above. Its projection and direction then say nothing; margin and the rest stay as they are.
    Layers are seen without perspective, unless the program says from where.
    """
    if program.layout.dimensions == 3:
        if program.view.from_ is not None:
            return program.view
        usual: dict[str, object] = {"from_": VIEWS[mode]}
        if mode == "layers":
            usual["projection"] = "orthographic"
        return program.view.model_copy(update=usual)
    return program.view.model_copy(update={"projection": "orthographic", "from_": (0.0, 0.0, 1.0)})


def frame(
    farthest: Farthest | None, view: View, aspect: float, ground: Farthest | None = None
) -> Camera:
    """The camera that ``view`` wishes for, in a picture of ``aspect``.

    What ``farthest`` knows (``None`` where there is nothing) keeps the margin and touches it on
    both sides, left and right or above and below. The ``ground`` is seen too, but not framed.
    """
    axes = axes_of(view)
    scene = _Scene.seen(farthest or _ball(np.zeros(3)), axes)
    if scene.size < POINT:
        scene = _Scene.seen(_ball(scene.farthest(axes.back)), axes)
    inside = 1.0 - 2.0 * view.margin
    if view.projection == "orthographic":
        return _orthographic(scene, inside, aspect, ground)
    return _perspective(scene, inside, aspect, float(np.radians(view.field_of_view)), ground)


def _ball(center: Floats) -> Farthest:
    """What is framed instead of nothing, or of a mere point."""
    return lambda direction: center + 0.5 * ALONE * direction / np.linalg.norm(direction)


@dataclass(frozen=True, slots=True, eq=False)
class _Scene:
    """How far the scene reaches in a camera's axes: from where to where to the right, up, back."""

    farthest: Farthest
    axes: Axes
    width: tuple[float, float]
    height: tuple[float, float]
    depth: tuple[float, float]

    @staticmethod
    def seen(farthest: Farthest, axes: Axes) -> _Scene:
        width, height, depth = (
            _extent(farthest, axis) for axis in (axes.right, axes.up, axes.back)
        )
        return _Scene(farthest, axes, width, height, depth)

    @property
    def size(self) -> float:
        """The longest of its extents."""
        return max(high - low for low, high in (self.width, self.height, self.depth))

    def along(self, across: Floats, slope: float) -> tuple[float, float]:
        """How far along ``across + slope · back``, and how far back the vertex is that does."""
        direction = across + slope * self.axes.back
        point = self.farthest(direction)
        return float(point @ direction), float(point @ self.axes.back)


def _extent(farthest: Farthest, axis: Floats) -> tuple[float, float]:
    """From where to where something reaches along a unit axis."""
    return float(farthest(-axis) @ axis), float(farthest(axis) @ axis)


def _perspective(
    scene: _Scene, inside: float, aspect: float, angle: float, ground: Farthest | None
) -> Camera:
    """A vertex at x across and z back is seen while |x - camera's x| ≤ slope · (distance - z).

    So where the scene reaches along x + slope · z and along -x + slope · z decides how near the
    camera may come: a linear condition for each side of the picture.
    """
    axes = scene.axes
    slope_up = float(np.tan(angle / 2)) * inside
    sides = ((axes.right, slope_up * aspect), (axes.up, slope_up))
    distance = scene.depth[1] + NEAREST * scene.size
    for across, slope in sides:
        reached = scene.along(across, slope)[0] + scene.along(-across, slope)[0]
        distance = max(distance, reached / (2 * slope))
    right, up = (_centered(scene, across, slope, distance) for across, slope in sides)
    depth = _range(scene, distance, ground)
    return _camera(scene, aspect, (right, up, distance), depth, vertical_angle=angle)


def _centered(scene: _Scene, across: Floats, slope: float, distance: float) -> float:
    """Where along ``across`` a camera at ``distance`` has as much room on both sides.

    Narrows the picture until the scene touches both its sides. What is left then, the sum of
    both reaches less the width, is convex and piecewise linear in the slope: Newton ends.
    """
    for _ in range(50):
        one, one_depth = scene.along(across, slope)
        other, other_depth = scene.along(-across, slope)
        change = (one + other - 2 * distance * slope) / (2 * distance - one_depth - other_depth)
        slope += change
        if abs(change) <= 1e-13 * abs(slope):
            break
    return (one - other) / 2


def _orthographic(scene: _Scene, inside: float, aspect: float, ground: Farthest | None) -> Camera:
    (left, right), (bottom, top) = scene.width, scene.height
    # Seen from the side, something flat and upright has no width.
    height = max(top - bottom, (right - left) / aspect, 1e-6 * scene.size) / inside
    nearest = scene.depth[1]
    if ground is not None:
        nearest = max(nearest, _extent(ground, scene.axes.back)[1])
    distance = nearest + scene.size
    place = ((left + right) / 2, (bottom + top) / 2, distance)
    return _camera(scene, aspect, place, _range(scene, distance, ground), height=height)


def _range(scene: _Scene, distance: float, ground: Farthest | None) -> tuple[float, float]:
    """From where to where a camera at ``distance`` must see, with a little room."""
    low, high = scene.depth
    near, far = distance - high, distance - low
    shortest = SHORTEST * near
    if ground is not None:
        below, above = _extent(ground, scene.axes.back)
        near, far = min(near, distance - above), max(far, distance - below)
    return max(0.9 * near, shortest), 1.1 * far


def _camera(
    scene: _Scene,
    aspect: float,
    place: tuple[float, float, float],
    depth: tuple[float, float],
    *,
    vertical_angle: float | None = None,
    height: float | None = None,
) -> Camera:
    """A camera at ``place`` (right, up, back) that sees from ``depth[0]`` to ``depth[1]``.

    It looks at where its axis passes the middle of the scene's depth.
    """
    axes = scene.axes
    right, up, distance = place
    position = right * axes.right + up * axes.up + distance * axes.back
    target = position - (distance - sum(scene.depth) / 2) * axes.back
    return Camera(
        position=_triple(position),
        target=_triple(target),
        up=_triple(axes.up),
        aspect=aspect,
        near=depth[0],
        far=depth[1],
        vertical_angle=vertical_angle,
        height=height,
    )


def _triple(vector: Floats) -> tuple[float, float, float]:
    x, y, z = vector.tolist()
    return x, y, z
