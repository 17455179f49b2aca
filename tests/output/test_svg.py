"""Line drawings, read as XML and compared with a z-buffer."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any
from xml.etree import ElementTree as ET

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import cKDTree

from app.arrays import Floats
from app.errors import InvalidDocument
from app.output.depth_buffer import depths_of
from app.output.projection import Projection
from app.output.svg import write_svg
from app.output.svg_bands import Lines
from app.program.reading import read_program
from app.settings import Settings
from app.staging import Staged, stage

EXAMPLES = Path(__file__).parents[2] / "examples"
SVG = "{http://www.w3.org/2000/svg}"
WIDTH, HEIGHT = 1024, 768

ENDS = (("a", -1), ("b", 1))


def staged(document: dict[str, Any] | bytes) -> Staged:
    data = document if isinstance(document, bytes) else json.dumps(document).encode()
    return stage(read_program(data, Settings()), WIDTH / HEIGHT, height=HEIGHT)


def drawing(found: Staged) -> bytes:
    laid = found.layout
    return write_svg(laid.program, laid.placement, laid.routing, found.scene, WIDTH, HEIGHT)


@pytest.fixture(scope="module")
def clause() -> Staged:
    return staged((EXAMPLES / "id3-clause-2.json").read_bytes())


def test_a_drawing_is_small_and_the_same_again(clause: Staged) -> None:
    first = drawing(clause)
    assert len(first) < 200_000
    assert first == drawing(clause)


def test_every_item_and_hyperedge_is_a_group_with_classes_and_a_title(clause: Staged) -> None:
    root = ET.fromstring(drawing(clause))
    groups = {group.get("data-id"): group for group in root.iter(f"{SVG}g")}
    program = clause.layout.program
    for item in program.items:
        assert groups[item.id].get("class") == f"item kind-{item.kind}"
        title = groups[item.id].find(f"{SVG}title")
        assert title is not None
        assert title.text == (item.label or item.id)
    for hyperedge in program.hyperedges:
        assert "hyperedge" in (groups[hyperedge.id].get("class") or "")
    ids = [group.get("id") for group in groups.values()]
    assert len(set(ids)) == len(ids)


def test_contents_stand_within_what_contains_them(clause: Staged) -> None:
    root = ET.fromstring(drawing(clause))
    parents = {child: parent for parent in root.iter() for child in parent}
    for group in root.iter(f"{SVG}g"):
        item = next((i for i in clause.layout.program.items if i.id == group.get("data-id")), None)
        if item is not None and item.parent is not None:
            assert parents[group].get("data-id") == item.parent


def test_labels_are_text(clause: Staged) -> None:
    texts = {text.text for text in ET.fromstring(drawing(clause)).iter(f"{SVG}text")}
    assert {"Best Attribute", "Values", "node"} <= texts


def test_no_line_is_drawn_that_something_hides(clause: Staged) -> None:
    projection = Projection.of(clause.scene.camera, WIDTH, HEIGHT)
    whole = depths_of(clause.scene, projection, frozenset({"item", "hyperedge"}))
    lines = Lines.of(clause.layout.routing, projection)
    owners = lines.hyperedges[lines.segments]
    groups = {group.get("data-id"): group for group in ET.fromstring(drawing(clause)).iter()}
    behind: list[bool] = []
    for number, hyperedge in enumerate(clause.layout.program.hyperedges):
        mine = np.flatnonzero(owners == number)
        tree = cKDTree(lines.places[mine, :2])
        drawn = np.concatenate([points(path) for path in groups[hyperedge.id] if is_side(path)])
        away, near = tree.query(drawn, k=2)
        assert (away[:, 0] < 2 * lines.halves[mine[near[:, 0]]] + 1).all()
        # What is seen along the middle line is the tube's own front, or else something hides it;
        # a line may end between a place that is seen and one that is not.
        middle = lines.places[mine[near]]
        column, row = middle[..., 0].astype(int), middle[..., 1].astype(int)
        hidden = middle[..., 2] - whole[row, column] > 3 * lines.radii[mine[near]]
        behind.extend(hidden.all(axis=1))
    sample = np.random.default_rng(1).choice(behind, 1000)
    assert sample.mean() < 0.005


def is_side(path: ET.Element) -> bool:
    return path.get("class") == "side"


def points(path: ET.Element) -> Floats:
    """All corners of the lines of a path, (n, 2)."""
    found = []
    for line in (path.get("d") or "").split("M")[1:]:
        begin, _, steps = line.partition("l")
        corners = [begin, *steps.removesuffix("z").split()]
        found.append(np.cumsum([[float(x) for x in pair.split(",")] for pair in corners], axis=0))
    return np.concatenate(found)


@pytest.mark.parametrize(("style", "dashed"), [("removed", False), ("dashed", True)])
def test_lines_behind_something_are_removed_or_dashed(style: str, dashed: bool) -> None:
    wall = {"id": "wall", "shape": {"type": "box", "size": [6, 0.2, 4]}, "position": [0, -3, 2]}
    document = {
        "items": [wall, *({"id": name, "position": [x, 0, 0.2]} for name, x in ENDS)],
        "hyperedges": [{"id": "e", "attachments": [{"item": name} for name, _ in ENDS]}],
        "view": {"from": [0, -1, 0.3]},
        "style": {"hidden_lines": style},
    }
    root = ET.fromstring(drawing(staged(document)))
    group = next(g for g in root.iter(f"{SVG}g") if g.get("data-id") == "e")
    assert any(path.get("class") == "hidden" for path in group) == dashed
    assert not any(path.get("class") == "side" for path in group)


def test_halos_are_gaps_in_what_passes_behind() -> None:
    ends = {"a": [-3, 0, 0.2], "b": [3, 0, 0.2], "c": [0, -3, 0.2], "d": [0, 3, 0.2]}
    document = {
        "items": [{"id": name, "position": place} for name, place in ends.items()],
        "hyperedges": [
            {"id": "one", "attachments": [{"item": "a"}, {"item": "b"}], "join_height": 1.0},
            {"id": "two", "attachments": [{"item": "c"}, {"item": "d"}], "join_height": 3.0},
        ],
        "view": {"from": [0.1, -0.2, 1]},
    }
    counts = []
    for halo in (0.0, 1.0):
        root = ET.fromstring(drawing(staged({**document, "style": {"halo": halo}})))
        group = next(g for g in root.iter(f"{SVG}g") if g.get("data-id") == "one")
        fills = [path for path in group if path.get("fill")]
        counts.append(sum(len(path.get("d") or "") for path in fills))
    assert counts[1] < counts[0]


hostile = st.text(st.characters(exclude_categories=["Cs"]), min_size=1, max_size=12)


@settings(max_examples=40, deadline=None)
@given(hostile, hostile)
def test_nothing_in_a_document_breaks_out(identity: str, label: str) -> None:
    document = {
        "items": [{"id": identity, "label": label + '"><script>alert(1)</script>'}],
        "name": "</title><script>",
    }
    try:
        found = staged(document)
    except InvalidDocument:  # there are ids that documents may not have
        return
    root = ET.fromstring(drawing(found))
    assert not list(root.iter(f"{SVG}script"))
    assert re.search(rb"<script", drawing(found)) is None


def test_a_flat_drawing_has_all_curves_in_one_plane_and_looks_from_above() -> None:
    document = json.loads((EXAMPLES / "id3-clause-2.json").read_bytes())
    document["layout"] = {"dimensions": 2}
    found = staged(document)
    curves = found.layout.routing.control_points
    assert np.ptp(curves[..., 2]) < 1e-9
    assert found.scene.camera.height is not None
    away = np.subtract(found.scene.camera.position, found.scene.camera.target)
    assert away[2] == pytest.approx(np.linalg.norm(away))
    usual = staged((EXAMPLES / "id3-clause-2.json").read_bytes()).layout.routing
    assert (found.layout.routing.attachment_counts == usual.attachment_counts).all()
    texts = {text.text for text in ET.fromstring(drawing(found)).iter(f"{SVG}text")}
    assert {"node", "Best Attribute", "Es"} <= texts
