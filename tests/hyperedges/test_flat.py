"""Hyperedges in one plane."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any, Literal

import numpy as np
import pytest

from app.formats import registry
from app.layout import Layout, lay_out
from app.settings import Settings

EXAMPLES = Path(__file__).parents[2] / "examples"


def laid(name: str, **wishes: Any) -> Layout:
    document = json.loads((EXAMPLES / name).read_bytes())
    document["layout"] = wishes
    return lay_out(registry.read("tubeloom", json.dumps(document).encode(), Settings()))


@pytest.mark.parametrize("name", ["hello.json", "id3-clause-2.json", "shapes.json"])
@pytest.mark.parametrize("curves", ["steiner", "prose", "symbolic"])
def test_all_curves_are_in_one_plane_above_the_items(
    name: str, curves: Literal["steiner", "prose", "symbolic"]
) -> None:
    flat = laid(name, dimensions=2, curves=curves)
    (height,) = np.unique(flat.routing.control_points[..., 2])
    assert np.all(flat.routing.join_planes == height)
    assert np.all(flat.routing.join_positions[:, 2] == height)
    tops = flat.placement.centers[:, 2]
    assert np.all(height > tops)


@pytest.mark.parametrize("name", ["hello.json", "id3-clause-2.json"])
def test_there_are_the_same_attachments_and_joins_as_in_space(name: str) -> None:
    flat, space = laid(name, dimensions=2), laid(name)
    assert np.array_equal(flat.routing.attachment_counts, space.routing.attachment_counts)
    starts = np.diff(flat.routing.segment_starts)
    assert np.array_equal(starts, 2 * flat.routing.attachment_counts - 3)


def test_curves_end_at_attachments_and_are_smooth_at_joins() -> None:
    flat = laid("id3-clause-2.json", dimensions=2)
    routing, starts = flat.routing, flat.placement.attachment_starts
    for k, count in enumerate(routing.attachment_counts.tolist()):
        for s in range(routing.segment_starts[k], routing.segment_starts[k + 1]):
            control = routing.control_points[s]
            for side, end in enumerate(routing.segment_ends[s].tolist()):
                place, handle = control[3 * side], control[1 + side]
                if end < count:
                    known = flat.placement.attachment_positions[starts[k] + end]
                    assert np.allclose(place, known)
                    continue
                join = routing.join_starts[k] + end - count
                assert np.allclose(place, routing.join_positions[join])
                way = (handle - place) / np.linalg.norm(handle - place)
                assert abs(way @ routing.join_tangents[join]) == pytest.approx(1.0)
