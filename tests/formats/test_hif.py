import contextlib
import json
from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from jsonschema import Draft7Validator

from app.errors import DocumentError, DocumentTooLarge
from app.formats import hif, registry
from app.formats.hif import read, write
from app.notations.loader import load_notation
from app.placement.place import place
from app.program.model import Item, Program
from app.program.shapes import Box, Sphere
from app.settings import Settings

EXAMPLES = Path(__file__).parents[2] / "examples"
OTHERS = Path(__file__).parent / "hif"
SCHEMA = Draft7Validator(json.loads((OTHERS / "hif_schema.json").read_text()))
FILES = [*sorted((EXAMPLES / "hif").glob("*.json")), *sorted(OTHERS.glob("[!h]*.json"))]
RADIUS, CLEARANCE = 0.08, 0.05


def program_of(**document: Any) -> Program:
    return read(json.dumps({"incidences": [], **document}).encode(), Settings())


def incidences(*ends: tuple[str | int, str | int]) -> list[dict[str, str | int]]:
    return [{"edge": edge, "node": node} for edge, node in ends]


def footprint(item: Item) -> tuple[float, float, float, float]:
    assert item.position is not None
    assert isinstance(item.shape, Box)
    assert item.shape.size is not None
    (x, y, _), (width, depth, _) = item.position, item.shape.size
    return (x - width / 2, x + width / 2, y - depth / 2, y + depth / 2)


@pytest.fixture(params=FILES, ids=lambda path: path.stem)
def file(request: pytest.FixtureRequest) -> Path:
    path: Path = request.param
    return path


@pytest.fixture
def _in_rows(monkeypatch: pytest.MonkeyPatch) -> None:
    """As nodes of a large hypergraph stand."""
    monkeypatch.setattr(hif, "MOST_ON_SHEET", 0)


def test_there_are_files_of_others() -> None:
    assert len(FILES) == 17


def test_a_file_shows_every_node_and_every_edge_that_joins(file: Path) -> None:
    document = json.loads(file.read_text())
    program = read(file.read_bytes(), Settings())
    nodes = {str(one["node"]) for key in ("nodes", "incidences") for one in document.get(key, [])}
    assert {item.id for item in program.items} == nodes
    ends = {(one["edge"], one["node"], one.get("direction")) for one in document["incidences"]}
    arities = Counter(str(edge) for edge, _, _ in ends)
    assert {edge.id: len(edge.attachments) for edge in program.hyperedges} == {
        edge: arity for edge, arity in arities.items() if arity > 1
    }


def test_what_is_written_follows_the_schema_and_says_the_same(file: Path) -> None:
    program = read(file.read_bytes(), Settings())
    written = write(program)
    SCHEMA.validate(json.loads(written))
    assert read(written, Settings()) == program


def test_weights_directions_and_attributes_survive(file: Path) -> None:
    def said(document: Any) -> dict[str, set[str]]:
        return {
            key: {json.dumps(without_empty(one), sort_keys=True) for one in document.get(key, [])}
            for key in ("nodes", "edges", "incidences")
        }

    def without_empty(part: Any) -> Any:
        return {key: value for key, value in part.items() if value not in ({}, None)}

    before = json.loads(file.read_text(), parse_int=float)
    after = json.loads(write(read(file.read_bytes(), Settings())), parse_int=float)
    old, new = said(before), said(after)
    assert old["incidences"] == new["incidences"]
    assert old["nodes"] <= new["nodes"]
    assert old["edges"] <= new["edges"]
    assert after.get("network-type") == before.get("network-type")
    assert after.get("metadata", {}) == before.get("metadata", {})


@pytest.mark.usefixtures("_in_rows")
@pytest.mark.parametrize("name", ["lesmis", "e-coli"])
def test_tubes_can_pass_between_the_places_of_others(name: str) -> None:
    program = read((EXAMPLES / "hif" / f"{name}.json").read_bytes(), Settings())
    placement = place(program, load_notation(program.notation))
    assert set(placement.radii) == {RADIUS}
    at = placement.attachment_positions
    owners = np.repeat(np.arange(len(program.hyperedges)), np.diff(placement.attachment_starts))
    apart = np.linalg.norm(at[:, None] - at[None], axis=2)
    apart[owners[:, None] == owners[None]] = np.inf
    assert apart.min() >= 2 * (2 * RADIUS + CLEARANCE)


