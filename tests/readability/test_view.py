"""Layouts as drawings, and from where they are seen best."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest

from app.layout import Layout, lay_out
from app.program.reading import read_program
from app.readability.drawing import Drawing, drawing_of
from app.readability.projection import directions
from app.readability.view import crossings_seen, fewest_crossings, readability
from app.settings import Settings
from tests.readability.views import ABOVE, seen_from


def laid(**document: Any) -> Layout:
    return lay_out(read_program(json.dumps(document).encode(), Settings()))


def drawn(**document: Any) -> Drawing:
    layout = laid(**document)
    return drawing_of(layout.routing, layout.placement)


def test_items_are_their_solids() -> None:
    block = {"type": "box", "size": [2, 1, 3]}
    drawing = drawn(
        items=[
            {"id": "a", "shape": block, "position": [5, 0, 2], "rotation": [0, 0, 90]},
            {"id": "b", "shape": {"type": "sphere", "radius": 0.5}, "position": [1, 2, 3]},
        ]
    )
    corners = drawing.triangles.corners.reshape(-1, 3)
    assert np.allclose(corners.min(axis=0), [4.5, -1.0, 0.5])
    assert np.allclose(corners.max(axis=0), [5.5, 1.0, 3.5])
    assert drawing.triangles.items.tolist() == [0] * 12
    areas = np.linalg.norm(
        np.cross(*np.diff(drawing.triangles.corners, axis=1).transpose(1, 0, 2)), axis=1
    )
    assert 0.5 * areas.sum() == pytest.approx(2 * (2 * 1 + 2 * 3 + 1 * 3))
    assert np.allclose(drawing.balls.centers, [[1.0, 2.0, 3.0]])
    assert np.allclose(drawing.balls.radii, [0.5])
    assert drawing.balls.items.tolist() == [1]


def test_labels_are_where_their_letters_are() -> None:
    layout = laid(items=[{"id": "a"}, {"id": "b", "label": "Name", "position": [4, 0, 0]}])
    labels = drawing_of(layout.routing, layout.placement).labels
    place = layout.placement.labels[1]
    assert place is not None
    assert labels.items.tolist() == [1]
    assert labels.sizes.tolist() == [list(place.size[:2])]
    assert np.allclose(labels.middles, layout.placement.centers[1] + place.position)


def two_bars(gap: float) -> Drawing:
    """Two straight pairs that cross as seen from above, one ``gap`` above the other."""
    ball = {"type": "sphere", "radius": 0.3}
    places = {"w": [-4, 0, 1], "e": [4, 0, 1], "s": [0, -4, 1 + gap], "n": [0, 4, 1 + gap]}
    toward = {"w": [1, 0, 0], "e": [-1, 0, 0], "s": [0, 1, 0], "n": [0, -1, 0]}
    return drawn(
        items=[
            {
                "id": name,
                "shape": ball,
                "position": at,
                "attachment_points": [
                    {
                        "id": "p",
                        "position": [0.3 * x for x in toward[name]],
                        "direction": toward[name],
                    }
                ],
            }
            for name, at in places.items()
        ],
        hyperedges=[
            {"id": pair, "attachments": [{"item": name, "point": "p"} for name in pair]}
            for pair in ("we", "sn")
        ],
        layout={"routing": "elastic"},
    )


def test_of_a_whole_layout() -> None:
    drawing = two_bars(3.0)
    above = readability(drawing, ABOVE)
    assert (above.crossings, above.acute) == (1, 0)
    # The upper tube, 0.16 wide, hides as much of the lower one, 7.4 long.
    assert np.allclose(above.hidden, [0.16 / 7.4, 0.0], atol=0.002)
    assert crossings_seen(drawing, seen_from(0.0, -1.0, 0.0)) == (0, 0)


def test_the_first_of_the_views_with_the_fewest_crossings() -> None:
    drawing = two_bars(3.0)
    beside = seen_from(0.0, -1.0, 0.0)
    assert fewest_crossings(drawing, [ABOVE, beside, beside]) == 1
    views = [seen_from(x, y, z) for x, y, z in directions(20).tolist()]
    best = fewest_crossings(drawing, views)
    assert crossings_seen(drawing, views[best]) == (0, 0)


def test_items_that_are_letters_are_labels() -> None:
    text = {"id": "t", "label": "read me", "shape": {"type": "text"}, "position": [0, 0, 0]}
    roof = {"id": "r", "shape": {"type": "box", "size": [9, 9, 1]}, "position": [0, 0, 5]}
    shares = [
        readability(drawn(items=items), ABOVE).free_labels for items in ([text], [text, roof])
    ]
    assert shares == [1.0, 0.0]
