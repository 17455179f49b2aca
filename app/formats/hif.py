"""The hypergraph interchange format (HIF): nodes become items, edges hyperedges, and back.

Nodes are balls on an upright sheet; of a large hypergraph they are blocks in rows, where every
incidence gets an attachment point of its own on its node's top. An edge of fewer than two
incidences joins nothing: it is not drawn, but kept in the program's ``data``. Whatever else the
format says (weights, directions, attributes) is kept in ``data`` too, so that a document written
again says the same. What is said twice counts once, as it is said first.
"""

from __future__ import annotations

import math
from collections import Counter, defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from app.errors import DocumentTooLarge, Fault, pointer
from app.formats.hypergraph import Edge, Hypergraph, Incidence, Name, Node
from app.formats.hypergraph_layout import arrange
from app.formats.hypergraph_rest import (
    edge_of,
    incidence_of,
    node_of,
    plain,
    rest_of,
    told_apart,
)
from app.formats.names import short, untaken
from app.program.base import Data
from app.program.checking import check
from app.program.collection import collection_paused
from app.program.model import Attachment, AttachmentPoint, Hyperedge, Item, Layout, Program
from app.program.parsing import parse
from app.program.reading import validate
from app.program.shapes import Box, Sphere
from app.settings import Settings

HEIGHT = 0.6
LETTER = 0.24
"""Width of a letter of a label, roughly; formats do not know lettering."""

LABEL_MARGIN = 0.3
NARROWEST, WIDEST = 0.7, 5.0
"""Of a node, as far as its label goes; longer ones are fitted."""

MOST_ON_SHEET = 1_000
"""Edges of a hypergraph that stands on a sheet, where relaxation is done in seconds; larger ones
stand in rows."""

SMALLEST, AROUND_END = 0.3, 0.108
"""Radius of a node as a ball, and what it grows by with the root of the number of its edges: tubes
of radius 0.08 with a clearance of 0.05 then have room around it."""

LONGEST_BESIDE = 16
"""Letters of a ball's label."""

CALLED = ("label", "name")
"""Attributes that say what a node or an edge is called, if they are strings."""


@dataclass(frozen=True, slots=True)
class Told:
    """All nodes and edges, also those that stand in incidences alone, and who is in which edge."""

    nodes: Mapping[Name, Node]
    edges: Mapping[Name, Edge]
    members: Mapping[Name, Sequence[Incidence]]


def read(data: bytes, settings: Settings) -> Program:
    """The program that shows a hypergraph.

    Raises `UnreadableDocument`, `InvalidDocument` and `DocumentTooLarge`, all with pointers into
    the document.
    """
    with collection_paused():
        hypergraph = validate(Hypergraph, parse(data, settings))
        told = _told(hypergraph)
        _refuse_large(told, len(hypergraph.incidences), settings)
        program = _program(hypergraph, told)
        check(program, settings)
    return program


def write(program: Program) -> bytes:
    """Any program as a hypergraph: its items and hyperedges, what they are called and join."""
    rest = rest_of(program)
    nodes = told_apart([(node_of(item), Node(node=item.id)) for item in program.items], "node")
    edges = told_apart(
        [(edge_of(hyperedge), Edge(edge=hyperedge.id)) for hyperedge in program.hyperedges],
        "edge",
    )
    names = {item.id: node.node for item, node in zip(program.items, nodes, strict=True)}
    incidences = (
        incidence_of(hyperedge, place, edge.edge, names[attachment.item])
        for hyperedge, edge in zip(program.hyperedges, edges, strict=True)
        for place, attachment in enumerate(hyperedge.attachments)
    )
    named: Data | None = {"name": program.name} if program.name else None
    document = Hypergraph(
        network_type=rest.network_type,
        metadata=rest.metadata or named,
        nodes=tuple(nodes),
        edges=(*edges, *rest.edges),
        incidences=(*incidences, *rest.incidences),
    )
    return document.model_dump_json(indent=1, exclude_none=True, by_alias=True).encode() + b"\n"


def _told(hypergraph: Hypergraph) -> Told:
    nodes: dict[Name, Node] = {}
    edges: dict[Name, Edge] = {}
    members: dict[Name, dict[tuple[Name, str | None], Incidence]] = {}
    for node in hypergraph.nodes:
        nodes.setdefault(node.node, node)
    for edge in hypergraph.edges:
        edges.setdefault(edge.edge, edge)
    for one in hypergraph.incidences:
        nodes.setdefault(one.node, Node(node=one.node))
        edges.setdefault(one.edge, Edge(edge=one.edge))
        members.setdefault(one.edge, {}).setdefault((one.node, one.direction), one)
    return Told(nodes, edges, {name: list(members.get(name, {}).values()) for name in edges})


def _refuse_large(told: Told, incidences: int, settings: Settings) -> None:
    """Raise `DocumentTooLarge` before any item is made."""
    faults = [
        Fault(pointer(what), f"{number} {what} are more than the limit of {most} {limited}.")
        for number, what, most, limited in (
            (len(told.nodes), "nodes", settings.max_items, "items"),
            (len(told.edges), "edges", settings.max_hyperedges, "hyperedges"),
            (incidences, "incidences", settings.max_attachments, "attachments"),
        )
        if number > most
    ]
    if faults:
        raise DocumentTooLarge(faults)