@pytest.mark.usefixtures("_in_rows")
@pytest.mark.parametrize("name", ["lesmis", "e-coli"])
def test_nodes_do_not_overlap_and_places_are_on_top_of_them(name: str) -> None:
    program = read((EXAMPLES / "hif" / f"{name}.json").read_bytes(), Settings())
    boxes = [footprint(item) for item in program.items]
    for number, (left, right, near, far) in enumerate(boxes):
        for other in boxes[:number]:
            assert left >= other[1] or right <= other[0] or near >= other[3] or far <= other[2]
    for item, (left, right, near, far) in zip(program.items, boxes, strict=True):
        for point in item.attachment_points:
            assert abs(point.position[0]) <= (right - left) / 2 - 2 * RADIUS
            assert abs(point.position[1]) <= (far - near) / 2 - 2 * RADIUS
            assert point.direction == (0, 0, 1)


def test_nodes_are_balls_with_room_for_their_tubes_on_a_sheet() -> None:
    star = incidences(*((f"e{k}", node) for k in range(40) for node in ("hub", f"n{k}")))
    program = program_of(incidences=star)
    assert program.layout.placement == "sheet"
    hub, leaf = program.items[:2]
    assert isinstance(hub.shape, Sphere)
    assert isinstance(leaf.shape, Sphere)
    assert (hub.shape.radius or 0) > 2 * (leaf.shape.radius or 1)
    placement = place(program, load_notation(program.notation))
    assert np.ptp(placement.centers[:, 1]) == 0.0
    at = placement.attachment_positions[placement.attachment_items == 0]
    apart = np.linalg.norm(at[:, None] - at[None], axis=2) + 9.0 * np.eye(len(at))
    assert apart.min() > 2 * RADIUS + CLEARANCE


@pytest.mark.usefixtures("_in_rows")
def test_nodes_that_share_edges_are_near_each_other() -> None:
    groups = [[f"{group}{number}" for number in range(8)] for group in "ab"]
    ends = [
        (f"{group[0]}{k}", group[(k + step) % 8])
        for group in groups
        for k in range(8)
        for step in range(4)
    ]
    # Given in turns, so that their order says nothing.
    nodes = [{"node": name} for pair in zip(*groups, strict=True) for name in pair]
    program = program_of(
        nodes=nodes, incidences=[*incidences(*ends), *incidences(("x", "a0"), ("x", "b0"))]
    )
    at = {item.id: np.array(item.position) for item in program.items}

    def mean_distance(one: list[str], other: list[str]) -> float:
        return float(np.mean([np.linalg.norm(at[a] - at[b]) for a in one for b in other if a != b]))

    within = max(mean_distance(group, group) for group in groups)
    assert within < mean_distance(*groups)


@pytest.mark.usefixtures("_in_rows")
def test_a_place_is_on_the_side_where_its_edge_goes() -> None:
    program = read((EXAMPLES / "hif" / "lesmis.json").read_bytes(), Settings())
    at = {item.id: (item.position or (0, 0, 0))[0] for item in program.items}
    middles = {
        edge.id: float(np.mean([at[end.item] for end in edge.attachments]))
        for edge in program.hyperedges
    }
    wide = [item for item in program.items if len(item.attachment_points) > 1]
    assert len(wide) > 50
    for item in wide:
        across = sorted(item.attachment_points, key=lambda point: point.position[0])
        assert middles[across[0].id] <= middles[across[-1].id] + 1e-9


def test_numbers_and_strings_are_different_names() -> None:
    program = program_of(incidences=incidences((1, 2), (1, "2"), ("1", 2), ("1", "2")))
    assert [item.id for item in program.items] == ["2", "2'"]
    assert [item.data["node"] for item in program.items] == [2, "2"]
    assert [edge.id for edge in program.hyperedges] == ["1", "1'"]


def test_a_node_at_both_head_and_tail_of_an_edge_is_joined_twice() -> None:
    ends = [{"edge": "e", "node": "a", "direction": way} for way in ("head", "tail", "head")]
    (edge,) = program_of(incidences=ends, **{"network-type": "directed"}).hyperedges
    assert [(end.item, end.point) for end in edge.attachments] == [("a", None), ("a", "e'")]
    assert edge.data["incidences"] == [{"direction": "head"}, {"direction": "tail"}]


def test_edges_that_join_nothing_are_kept() -> None:
    document = {"edges": [{"edge": "none"}], "incidences": incidences(("one", "a"))}
    program = program_of(**document)
    assert program.hyperedges == ()
    assert program.data["edges"] == [{"edge": "none"}, {"edge": "one"}]
    assert json.loads(write(program))["incidences"] == [{"edge": "one", "node": "a"}]


def test_what_attributes_call_a_node_is_its_label() -> None:
    nodes = [{"node": "a", "attrs": {"label": "Anna", "name": "A."}}, {"node": "b"}]
    program = program_of(nodes=nodes, metadata={"name": "Two"})
    assert [item.label for item in program.items] == ["Anna", "b"]
    assert program.name == "Two"


