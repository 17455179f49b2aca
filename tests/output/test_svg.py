"""Line drawings: what is in them, who hides whom, and how they look to a browser."""

from __future__ import annotations

import base64
import io
import json
import re
import xml.etree.ElementTree as ET
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given
from hypothesis import settings as wishes
from hypothesis import strategies as st
from PIL import Image

from app.errors import TubeloomError
from app.output.draft import depths, draft_problem
from app.output.svg_markup import name
from app.output.svg_projection import Projection
from app.output.svg_raster import foremost
from app.placement.turning import matrices
from app.scene.scene import Scene
from tests.conftest import require
from tests.output.browser import page_of
from tests.output.svg_reader import (
    EXAMPLES,
    HEIGHT,
    SVG,
    WIDTH,
    drawn,
    groups,
    painted,
    strokes,
)
from tests.program.documents import documents

CLAUSE = (EXAMPLES / "id3-clause-2.json").read_bytes()


def document(**parts: Any) -> bytes:
    return json.dumps({"items": [{"id": "a", "label": "A"}], **parts}).encode()


def with_wishes(data: bytes, **wished: dict[str, Any]) -> bytes:
    return json.dumps({**json.loads(data), **wished}).encode()


@pytest.fixture(scope="module")
def clause() -> bytes:
    return drawn(CLAUSE)[1]


def test_every_item_and_hyperedge_is_one_group_that_names_itself(clause: bytes) -> None:
    program = json.loads(CLAUSE)
    found = {group.attrib["data-id"]: group for group in groups(clause)}
    assert len(groups(clause)) == len(found) == len(program["items"]) + len(program["hyperedges"])
    for shows, parts in (("item", program["items"]), ("hyperedge", program["hyperedges"])):
        for part in parts:
            group = found[part["id"]]
            assert group.attrib["class"].split() == [shows, name("kind", part["kind"])]
            assert group.findtext(f"{SVG}title") == part.get("label", part["id"])


def test_labels_are_text(clause: bytes) -> None:
    labels = [item["label"] for item in json.loads(CLAUSE)["items"] if "label" in item]
    assert sorted(text.text or "" for text in ET.fromstring(clause).iter(f"{SVG}text")) == sorted(
        labels
    )


def test_it_says_what_it_is(clause: bytes) -> None:
    root = ET.fromstring(clause)
    assert root.attrib["role"] == "img"
    assert root.attrib["viewBox"] == f"0 0 {WIDTH} {HEIGHT}"
    ids = [element.attrib["id"] for element in root.iter() if "id" in element.attrib]
    assert len(ids) == len(set(ids))
    assert set(root.attrib["aria-labelledby"].split()) <= set(ids)
    assert root.findtext(f"{SVG}title") == "ID3 Tree, clause 2"


def test_it_is_small_and_always_the_same(clause: bytes) -> None:
    assert len(clause) < 120_000
    assert drawn(CLAUSE)[1] == clause


def test_numbers_have_two_decimals_at_most(clause: bytes) -> None:
    for path in ET.fromstring(clause).iter(f"{SVG}path"):
        assert not re.search(r"\.\d{3}", path.attrib["d"])
        assert "e" not in path.attrib["d"]


# What is behind a tube shows in its gaps: as if it were not there.
WHOLE = {"halo": 0}
PICTURES = {
    "clause": CLAUSE,
    "clause from the side": with_wishes(CLAUSE, view={"from": [1, -1, 0.25]}, style=WHOLE),
    "clause, orthographic": with_wishes(CLAUSE, view={"projection": "orthographic"}, style=WHOLE),
    "shapes": with_wishes((EXAMPLES / "shapes.json").read_bytes(), style=WHOLE),
    "csg": with_wishes((EXAMPLES / "csg.json").read_bytes(), style=WHOLE),
}


def nearest(scene: Scene, number: int) -> np.ndarray[Any, Any]:
    """How far away one node alone is, at each pixel, by the mesh that other pictures show."""
    node, view = scene.nodes[number], Projection.of(scene.camera, WIDTH, HEIGHT)
    mesh, turn = node.primitives[0].mesh, matrices(np.array(node.rotation))
    seen = view.seen(mesh.vertices @ turn.T + np.array(node.translation))
    triangles = seen[mesh.faces.astype(np.int64)]
    found = foremost(triangles, np.zeros(len(triangles), dtype=np.int64), WIDTH, HEIGHT).nearness
    with np.errstate(divide="ignore"):
        return np.asarray(1 / np.maximum(found, 0) if view.is_perspective else -found)


