"""The numbers of a layout as JSON: where items stand, and curves and colours of hyperedges."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from pydantic_core import to_json

from app.arrays import Floats, Indices
from app.hyperedges.clearance.overlaps import Overlaps
from app.hyperedges.routing import Routing
from app.notations.loader import load_notation
from app.output.clearance_numbers import Verdict, clearance_numbers
from app.placement.placement import Placement
from app.program.model import Program
from app.scene.color import hexes_of
from app.scene.hyperedge_colors import background_of, hyperedge_colors


def layout_numbers(
    program: Program,
    placement: Placement,
    routing: Routing,
    patches: Floats | None,
    verdict: Verdict | None,
    overlaps: Overlaps,
    hues: Indices | None = None,
    complete: bool = True,
) -> bytes:
    """JSON with world positions (z up, document units) and quaternions x, y, z, w.

    Every number has as many digits as it takes to read the same float back. ``patches``
    (s, 2, 4, 4, 3), top and bottom of each segment, are written where they are given; without a
    ``verdict`` the clearance is null. ``overlaps`` are items that stand in each other. ``hues``
    (h,) say which colour of the palette each hyperedge takes; left out, they take one after
    another. A layout for which there was not time enough, one that is not ``complete``, says so.
    """
    # Entry by entry: all as dictionaries at once would take many times the memory of the text.
    items = b",".join(map(_json, _items(program, placement)))
    colors = _colors(program, hues)
    hyperedges = b",".join(map(_json, _hyperedges(program, placement, routing, patches, colors)))
    clearance = None if verdict is None else clearance_numbers(program, placement, routing, verdict)
    stopped = b"" if complete else b',"stopped_by":"deadline"'
    return b'{"items":[%b],"hyperedges":[%b],"overlaps":[%b],"clearance":%b%b}' % (
        items,
        hyperedges,
        b",".join(map(_json, _overlaps(program, overlaps))),
        _json(clearance),
        stopped,
    )


def _overlaps(program: Program, overlaps: Overlaps) -> Iterator[dict[str, Any]]:
    for pair, depth in zip(overlaps.items.tolist(), overlaps.depths.tolist(), strict=True):
        yield {"items": [program.items[number].id for number in pair], "depth": depth}


def _json(entry: dict[str, Any] | None) -> bytes:
    return to_json(entry, inf_nan_mode="null")


def _items(program: Program, placement: Placement) -> Iterator[dict[str, Any]]:
    columns = (placement.centers, placement.sizes, placement.rotations)
    for item, center, size, rotation in zip(program.items, *columns, strict=True):
        yield {
            "id": item.id,
            "center": center.tolist(),
            "size": size.tolist(),
            "rotation": rotation.tolist(),
        }


def _colors(program: Program, hues: Indices | None) -> list[str]:
    notation = load_notation(program.notation)
    return hexes_of(hyperedge_colors(program, notation, background_of(program), hues))


def _hyperedges(
    program: Program,
    placement: Placement,
    routing: Routing,
    patches: Floats | None,
    colors: Sequence[str],
) -> Iterator[dict[str, Any]]:
    for number, hyperedge in enumerate(program.hyperedges):
        places = _own(placement.attachment_starts, number)
        segments = _own(routing.segment_starts, number)
        joins = _own(routing.join_starts, number)
        ends = zip(
            hyperedge.attachments,
            placement.attachment_positions[places].tolist(),
            placement.attachment_directions[places].tolist(),
            strict=True,
        )
        yield {
            "id": hyperedge.id,
            "color": colors[number],
            "join_plane": float(routing.join_planes[number]),
            "radius": float(routing.radii[number]),
            "attachments": [
                {
                    "item": attachment.item,
                    "point": attachment.point,
                    "position": position,
                    "direction": direction,
                }
                for attachment, position, direction in ends
            ],
            "segments": _segments(
                len(hyperedge.attachments),
                routing.segment_ends[segments],
                routing.control_points[segments],
                None if patches is None else patches[segments],
            ),
            "joins": [
                {"position": position, "tangent": tangent}
                for position, tangent in zip(
                    routing.join_positions[joins].tolist(),
                    routing.join_tangents[joins].tolist(),
                    strict=True,
                )
            ],
        }


def _own(starts: Indices, number: int) -> slice:
    return slice(starts[number], starts[number + 1])


def _segments(
    attachments: int, ends: Indices, control_points: Floats, patches: Floats | None
) -> list[dict[str, Any]]:
    """The segments of one hyperedge of so many attachments."""

    def end(number: int) -> dict[str, int]:
        # Attachments are numbered first, then joins.
        is_join = number >= attachments
        return {"join": number - attachments} if is_join else {"attachment": number}

    found: list[dict[str, Any]] = [
        {"from": end(begins), "to": end(stops), "control_points": points}
        for (begins, stops), points in zip(ends.tolist(), control_points.tolist(), strict=True)
    ]
    if patches is not None:
        for segment, (top, bottom) in zip(found, patches.tolist(), strict=True):
            segment["patches"] = [{"top": top, "bottom": bottom}]
    return found