@pytest.mark.parametrize("path", sorted(EXAMPLES.glob("*.json")), ids=lambda path: path.stem)
def test_our_own_programs_can_be_written_and_keep_what_they_join(path: Path) -> None:
    program = registry.read("tubeloom", path.read_bytes(), Settings())
    written = registry.write("hif", program)
    SCHEMA.validate(json.loads(written))
    again = read(written, Settings())
    assert [item.id for item in again.items] == [item.id for item in program.items]
    assert [[end.item for end in edge.attachments] for edge in again.hyperedges] == [
        [end.item for end in edge.attachments] for edge in program.hyperedges
    ]


def test_items_copied_with_their_data_stay_two_nodes() -> None:
    items = [{"id": name, "data": {"node": "same", "weight": 2}} for name in "ab"]
    program = registry.read("tubeloom", json.dumps({"items": items}).encode(), Settings())
    assert [node["node"] for node in json.loads(write(program))["nodes"]] == ["a", "b"]


def test_data_that_only_looks_like_a_hypergraphs_is_taken_for_an_editors_own() -> None:
    items = [{"id": "a", "data": {"node": ["no", "name"]}}]
    program = registry.read("tubeloom", json.dumps({"items": items}).encode(), Settings())
    (node,) = json.loads(write(program))["nodes"]
    assert node == {"node": "a", "attrs": {"node": ["no", "name"]}}


@pytest.mark.parametrize(
    ("document", "place"),
    [
        ({}, "/incidences"),
        ({"incidences": [{"edge": 1}]}, "/incidences/0/node"),
        ({"incidences": [{"edge": 1.5, "node": 2}]}, "/incidences/0/edge"),
        ({"incidences": [{"edge": 1, "node": None}]}, "/incidences/0/node"),
        ({"incidences": [], "nodes": [{"node": 1, "wait": 2}]}, "/nodes/0/wait"),
        ({"incidences": [], "network-type": "mixed"}, "/network-type"),
        ({"incidences": [], "network_type": "asc"}, "/network_type"),
        ({"incidences": [{"edge": 1, "node": 2, "direction": "up"}]}, "/incidences/0/direction"),
    ],
)
def test_faults_point_into_the_hypergraph(document: Any, place: str) -> None:
    with pytest.raises(DocumentError) as raised:
        read(json.dumps(document).encode(), Settings())
    assert {fault.pointer for fault in raised.value.faults} == {place}


@pytest.mark.parametrize(
    ("limit", "what"),
    [
        ({"max_items": 4}, "/nodes: 5 nodes"),
        ({"max_hyperedges": 4}, "/edges: 5 edges"),
        ({"max_attachments": 4}, "/incidences: 5 incidences"),
    ],
)
def test_a_hypergraph_that_is_too_large_is_refused(limit: dict[str, int], what: str) -> None:
    document = {"incidences": incidences(*((n, n) for n in range(5)))}
    with pytest.raises(DocumentTooLarge, match=what):
        read(json.dumps(document).encode(), Settings.model_validate(limit))


names = st.sampled_from(("a", "b", "", "1", 1, 2, -1, "x" * 300, "a'"))
parts = st.fixed_dictionaries({}, optional={"weight": st.floats(-9, 9), "attrs": st.just({"k": 1})})
ends = st.builds(
    lambda edge, node, rest, way: {"edge": edge, "node": node, **rest, **way},
    names,
    names,
    parts,
    st.sampled_from(({}, {"direction": "head"}, {"direction": "tail"})),
)
hypergraphs = st.fixed_dictionaries(
    {"incidences": st.lists(ends, max_size=12)},
    optional={
        "nodes": st.lists(st.builds(lambda name, rest: {"node": name, **rest}, names, parts)),
        "edges": st.lists(st.builds(lambda name, rest: {"edge": name, **rest}, names, parts)),
        "network-type": st.sampled_from(("undirected", "directed", "asc")),
        "metadata": st.just({"name": "N"}),
    },
)


@given(hypergraphs)
def test_every_hypergraph_is_read_and_written_without_loss(document: Any) -> None:
    program = read(json.dumps(document).encode(), Settings())
    written = write(program)
    SCHEMA.validate(json.loads(written))
    assert read(written, Settings()) == program
    kept = {json.dumps([one["edge"], one["node"]]) for one in json.loads(written)["incidences"]}
    assert kept == {json.dumps([one["edge"], one["node"]]) for one in document["incidences"]}


json_values = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.sampled_from(("head", "a")),
    lambda inner: st.lists(inner) | st.dictionaries(st.sampled_from(("edge", "node", "k")), inner),
    max_leaves=10,
)


@given(json_values, st.sampled_from(("incidences", "nodes", "edges", "metadata", "network-type")))
def test_any_json_value_is_a_hypergraph_or_a_document_error(value: Any, section: str) -> None:
    with contextlib.suppress(DocumentError):
        program_of(**{section: value})
