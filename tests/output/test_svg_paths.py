"""Contours as paths: near to what they follow, sharp where it is sharp, and short."""

from __future__ import annotations

import numpy as np
import pytest

from app.arrays import Floats
from app.output.svg_paths import TOLERANCE, path
from tests.output.svg_reader import contours


def circle(radius: float, count: int) -> Floats:
    turn = np.linspace(0, 2 * np.pi, count, endpoint=False)
    return 100 + radius * np.column_stack([np.cos(turn), np.sin(turn)])


@pytest.mark.parametrize("radius", [3.0, 40.0, 300.0])
def test_a_circle_becomes_a_few_curves(radius: float) -> None:
    data = path([circle(radius, 64)])
    (ring,) = contours(data)
    distances = np.hypot(*(ring - 100).T)
    assert np.abs(distances - radius).max() < 2 * TOLERANCE
    assert len(data) < 300


def test_corners_stay_where_they_are() -> None:
    arc = circle(50, 80)[:41]
    (ring,) = contours(path([arc]))
    for corner in (arc[0], arc[-1]):
        assert np.hypot(*(ring - corner).T).min() < 0.01
    # The straight side between them is straight.
    assert ring[:, 1].min() > 100 - 2 * TOLERANCE


def test_a_polygon_keeps_its_vertices() -> None:
    square = np.array([[0.0, 0.0], [10.25, 0.0], [10.25, 7.5], [0.0, 7.5]])
    assert path([square]) == "M0 0l10.25 0 0 7.5 -10.25 0z"


def test_a_line_is_not_closed() -> None:
    assert path([np.array([[1.0, 2.0], [3.0, 2.5]])], closed=False) == "M1 2l2 .5"


def test_nothing_is_nothing() -> None:
    assert path([]) == ""
