"""What differs between two states of a program, by the ids of its items and hyperedges."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import reduce


@dataclass(frozen=True, slots=True)
class Differences:
    """Ids of one kind of things; no id is in two of them."""

    added: tuple[str, ...] = ()
    changed: tuple[str, ...] = ()
    removed: tuple[str, ...] = ()

    @property
    def present(self) -> frozenset[str]:
        """Those of which there is something new to show."""
        return frozenset((*self.added, *self.changed))

    def then(self, newer: Differences) -> Differences:
        """What these and the ``newer`` ones come to together.

        >>> Differences(added=("a", "b")).then(Differences(changed=("a",), removed=("b",)))
        Differences(added=('a',), changed=(), removed=())
        """
        fates: dict[str, str | None] = {}
        for name, fate in (*self._fates(), *newer._fates()):
            before = fates.get(name, "kept")
            match (before, fate):
                case ("added", "changed"):
                    pass
                case ("added", "removed"):
                    fates[name] = None
                case ("removed", "added"):
                    fates[name] = "changed"
                case _:
                    fates[name] = fate
        return Differences(
            *(
                tuple(sorted(name for name, fate in fates.items() if fate == kind))
                for kind in ("added", "changed", "removed")
            )
        )

    def _fates(self) -> list[tuple[str, str]]:
        return [
            *((name, "added") for name in self.added),
            *((name, "changed") for name in self.changed),
            *((name, "removed") for name in self.removed),
        ]


@dataclass(frozen=True, slots=True)
class Changes:
    """What an edit changed: things that are defined, placed or curved otherwise than before.

    ``whole``: so much that all must be shown anew, such as its notation, palette or view.
    """

    items: Differences = field(default_factory=Differences)
    hyperedges: Differences = field(default_factory=Differences)
    whole: bool = False

    def then(self, newer: Changes) -> Changes:
        """These changes and the ``newer`` ones as one."""
        return Changes(
            self.items.then(newer.items),
            self.hyperedges.then(newer.hyperedges),
            self.whole or newer.whole,
        )

    def as_json(self) -> dict[str, object]:
        """As events and answers tell it."""
        return {
            "items": _lists(self.items),
            "hyperedges": _lists(self.hyperedges),
            "whole": self.whole,
        }

    def to_json(self) -> str:
        """As text, for `from_json`."""
        return json.dumps(self.as_json(), ensure_ascii=False)

    @classmethod
    def from_json(cls, text: str) -> Changes:
        """What `to_json` wrote."""
        told = json.loads(text)
        return cls(_differences(told["items"]), _differences(told["hyperedges"]), told["whole"])


def combined(changes: Sequence[Changes]) -> Changes:
    """Changes one after another, as one."""
    return reduce(Changes.then, changes, Changes())


def _lists(differences: Differences) -> dict[str, list[str]]:
    return {
        "added": list(differences.added),
        "changed": list(differences.changed),
        "removed": list(differences.removed),
    }


def _differences(told: Mapping[str, Sequence[str]]) -> Differences:
    return Differences(*(tuple(told[kind]) for kind in ("added", "changed", "removed")))
