"""Whether a program that follows the schema agrees with itself and with the limits."""

from __future__ import annotations

from collections.abc import Iterator

from app.errors import DocumentTooLarge, Fault, InconsistentDocument, pointer
from app.program.advice import did_you_mean
from app.program.model import Item, Program
from app.program.shapes import Text
from app.settings import Settings

MOST_FAULTS = 100
MOST_HINTS = 20
"""Faults that come with a search for the name that was meant: it looks at all names."""


def check(program: Program, settings: Settings) -> None:
    """Raise `DocumentTooLarge` or `InconsistentDocument` with every fault found; else return.

    Limits come first: a document beyond them is not looked at further.
    """
    _refuse(DocumentTooLarge, _limits(program, settings))
    _refuse(
        InconsistentDocument,
        (
            fault
            for faults in (
                _item_faults(program),
                _parent_faults(program, settings),
                _hyperedge_faults(program),
                _line_up_faults(program),
                _view_faults(program),
            )
            for fault in faults
        ),
    )


def _refuse(error: type[DocumentTooLarge | InconsistentDocument], found: Iterator[Fault]) -> None:
    faults = list(found)
    if len(faults) > MOST_FAULTS:
        more = len(faults) - MOST_FAULTS
        faults = [*faults[:MOST_FAULTS], Fault("", f"And {more} more faults.")]
    if faults:
        raise error(faults)


def _limits(program: Program, settings: Settings) -> Iterator[Fault]:
    attachments = sum(len(hyperedge.attachments) for hyperedge in program.hyperedges)
    characters = sum(len(item.label or "") for item in program.items)
    for place, count, most, what in (
        ("items", len(program.items), settings.max_items, "items"),
        ("hyperedges", len(program.hyperedges), settings.max_hyperedges, "hyperedges"),
        ("hyperedges", attachments, settings.max_attachments, "attachments in all"),
        ("items", characters, settings.max_label_characters, "characters in labels"),
    ):
        if count > most:
            yield Fault(pointer(place), f"{count} {what} are more than the limit of {most}.")


def _item_faults(program: Program) -> Iterator[Fault]:
    seen: dict[str, int] = {}
    for number, item in enumerate(program.items):
        first = seen.setdefault(item.id, number)
        if first != number:
            yield Fault(
                pointer("items", number, "id"),
                f'"{item.id}" is the id of /items/{first} already; ids must be unique.',
            )
        if isinstance(item.shape, Text) and not (item.label or "").strip():
            yield Fault(pointer("items", number, "shape"), "A text shape needs a label to show.")
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


def _parent_faults(program: Program, settings: Settings) -> Iterator[Fault]:
    numbers = {item.id: number for number, item in reversed(list(enumerate(program.items)))}
    hints = MOST_HINTS
    depths: dict[str, int] = {}
    for number, item in enumerate(program.items):
        if item.parent is not None and item.parent not in numbers:
            hint = did_you_mean(item.parent, numbers) if hints > 0 else ""
            hints -= 1
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


def _hyperedge_faults(program: Program) -> Iterator[Fault]:
    items = {item.id: item for item in program.items}
    points = {
        item.id: {point.id for point in item.attachment_points}
        for item in program.items
        if item.attachment_points
    }
    seen: dict[str, int] = {}
    hints = MOST_HINTS
    for number, hyperedge in enumerate(program.hyperedges):
        first = seen.setdefault(hyperedge.id, number)
        if first != number:
            yield Fault(
                pointer("hyperedges", number, "id"),
                f'"{hyperedge.id}" is the id of /hyperedges/{first} already; ids must be unique.',
            )
        ends: set[tuple[str, str | None]] = set()
        for place, attachment in enumerate(hyperedge.attachments):
            here = ("hyperedges", number, "attachments", place)
            if attachment.item not in items:
                hint = did_you_mean(attachment.item, items) if hints > 0 else ""
                hints -= 1
                yield Fault(pointer(*here, "item"), f'There is no item "{attachment.item}".{hint}')
            elif attachment.point is not None:
                known = points.get(attachment.item, set())
                if attachment.point not in known:
                    hint = did_you_mean(attachment.point, sorted(known))
                    yield Fault(
                        pointer(*here, "point"),
                        f'Item "{attachment.item}" has no attachment point '
                        f'"{attachment.point}".{hint}',
                    )
            end = (attachment.item, attachment.point)
            if end in ends:
                yield Fault(pointer(*here), "This hyperedge has the same attachment already.")
            ends.add(end)


def _line_up_faults(program: Program) -> Iterator[Fault]:
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
                yield Fault(here, f'There is no item "{name}".{did_you_mean(name, items)}')
            elif items[name].position is not None:
                yield Fault(here, f'Item "{name}" has a position; it cannot be lined up.')
            if name in taken:
                yield Fault(here, f'Item "{name}" is lined up already.')
            taken.add(name)


def _view_faults(program: Program) -> Iterator[Fault]:
    if not any(program.view.from_):
        yield Fault(pointer("view", "from"), "A direction must not be zero.")