@pytest.mark.parametrize("picture", PICTURES)
def test_no_line_shows_that_should_be_hidden(picture: str) -> None:
    require(draft_problem() is None, "No OpenGL.")
    staged, svg = drawn(PICTURES[picture])
    program, scene = staged.layout.program, staged.scene
    # Letters of labels are text here.
    bodies = tuple(replace(node, primitives=node.primitives[:1]) for node in scene.nodes)
    depth = depths(replace(scene, nodes=bodies), WIDTH, HEIGHT)
    fills, names = painted(svg)
    numbers = {name("item", item.id): number for number, item in enumerate(program.items)}
    for number, hyperedge in enumerate(program.hyperedges):
        numbers[name("hyperedge", hyperedge.id)] = len(program.items) + number
    places, owners = _on_lines(svg, names)
    is_visible = np.array(
        [
            bool((_window(fills, place * 2, 2) == owner + 1).any())
            for place, owner in zip(places, owners, strict=True)
        ]
    )
    places, owners = places[is_visible][:1000], owners[is_visible][:1000]
    assert len(places) == 1000
    alone = {owner: nearest(scene, numbers[names[owner]]) for owner in set(owners.tolist())}
    wrong = [
        (names[owner], place.round().tolist())
        for place, owner in zip(places, owners, strict=True)
        # Something else is in front all around, of whatever is there of its own.
        if _window(depth, place, 3).max() < _window(alone[owner], place, 3).min() - 0.05
        and np.isfinite(_window(alone[owner], place, 3).min())
    ]
    assert not wrong


def _on_lines(svg: bytes, names: list[str]) -> tuple[np.ndarray[Any, Any], np.ndarray[Any, Any]]:
    """Places (n, 2) on lines and edges, and whose they are (n,), in a random order."""
    places, owners = [], []
    for stroke in strokes(svg):
        if not stroke.is_stroked and "edge" not in stroke.classes:
            continue
        for contour in stroke.contours:
            ends = np.roll(contour, -1, axis=0) if stroke.is_filled else contour[1:]
            for begin, end in zip(contour, ends, strict=False):
                steps = max(int(np.hypot(*(end - begin)) / 4), 1)
                places += [begin + (end - begin) * (step + 0.5) / steps for step in range(steps)]
                owners += [names.index(stroke.owner)] * steps
    order = np.random.default_rng(4).permutation(len(places))[:6000]
    return np.array(places)[order], np.array(owners)[order]


def _window(
    grid: np.ndarray[Any, Any], place: np.ndarray[Any, Any], reach: int
) -> np.ndarray[Any, Any]:
    x, y = np.clip(np.floor(place).astype(int), 0, np.array(grid.shape)[::-1] - 1)
    return grid[max(y - reach, 0) : y + reach + 1, max(x - reach, 0) : x + reach + 1]


def test_a_tube_in_front_leaves_a_gap_in_the_one_behind() -> None:
    data = {
        "items": [
            {"id": name, "position": [x, y, 0]}
            for name, x, y in (("w", -3, 0), ("e", 3, 0), ("s", 0, -3), ("n", 0, 3))
        ],
        "hyperedges": [
            {"id": "low", "attachments": [{"item": "w"}, {"item": "e"}], "join_height": 2},
            {"id": "high", "attachments": [{"item": "s"}, {"item": "n"}], "join_height": 4},
        ],
        "view": {"from": [0, 0, 1], "projection": "orthographic"},
    }

    def parts(halo: float) -> dict[str, int]:
        wished = {**data, "style": {"halo": halo}}
        svg = drawn(json.dumps(wished).encode())[1]
        return {
            stroke.owner: len(stroke.contours)
            for stroke in strokes(svg)
            if stroke.classes == "edge"
        }

    def gap(halo: float) -> float:
        svg = drawn(json.dumps({**data, "style": {"halo": halo}}).encode())[1]
        (low,) = (s for s in strokes(svg) if s.owner == "hyperedge-low" and s.classes == "edge")
        one, other = sorted(low.contours, key=lambda ring: float(ring[:, 0].min()))
        return float(other[:, 0].min() - one[:, 0].max())

    assert parts(0.5) == {"hyperedge-low": 2, "hyperedge-high": 1}
    assert gap(0.5) / gap(0.0) == pytest.approx(1.5, rel=0.02)


def test_hidden_lines_are_dashed_where_that_is_wished() -> None:
    svg = drawn(with_wishes(CLAUSE, style={"hidden_lines": "dashed"}))[1]
    dashed = [path for path in ET.fromstring(svg) if "hidden" in path.get("class", "")]
    assert {path.attrib["data-of"] for path in dashed} > {"e.A", "e.Rest", "c2"}
    assert all(path.get("stroke-dasharray") for path in dashed)
    assert len(svg) < 200_000


