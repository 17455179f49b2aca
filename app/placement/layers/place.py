"""A program's items in layers, upright: they face a reader who looks along y."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from app.arrays import Flags, Floats, Indices
from app.grouped import starts_of
from app.notations.notation import Notation
from app.placement.attaching import apart
from app.placement.family import family
from app.placement.layers.graph import Graph
from app.placement.layers.parts import in_parts
from app.placement.layers.plan import Layers
from app.placement.layers.ports import Ports, flows_out, with_ports
from app.placement.placement import Placement
from app.placement.turning import matrices
from app.placement.within import in_parent
from app.program.model import Program
from app.program.port_rows import ROW

HUNDREDTHS = 100.0


def in_layers(program: Program, notation: Notation, placed: Placement) -> Placement:
    """The items that are ``placed`` in rows, in layers instead; with their attachments.

    What has no parent moves, with all that it contains. Items with positions stay where they are:
    the others stand to the right of them. Where all attachments are in rows at the left and right
    sides of items without parents, the placement has layers to construct the curves in. Raises
    `app.placement.layers.terminals.TooManyError` where there is too much for that.
    """
    roots = _roots(placed.parents)
    tops = np.flatnonzero(placed.parents < 0)
    placed, ports = with_ports(program, notation, placed, roots)
    graph = _graph(program, notation, placed, roots, tops, ports)
    origins, layers = in_parts(graph, program.layout.clearance or 0.0)
    is_fixed = np.array([program.items[top].position is not None for top in tops], dtype=np.bool_)
    shift = _shift(placed, graph, origins, tops, is_fixed)
    origins = origins + shift
    centers = np.stack(
        [origins[:, 0], -ports.depths[tops], -origins[:, 1] - ports.firsts[tops]], axis=1
    )
    moves = np.zeros_like(placed.centers)
    moves[tops] = np.where(is_fixed[:, None], 0.0, centers - placed.centers[tops])
    # Of what stands in something else offsets are within that.
    moved = replace(placed, centers=placed.centers + moves, offsets=placed.offsets + moves)
    moved = replace(
        moved,
        centers=_with_contents(program, moved),
        attachment_positions=ports.positions + moved.centers[roots[ports.items]],
        attachment_directions=ports.directions,
        attachment_starts=starts_of(
            np.array([len(each.attachments) for each in program.hyperedges], dtype=np.int64)
        ),
        attachment_items=ports.items,
    )
    if is_fixed.any() or not ports.exact:
        return apart(program, moved, ~ports.named)
    plans = tuple(plan.moved(*shift.tolist()) for plan in layers.plans)
    return replace(moved, layers=Layers(plans, layers.nets))


def _with_contents(program: Program, placed: Placement) -> Floats:
    """Centres (n, 3) of all items, what has a parent within it: to the bit as elsewhere."""
    centers = placed.centers.tolist()
    turns, offsets = placed.rotations.tolist(), placed.offsets.tolist()
    relations = family(program)
    for number in relations.order:
        parent = relations.parents[number]
        if parent >= 0:
            centers[number] = in_parent(
                placed.solids[parent], centers[parent], turns[parent], offsets[number]
            )
    return np.array(centers, dtype=np.float64).reshape(-1, 3)


def _roots(parents: Indices) -> Indices:
    """What each item (n,) stands in at last; itself where it has no parent."""
    found = np.where(parents < 0, np.arange(len(parents)), parents)
    while (found[found] != found).any():
        found = found[found]
    return found


def _graph(
    program: Program, notation: Notation, placed: Placement, roots: Indices, tops: Indices,
    ports: Ports,
) -> Graph:  # fmt: skip
    """What is laid out: items without parents, and all hyperedges between them."""
    numbers = np.full(len(roots), -1, dtype=np.int64)
    numbers[tops] = np.arange(len(tops))
    styles = [notation.item_style(program.items[top].kind) for top in tops]
    weights = [notation.hyperedge_style(hyperedge.kind).weight for hyperedge in program.hyperedges]
    starts = starts_of(
        np.array([len(each.attachments) for each in program.hyperedges], dtype=np.int64)
    )
    drives = np.flatnonzero(flows_out(program))
    return Graph(
        extents=_extents(placed, roots, tops, ports.firsts),
        halves=_halves(placed, tops, numbers[roots[ports.items]], ports.positions),
        spans=ports.spans[tops],
        is_state=np.array([style.stores for style in styles], dtype=np.bool_),
        is_last=np.array([style.is_last for style in styles], dtype=np.bool_),
        port_items=numbers[roots[ports.items]],
        port_sides=ports.sides,
        port_rows=ports.rows,
        port_xs=ports.positions[:, 0],
        net_starts=starts,
        sources=drives[np.searchsorted(drives, starts[:-1])],
        radii=placed.radii,
        weights=np.rint(HUNDREDTHS * np.array(weights)).astype(np.int64),
    )


def _halves(placed: Placement, tops: Indices, owners: Indices, positions: Floats) -> Floats:
    """Half the widths (r,) of items: as far as their ports are from their middles at most."""
    found = placed.sizes[tops, 0] / 2
    np.maximum.at(found, owners, np.abs(positions[:, 0]))
    return np.asarray(found)


def _extents(placed: Placement, roots: Indices, tops: Indices, firsts: Floats) -> Floats:
    """How far items and all that is in them reach (r, 4), as in `Graph`."""
    boxes = [(placed.centers, placed.rotations, placed.sizes, roots)]
    labelled = np.array(
        [number for number, label in enumerate(placed.labels) if label is not None], dtype=np.int64
    )
    if len(labelled):
        labels = [label for label in placed.labels if label is not None]
        turned = matrices(placed.rotations[labelled])
        middles = np.array([label.position for label in labels])
        # Letters stand upright, and are as thick as they are deep.
        sizes = np.array([(size[0], size[2], size[1]) for size in (each.size for each in labels)])
        centers = placed.centers[labelled] + np.einsum("nij,nj->ni", turned, middles)
        boxes.append((centers, placed.rotations[labelled], sizes, roots[labelled]))
    low, high = np.full((len(roots), 3), np.inf), np.full((len(roots), 3), -np.inf)
    for centers, rotations, sizes, owners in boxes:
        reach = np.einsum("nij,nj->ni", np.abs(matrices(rotations)), sizes / 2)
        np.minimum.at(low, owners, centers - reach)
        np.maximum.at(high, owners, centers + reach)
    origins = placed.centers[tops].copy()
    origins[:, 2] += firsts[tops]
    low, high = origins - low[tops], high[tops] - origins
    return np.stack([low[:, 0], high[:, 0], high[:, 2], low[:, 2]], axis=1)


def _shift(
    placed: Placement, graph: Graph, origins: Floats, tops: Indices, is_fixed: Flags
) -> Floats:
    """By how much (2,) all moves: it stands on z = 0, right of what has a position."""
    if not len(tops):
        return np.zeros(2)
    lowest = float((origins[:, 1] + graph.extents[:, 3]).max())
    left = float((origins[:, 0] - graph.extents[:, 0]).min())
    if not is_fixed.any():
        return np.array([0.0, -lowest])
    right = float((placed.centers[tops, 0] + graph.extents[:, 1])[is_fixed].max())
    return np.array([right + 2 * ROW - left, -lowest])