def _program(hypergraph: Hypergraph, told: Told) -> Program:
    drawn = {name: found for name, found in told.members.items() if len(found) > 1}
    left = [name for name in told.edges if name not in drawn]
    rest = Hypergraph(
        network_type=hypergraph.network_type,
        metadata=hypergraph.metadata,
        edges=tuple(told.edges[name] for name in left),
        incidences=tuple(one for name in left for one in told.members[name]),
    )
    edge_ids = _ids(drawn)
    ends = [one for found in drawn.values() for one in found]
    in_rows = len(drawn) > MOST_ON_SHEET
    names = list(_point_ids(ends, edge_ids))
    points = names if in_rows else _second(drawn, names)
    hyperedges = []
    first = 0
    ids = _ids(told.nodes)
    for name, found in drawn.items():
        hyperedges.append(
            Hyperedge(
                id=edge_ids[name],
                label=_label(name, told.edges[name].attrs),
                attachments=tuple(
                    Attachment(item=ids[one.node], point=points[first + place])
                    for place, one in enumerate(found)
                ),
                data=plain(told.edges[name], found),
            )
        )
        first += len(found)
    return Program(
        name=_text(hypergraph.metadata, ("name",)),
        items=tuple(
            _blocks(told.nodes, ids, ends, names)
            if in_rows
            else _balls(told.nodes, ids, ends, points)
        ),
        hyperedges=tuple(hyperedges),
        layout=Layout() if in_rows else Layout(placement="sheet"),
        data=plain(rest),
    )


def _second(drawn: Mapping[Name, Sequence[Incidence]], names: Sequence[str]) -> list[str | None]:
    """A name for each point where an edge meets a node again, and ``None`` where it needs none."""
    places = [place for found in drawn.values() for place in _again(found)]
    return [name if again else None for name, again in zip(names, places, strict=True)]


def _again(ends: Sequence[Incidence]) -> Iterator[bool]:
    known: set[Name] = set()
    for one in ends:
        yield one.node in known
        known.add(one.node)


def _balls(
    nodes: Mapping[Name, Node],
    ids: Mapping[Name, str],
    ends: Sequence[Incidence],
    points: Sequence[str | None],
) -> Iterator[Item]:
    """A ball for each node, with room for the tubes of its ``ends``.

    Where an edge meets it again there is a point, on the rim.
    """
    degrees = Counter(one.node for one in ends)
    named: dict[Name, list[str]] = defaultdict(list)
    for one, point in zip(ends, points, strict=True):
        if point is not None:
            named[one.node].append(point)
    for name, node in nodes.items():
        radius = round(max(SMALLEST, AROUND_END * math.sqrt(degrees[name])), 3)
        yield Item(
            id=ids[name],
            label=short(_label(name, node.attrs), LONGEST_BESIDE),
            shape=Sphere(type="sphere", radius=radius),
            attachment_points=tuple(_on_rim(named[name], radius)),
            data=plain(node),
        )


def _on_rim(names: Sequence[str], radius: float) -> Iterator[AttachmentPoint]:
    """Points around a ball, on its plane that faces the reader."""
    for number, name in enumerate(names):
        angle = 2 * math.pi * number / len(names)
        x, z = math.cos(angle), math.sin(angle)
        yield AttachmentPoint(
            id=name, position=(radius * x, 0.0, radius * z), direction=(x, 0.0, z)
        )


def _blocks(
    nodes: Mapping[Name, Node],
    ids: Mapping[Name, str],
    ends: Sequence[Incidence],
    points: Sequence[str],
) -> Iterator[Item]:
    """A block for each node, in rows, with a place for each of ``ends`` that is its own."""
    labels = [_label(name, node.attrs) for name, node in nodes.items()]
    widths = [LETTER * len(label) + LABEL_MARGIN for label in labels]
    numbers = {name: number for number, name in enumerate(nodes)}
    edges: dict[Name, int] = {}
    arrangement = arrange(
        np.clip(np.array(widths, dtype=np.float64), NARROWEST, WIDEST),
        np.array([numbers[one.node] for one in ends], dtype=np.int64),
        np.array([edges.setdefault(one.edge, len(edges)) for one in ends], dtype=np.int64),
    )
    attachment_points: dict[Name, list[AttachmentPoint]] = {name: [] for name in nodes}
    for one, point, (x, y) in zip(ends, points, arrangement.places.tolist(), strict=True):
        attachment_points[one.node].append(AttachmentPoint(id=point, position=(x, y, HEIGHT / 2)))
    for (name, node), label, (x, y), (width, depth) in zip(
        nodes.items(), labels, arrangement.centers.tolist(), arrangement.sizes.tolist(), strict=True
    ):
        yield Item(
            id=ids[name],
            label=label,
            shape=Box(type="box", size=(width, depth, HEIGHT)),
            position=(x, y, HEIGHT / 2),
            attachment_points=tuple(attachment_points[name]),
            data=plain(node),
        )


def _ids(names: Mapping[Name, object]) -> dict[Name, str]:
    taken: set[str] = set()
    return {name: untaken(str(name), taken) for name in names}


def _point_ids(ends: Sequence[Incidence], edge_ids: Mapping[Name, str]) -> Iterator[str]:
    """A point is called as its edge; a node at both head and tail has two."""
    taken: dict[Name, set[str]] = {}
    for one in ends:
        yield untaken(edge_ids[one.edge], taken.setdefault(one.node, set()))


def _label(name: Name, attributes: Data | None) -> str:
    return short(_text(attributes, CALLED) or str(name))


def _text(attributes: Data | None, keys: Sequence[str]) -> str | None:
    """The first of these attributes that is some text."""
    texts = ((attributes or {}).get(key) for key in keys)
    return next((short(text) for text in texts if isinstance(text, str) and text.strip()), None)