def test_a_transparent_background_is_none() -> None:
    svg = drawn(document(style={"background": "transparent"}))[1]
    assert ET.fromstring(svg).find(f"{SVG}rect") is None
    white = ET.fromstring(drawn(document())[1]).find(f"{SVG}rect")
    assert white is not None
    assert white.attrib["fill"] == "#ffffff"


@pytest.mark.parametrize(
    "data", [document(items=[]), document(), document(style={"labels": False})]
)
def test_nearly_nothing_can_be_drawn(data: bytes) -> None:
    assert len(groups(drawn(data)[1])) == len(json.loads(data)["items"])


@wishes(max_examples=25, suppress_health_check=[HealthCheck.too_slow])
@given(documents())
def test_any_document_can_be_drawn(program: dict[str, Any]) -> None:
    try:
        svg = drawn(json.dumps(program).encode(), 160, 120)[1]
    except TubeloomError:
        return
    assert len(groups(svg)) == len(program["items"]) + len(program.get("hyperedges", ()))
    for path in ET.fromstring(svg).iter(f"{SVG}path"):
        assert not re.search("nan|inf", path.attrib["d"])


nasty = st.text(min_size=1, max_size=30) | st.sampled_from(
    [
        "</title><script>alert(1)</script>",
        '" onload="alert(1)',
        "'><g id='item-a'>",
        "]]>&amp;<!--",
        "\x00\x0b\x1f\ufffe\uffff",
        "a b\tc\nd\re",
        "javascript:alert(1)",
    ]
)


@wishes(max_examples=60, suppress_health_check=[HealthCheck.too_slow])
@given(st.lists(nasty, min_size=2, max_size=4, unique=True), nasty, nasty)
def test_no_text_of_a_document_gets_out_of_its_place(ids: list[str], label: str, kind: str) -> None:
    def is_sound(text: str) -> bool:
        return not any(0xD800 <= ord(character) < 0xE000 for character in text)

    ids = [id_ for id_ in ids if is_sound(id_)] or ["a"]
    items = [{"id": id_, "label": label, "kind": kind} for id_ in ids]
    ends = [{"item": ids[0]}, {"item": ids[-1]}]
    data = {"name": label, "items": items, "layout": {"clearance": None}}
    if len(ids) > 1:
        data["hyperedges"] = [{"id": ids[0], "label": label, "kind": kind, "attachments": ends}]
    svg = drawn(json.dumps(data).encode(), 200, 150)[1]
    root = ET.fromstring(svg)
    tags = {element.tag.removeprefix(SVG) for element in root.iter()}
    assert tags <= {"svg", "title", "desc", "style", "rect", "g", "path", "text"}
    attributes = {attribute for element in root.iter() for attribute in element.attrib}
    assert not any(attribute.startswith("on") or "href" in attribute for attribute in attributes)
    named = [element.attrib["id"] for element in root.iter() if "id" in element.attrib]
    assert len(named) == len(set(named)) == 2 + len(root.findall(f"{SVG}g"))
    assert all(re.fullmatch(r"[A-Za-z][\w.-]*", id_, re.ASCII) for id_ in named)
    shown = {group.attrib["data-id"] for group in groups(svg)}
    assert {id_ for id_ in ids if id_.isprintable()} <= shown


def test_chromium_shows_what_the_draft_shows(tmp_path: Path) -> None:
    require(draft_problem() is None, "No OpenGL.")
    staged, svg = drawn(CLAUSE)
    address = "data:image/svg+xml;base64," + base64.b64encode(svg).decode()
    code = f"""new Promise((done, failed) => {{
      const image = new Image();
      image.onerror = failed;
      image.onload = () => {{
        const canvas = document.createElement("canvas");
        [canvas.width, canvas.height] = [{WIDTH}, {HEIGHT}];
        canvas.getContext("2d").drawImage(image, 0, 0);
        done(canvas.toDataURL().split(",")[1]);
      }};
      image.src = {json.dumps(address)};
    }})"""
    with page_of("<!doctype html><title>Drawing</title>", tmp_path) as page:
        picture = Image.open(io.BytesIO(base64.b64decode(page.evaluate(code))))
    shown = np.asarray(picture.convert("RGB")).min(axis=2) < 253
    known = np.isfinite(depths(staged.scene, WIDTH, HEIGHT))
    # White tops of boxes are white as the sheet is, and so are gaps beside tubes.
    assert (shown & known).sum() / (shown | known).sum() > 0.9
    assert (shown & ~known).sum() / known.sum() < 0.02
