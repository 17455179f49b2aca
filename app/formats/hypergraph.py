"""A hypergraph in the hypergraph interchange format (HIF)."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BeforeValidator, Field

from app.program.base import Data, Many, Part


def _whole(number: object) -> object:
    """JSON knows no integers: 3.0 is 3."""
    return int(number) if isinstance(number, float) and number.is_integer() else number


Name = str | Annotated[int, Field(ge=-(2**53), le=2**53), BeforeValidator(_whole)]
"""What a node or an edge is called; 1 and "1" are two names."""

Weight = Annotated[float, Field(allow_inf_nan=False)]
NetworkType = Literal["undirected", "directed", "asc"]


class Incidence(Part):
    """That a node is in an edge; in a directed hypergraph, at its head or at its tail."""

    edge: Name
    node: Name
    weight: Weight | None = None
    direction: Literal["head", "tail"] | None = None
    attrs: Data | None = None


class Node(Part):
    """What is said of a node."""

    node: Name
    weight: Weight | None = None
    attrs: Data | None = None


class Edge(Part):
    """What is said of an edge."""

    edge: Name
    weight: Weight | None = None
    attrs: Data | None = None


class Hypergraph(Part):
    """A hypergraph; nodes and edges that nothing is said of stand in its incidences alone."""

    network_type: NetworkType | None = Field(
        None,
        alias="network-type",
        description='"asc" is an abstract simplicial complex: subsets of edges are meant too.',
    )
    metadata: Data | None = None
    incidences: Many[Incidence]
    nodes: Many[Node] = ()
    edges: Many[Edge] = ()
