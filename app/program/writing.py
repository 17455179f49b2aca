"""Canonical forms of one state of a program after another: what has not changed is written once."""

from __future__ import annotations

from app.program.base import Part
from app.program.digest import canonical
from app.program.model import Program

_BEFORE = {"name", "notation"}
_AFTER = set(Program.model_fields) - _BEFORE - {"items", "hyperedges"}
"""What stands in the model before and after the items and the hyperedges."""


class Writer:
    """Knows the text of each item and hyperedge of the program that it wrote last."""

    def __init__(self, most: int = 8_000) -> None:
        self._most = most
        self._known: dict[int, tuple[Part, str]] = {}

    def write(self, program: Program) -> bytes:
        """What `app.program.digest.canonical` makes of it.

        Of more items and hyperedges together than ``most`` nothing is kept.
        """
        if len(program.items) + len(program.hyperedges) > self._most:
            self._known = {}
            return canonical(program)
        known: dict[int, tuple[Part, str]] = {}
        lists: list[str] = []
        for name, parts in (("items", program.items), ("hyperedges", program.hyperedges)):
            texts: list[str] = []
            for part in parts:
                # Parts of other programs may be at the same place in memory.
                kept = self._known.get(id(part))
                if kept is None or kept[0] is not part:
                    kept = part, part.model_dump_json(exclude_defaults=True)
                known[id(part)] = kept
                texts.append(kept[1])
            if texts or name == "items":
                lists.append(f'"{name}":[{",".join(texts)}]')
        self._known = known
        around = [
            program.model_dump_json(exclude_defaults=True, include=names)[1:-1]
            for names in (_BEFORE, _AFTER)
        ]
        inner = ",".join(text for text in (around[0], *lists, around[1]) if text)
        return f"{{{inner}}}".encode()
