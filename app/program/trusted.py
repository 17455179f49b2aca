"""What is the same as in a program that has been checked, and needs no check again."""

from __future__ import annotations

from dataclasses import dataclass

from app.program.model import Item, Program


@dataclass(frozen=True, slots=True)
class Trusted:
    """Items and hyperedges by their `id()`, which are right as they are in the program.

    ``parents``: no chain of parents can have become wrong; ``all_hyperedges``: there are no others.
    """

    items: frozenset[int]
    hyperedges: frozenset[int]
    parents: bool
    all_hyperedges: bool

    @classmethod
    def nothing(cls) -> Trusted:
        """Everything has to be checked."""
        return cls(frozenset(), frozenset(), parents=False, all_hyperedges=False)

    @classmethod
    def of(cls, program: Program, checked: Program) -> Trusted:
        """What is the very same in both. A hyperedge is, if the items that it attaches to are."""
        items = frozenset(map(id, checked.items))
        changed = [item for item in program.items if id(item) not in items]
        present = frozenset(map(id, program.items))
        gone = [item for item in checked.items if id(item) not in present]
        touched = {item.id for item in (*changed, *gone)}
        before = frozenset(map(id, checked.hyperedges))
        hyperedges = frozenset(
            id(each)
            for each in program.hyperedges
            if id(each) in before
            and not (touched and any(end.item in touched for end in each.attachments))
        )
        return cls(
            items,
            hyperedges,
            parents=_keep_their_parents(changed, gone),
            all_hyperedges=len(hyperedges) == len(program.hyperedges),
        )


def _keep_their_parents(changed: list[Item], gone: list[Item]) -> bool:
    """Whether each item that has changed contains, and is contained by, what it was before."""
    parents = {item.id: item.parent for item in gone}
    return len(parents) == len(changed) == len(gone) and all(
        item.id in parents and parents[item.id] == item.parent for item in changed
    )
