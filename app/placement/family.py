"""Who contains whom."""

from __future__ import annotations

from dataclasses import dataclass

from app.program.model import Program


@dataclass(frozen=True, slots=True)
class Family:
    """Items by number: ``parents`` (-1 for a root), ``children``, ``roots``.

    ``order`` holds all items, parents before children.
    """

    parents: tuple[int, ...]
    children: tuple[tuple[int, ...], ...]
    roots: tuple[int, ...]
    order: tuple[int, ...]


def family(program: Program) -> Family:
    """Containment in a checked program."""
    numbers = {item.id: number for number, item in enumerate(program.items)}
    parents = tuple(-1 if item.parent is None else numbers[item.parent] for item in program.items)
    children: list[list[int]] = [[] for _ in parents]
    roots: list[int] = []
    for number, parent in enumerate(parents):
        (roots if parent < 0 else children[parent]).append(number)
    order = list(roots)
    for number in order:
        order.extend(children[number])
    return Family(parents, tuple(map(tuple, children)), tuple(roots), tuple(order))
