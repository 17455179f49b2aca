"""What a hypergraph says that a program does not: kept in ``data``, and found there again."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TypeVar

from pydantic import JsonValue, ValidationError

from app.formats.hypergraph import Edge, Hypergraph, Incidence, Name, Node
from app.program.base import Part
from app.program.model import Hyperedge, Item, Program

Model = TypeVar("Model", bound=Part)
Named = TypeVar("Named", Node, Edge)
Values = dict[str, JsonValue]

OF_INCIDENCE = ("weight", "direction", "attrs")


def plain(part: Part, incidences: Sequence[Incidence] = ()) -> Values:
    """A node, an edge with its incidences, or a hypergraph, as ``data``."""
    said: Values = part.model_dump(mode="json", by_alias=True, exclude_none=True)
    said = {key: value for key, value in said.items() if value not in ([], {})}
    each: list[JsonValue] = [
        one.model_dump(mode="json", include=set(OF_INCIDENCE), exclude_none=True)
        for one in incidences
    ]
    if any(each):
        said["incidences"] = each
    return said


def rest_of(program: Program) -> Hypergraph:
    """What a hypergraph said of itself, and its edges that are not drawn."""
    found = _as(Hypergraph, {"incidences": [], **program.data})
    return found or Hypergraph(incidences=())


def node_of(item: Item) -> Node:
    """The node that an item was, or could be."""
    return _as(Node, item.data) or Node(node=item.id, attrs=_own(item))


def edge_of(hyperedge: Hyperedge) -> Edge:
    """The edge that a hyperedge was, or could be."""
    return _as(Edge, hyperedge.data) or Edge(edge=hyperedge.id, attrs=_own(hyperedge))


def incidence_of(hyperedge: Hyperedge, place: int, edge: Name, node: Name) -> Incidence:
    """The incidence that the attachment number ``place`` was, or could be."""
    ends = hyperedge.data.get("incidences")
    kept = ends[place] if isinstance(ends, list) and len(ends) == len(hyperedge.attachments) else {}
    said = kept if isinstance(kept, dict) else {}
    found = _as(Incidence, {**said, "edge": edge, "node": node})
    point = hyperedge.attachments[place].point
    if found is not None and ("edge" in hyperedge.data or point is None):
        return found
    return Incidence(edge=edge, node=node, attrs={"point": point} if point else None)


def told_apart(found: Sequence[tuple[Named, Named]], key: str) -> list[Named]:
    """The first of each pair, unless two of these have one name: then all names are the second's.

    ``key`` is where the name is; an item copied with its data has its original's.
    """
    firsts = [first for first, _ in found]
    if len({getattr(one, key) for one in firsts}) == len(firsts):
        return firsts
    return [first.model_copy(update={key: getattr(second, key)}) for first, second in found]


def _own(part: Item | Hyperedge) -> Values | None:
    """What a program's own part is called and means, and its data."""
    said: Mapping[str, JsonValue] = {"label": part.label, "kind": part.kind}
    return {**part.data, **{key: value for key, value in said.items() if value}} or None


def _as(model: type[Model], data: Mapping[str, JsonValue]) -> Model | None:
    """The keys of ``data`` that are the model's, if they make one."""
    keys = {field.alias or name for name, field in model.model_fields.items()}
    try:
        return model.model_validate({key: value for key, value in data.items() if key in keys})
    except ValidationError:
        return None
