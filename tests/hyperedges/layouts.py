"""Layouts of documents, and what two of them have in common."""

from __future__ import annotations

import json
from typing import Any

from app.hyperedges.clearance.certificate import certify
from app.layout import Layout, lay_out
from app.program.reading import read_program
from app.settings import Settings


def laid(document: dict[str, Any], previous: Layout | None = None) -> Layout:
    """The layout of a document, after that of a ``previous`` one."""
    return lay_out(read_program(json.dumps(document).encode(), Settings()), previous)


def same(before: Layout, after: Layout) -> set[str]:
    """Ids of the hyperedges whose control points are equal to the bit."""

    def curves(layout: Layout) -> dict[str, bytes]:
        starts = layout.routing.segment_starts.tolist()
        points = layout.routing.control_points
        return {
            hyperedge.id: points[begin:end].tobytes()
            for hyperedge, begin, end in zip(
                layout.program.hyperedges, starts[:-1], starts[1:], strict=True
            )
        }

    old, new = curves(before), curves(after)
    return {one for one in old.keys() & new.keys() if old[one] == new[one]}


def assert_clear(layout: Layout) -> None:
    """No two hyperedges come too near to each other, and none to an item."""
    assert certify(layout.routing, layout.placement, 0.05).certified


def ids(document: dict[str, Any]) -> list[str]:
    """Of the hyperedges, in order."""
    return [hyperedge["id"] for hyperedge in document["hyperedges"]]
