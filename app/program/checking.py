"""Whether a program that follows the schema agrees with itself and with the limits."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import chain

from app.errors import Fault, InconsistentDocument, pointer
from app.program.csg import tree_faults
from app.program.faults import first
from app.program.hints import Hints
from app.program.limits import count, refuse_too_many
from app.program.model import Hyperedge, Item, Program
from app.program.shapes import Csg, Text
from app.program.trusted import Trusted
from app.settings import Settings


def check(program: Program, settings: Settings, checked: Program | None = None) -> None:
    """Raise `DocumentTooLarge` or `InconsistentDocument` with every fault found; else return.

    Limits come first: a document beyond them is not looked at further. What is the very same in a
    program that has been ``checked`` is looked at again only where others might have made it wrong.
    """
    refuse_too_many(count(program), settings)
    hints = Hints()
    trusted = Trusted.nothing() if checked is None else Trusted.of(program, checked)
    faults = first(
        chain(
            _item_faults(program, trusted),
            () if trusted.parents else _parent_faults(program, settings, hints),
            _hyperedge_faults(program, hints, trusted),
            _line_up_faults(program, hints),
            _layout_faults(program),
            _view_faults(program),
        )
    )
    if faults:
        raise InconsistentDocument(faults)


def _item_faults(program: Program, trusted: Trusted) -> Iterator[Fault]:
    seen: dict[str, int] = {}
    for number, item in enumerate(program.items):
        first = seen.setdefault(item.id, number)
        if first != number:
            yield Fault(
                pointer("items", number, "id"),
                f'"{item.id}" is the id of /items/{first} already; ids must be unique.',
            )
        if id(item) in trusted.items:
            continue
        if isinstance(item.shape, Text) and not (item.label or "").strip():
            yield Fault(pointer("items", number, "shape"), "A text shape needs a label to show.")
        if isinstance(item.shape, Csg):
            yield from tree_faults(item.shape.tree, ("items", number, "shape", "tree"))
        points: set[str] = set()
        for place, point in enumerate(item.attachment_points):
            here = ("items", number, "attachment_points", place)
            if point.id in points:
                yield Fault(
                    pointer(*here, "id"), f'This item has an attachment point "{point.id}" already.'
                )
            points.add(point.id)
            if not any(point.direction):
                yield Fault(pointer(*here, "direction"), "A direction must not be zero.")


def _parent_faults(program: Program, settings: Settings, hints: Hints) -> Iterator[Fault]:
    numbers = {item.id: number for number, item in reversed(list(enumerate(program.items)))}
    depths: dict[str, int] = {}
    for number, item in enumerate(program.items):
        if item.parent is not None and item.parent not in numbers:
            hint = hints.at(item.parent, numbers)
            yield Fault(
                pointer("items", number, "parent"), f'There is no item "{item.parent}".{hint}'
            )
        way: list[str] = []
        here: str | None = item.id
        on_way: set[str] = set()
        while here is not None and here in numbers and here not in depths and here not in on_way:
            way.append(here)
            on_way.add(here)
            here = program.items[numbers[here]].parent
        if here in on_way:
            circle = way[way.index(here) :]
            names = " → ".join(f'"{name}"' for name in [*circle[:10], circle[0]])
            yield Fault(
                pointer("items", numbers[circle[0]], "parent"),
                f"Parents go round in a circle: {names}.",
            )
        depth = 0 if here is None else depths.get(here, 0)
        for name in reversed(way):
            depth += 1
            depths[name] = depth
            if depth == settings.max_depth + 1:
                yield Fault(
                    pointer("items", numbers[name], "parent"),
                    f"Items may be nested at most {settings.max_depth} deep.",
                )


def _hyperedge_faults(program: Program, hints: Hints, trusted: Trusted) -> Iterator[Fault]:
    points: dict[str, dict[str, None]] = {}
    known: set[tuple[str, str | None]] = set()
    if not trusted.all_hyperedges:
        for item in program.items:
            own = ((point.id, None) for point in item.attachment_points)
            points.setdefault(item.id, {}).update(own)
        known.update((name, None) for name in points)
        known.update((name, point) for name, of_item in points.items() for point in of_item)
    seen: dict[str, int] = {}
    for number, hyperedge in enumerate(program.hyperedges):
        first = seen.setdefault(hyperedge.id, number)
        if first != number:
            yield Fault(
                pointer("hyperedges", number, "id"),
                f'"{hyperedge.id}" is the id of /hyperedges/{first} already; ids must be unique.',
            )
        if id(hyperedge) in trusted.hyperedges:
            continue
        ends = {(attachment.item, attachment.point) for attachment in hyperedge.attachments}
        if len(ends) < len(hyperedge.attachments) or not ends <= known:
            yield from _attachment_faults(number, hyperedge, points, hints)


def _attachment_faults(
    number: int, hyperedge: Hyperedge, points: Mapping[str, Mapping[str, None]], hints: Hints
) -> Iterator[Fault]:
    """``points`` are the ids of every item's attachment points, in order."""
    ends: set[tuple[str, str | None]] = set()
    for place, attachment in enumerate(hyperedge.attachments):
        here = ("hyperedges", number, "attachments", place)
        name, point = attachment.item, attachment.point
        if name not in points:
            yield Fault(
                pointer(*here, "item"), f'There is no item "{name}".{hints.at(name, points)}'
            )
        elif point is not None and point not in points[name]:
            yield Fault(
                pointer(*here, "point"),
                f'Item "{name}" has no attachment point "{point}".{hints.at(point, points[name])}',
            )
        if (name, point) in ends:
            yield Fault(pointer(*here), "This hyperedge has the same attachment already.")
        ends.add((name, point))


def _line_up_faults(program: Program, hints: Hints) -> Iterator[Fault]:
    items: dict[str, Item] = {item.id: item for item in program.items}
    taken: set[str] = set()
    for number, line_up in enumerate(program.layout.constraints):
        parents = {items[name].parent for name in line_up.items if name in items}
        if len(parents) > 1:
            yield Fault(
                pointer("layout", "constraints", number, "items"),
                "Items that line up must have the same parent.",
            )
        for place, name in enumerate(line_up.items):
            here = pointer("layout", "constraints", number, "items", place)
            if name not in items:
                yield Fault(here, f'There is no item "{name}".{hints.at(name, items)}')
            elif items[name].position is not None:
                yield Fault(here, f'Item "{name}" has a position; it cannot be lined up.')
            if name in taken:
                yield Fault(here, f'Item "{name}" is lined up already.')
            taken.add(name)


def _layout_faults(program: Program) -> Iterator[Fault]:
    if program.layout.curves == "steiner" and program.layout.fidelity == "paper":
        yield Fault(
            pointer("layout", "curves"),
            'The paper has no "steiner" curves: leave them out, or take fidelity "best".',
        )


def _view_faults(program: Program) -> Iterator[Fault]:
    if program.view.from_ is not None and not any(program.view.from_):
        yield Fault(pointer("view", "from"), "A direction must not be zero.")
