"""A program that edits are done on: found by id, changed in place, frozen again at the end."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from typing import TypeVar

from app.program.model import Attachment, Constraint, Hyperedge, Item, Program

Entry = TypeVar("Entry")


class Editable:
    """The parts of a program by their ids, in order; ``names`` says which ids were others before.

    It keeps the parts' relations right: who contains whom, who is joined by what, who lines up.
    """

    def __init__(self, program: Program) -> None:
        self.program = program
        self.items = {item.id: item for item in program.items}
        self.hyperedges = {hyperedge.id: hyperedge for hyperedge in program.hyperedges}
        self._origins = {name: name for name in self.items}
        self._hyperedge_origins = {name: name for name in self.hyperedges}
        self._constraints = list(program.layout.constraints)
        self._contents: dict[str | None, dict[str, None]] = {}
        self._joined_by: dict[str, dict[str, None]] = {}
        for item in program.items:
            self._contents.setdefault(item.parent, {})[item.id] = None
        for hyperedge in program.hyperedges:
            self._join(hyperedge)

    @property
    def names(self) -> dict[str, str]:
        """New ids of items that had others at the start, and those."""
        return _others(self._origins)

    @property
    def hyperedge_names(self) -> dict[str, str]:
        """New ids of hyperedges that had others at the start, and those."""
        return _others(self._hyperedge_origins)

    def freeze(self) -> Program:
        """The program as it is now; nobody has checked it."""
        constraints = tuple(self._constraints)
        layout = self.program.layout
        if constraints != layout.constraints:
            layout = layout.model_copy(update={"constraints": constraints})
        return self.program.model_copy(
            update={
                "items": tuple(self.items.values()),
                "hyperedges": tuple(self.hyperedges.values()),
                "layout": layout,
            }
        )

    def set_program(self, program: Program) -> None:
        """Take everything but items and hyperedges from ``program``."""
        self.program = program
        self._constraints = list(program.layout.constraints)

    def contents(self, name: str | None) -> tuple[str, ...]:
        """Ids of the items whose parent this is."""
        return tuple(self._contents.get(name, ()))

    def within(self, name: str) -> Iterator[str]:
        """Ids of an item and of all that it contains, however deep."""
        waiting = [name]
        while waiting:
            here = waiting.pop()
            yield here
            waiting.extend(self.contents(here))

    def put_item(self, item: Item) -> None:
        """Add an item, or change the one of that id."""
        before = self.items.get(item.id)
        if before is not None:
            del self._contents[before.parent][item.id]
        self.items[item.id] = item
        self._contents.setdefault(item.parent, {})[item.id] = None

    def remove_items(self, names: Collection[str]) -> None:
        """Remove items, with all that they contain among them, and the ends of hyperedges there.

        A hyperedge that has less than two ends left goes too.
        """
        gone = frozenset(names)
        joined = {hyperedge: None for name in names for hyperedge in self._joined_by.get(name, ())}
        for hyperedge in joined:
            ends = self.hyperedges[hyperedge].attachments
            kept = tuple(end for end in ends if end.item not in gone)
            if len(kept) < 2:
                self.remove_hyperedge(hyperedge)
            else:
                self.put_attachments(hyperedge, kept)
        self.leave_line_ups(*names)
        for name in names:
            del self._contents[self.items.pop(name).parent][name]
            self._origins.pop(name, None)

    def rename_item(self, name: str, to: str) -> None:
        """Call an item ``to``, which no other one is called, wherever it stands."""
        item = self.items[name]
        for content in self.contents(name):
            self.put_item(self.items[content].model_copy(update={"parent": to}))
        self._contents[item.parent] = _renamed(self._contents[item.parent], name, to)
        self.items = _renamed(self.items, name, to)
        self.items[to] = item.model_copy(update={"id": to})
        for hyperedge in tuple(self._joined_by.get(name, ())):
            ends = self.hyperedges[hyperedge].attachments
            self.put_attachments(
                hyperedge,
                tuple(
                    end.model_copy(update={"item": to}) if end.item == name else end for end in ends
                ),
            )
        self._constraints = [
            constraint.model_copy(
                update={"items": tuple(to if one == name else one for one in constraint.items)}
            )
            if name in constraint.items
            else constraint
            for constraint in self._constraints
        ]
        _follow(self._origins, name, to)

    def leave_line_ups(self, *names: str) -> None:
        """Take items out of every row, column or helix; one of a single item is none."""
        leaving = frozenset(names)
        self._constraints = [
            kept for one in self._constraints if (kept := _without(one, leaving)) is not None
        ]

    def put_hyperedge(self, hyperedge: Hyperedge) -> None:
        """Add a hyperedge, or change the one of that id."""
        before = self.hyperedges.get(hyperedge.id)
        if before is not None:
            self._part(before)
        self.hyperedges[hyperedge.id] = hyperedge
        self._join(hyperedge)

    def put_attachments(self, name: str, attachments: tuple[Attachment, ...]) -> None:
        """Let a hyperedge join these."""
        self.put_hyperedge(self.hyperedges[name].model_copy(update={"attachments": attachments}))

    def remove_hyperedge(self, name: str) -> None:
        """Remove a hyperedge."""
        self._part(self.hyperedges.pop(name))
        self._hyperedge_origins.pop(name, None)

    def rename_hyperedge(self, name: str, to: str) -> None:
        """Call a hyperedge ``to``, which no other one is called."""
        hyperedge = self.hyperedges[name]
        self._part(hyperedge)
        self.hyperedges = _renamed(self.hyperedges, name, to)
        self.hyperedges[to] = hyperedge.model_copy(update={"id": to})
        self._join(self.hyperedges[to])
        _follow(self._hyperedge_origins, name, to)

    def _join(self, hyperedge: Hyperedge) -> None:
        for end in hyperedge.attachments:
            self._joined_by.setdefault(end.item, {})[hyperedge.id] = None

    def _part(self, hyperedge: Hyperedge) -> None:
        for end in hyperedge.attachments:
            self._joined_by[end.item].pop(hyperedge.id, None)


def _renamed(parts: dict[str, Entry], name: str, to: str) -> dict[str, Entry]:
    """The same in the same order, with another key for one."""
    return {to if key == name else key: part for key, part in parts.items()}


def _follow(origins: dict[str, str], name: str, to: str) -> None:
    if name in origins:
        origins[to] = origins.pop(name)


def _others(origins: Mapping[str, str]) -> dict[str, str]:
    return {name: origin for name, origin in origins.items() if name != origin}


def _without(constraint: Constraint, names: frozenset[str]) -> Constraint | None:
    if names.isdisjoint(constraint.items):
        return constraint
    kept = tuple(one for one in constraint.items if one not in names)
    return constraint.model_copy(update={"items": kept}) if len(kept) > 1 else None
