"""Answers at hand: those used last, in the service's own memory."""

from __future__ import annotations

from collections import OrderedDict
from typing import TypeAlias

from app.answers import Answer

Kept: TypeAlias = tuple[Answer, tuple[bytes, ...]]
"""An answer without its body, and its body in pieces."""

LARGEST_SHARE = 4
"""What is larger than this part of a store is not kept in it: too much else would have to go."""

OVERHEAD_BYTES = 2048
"""What an answer takes beside its body, so that very many small ones count too."""


class Memory:
    """Answers by their keys, of at most ``most_bytes`` together."""

    def __init__(self, most_bytes: int) -> None:
        self._most, self._bytes = most_bytes, 0
        self._kept: OrderedDict[str, Kept] = OrderedDict()

    def get(self, key: str) -> Kept | None:
        """What is kept under this key; it is used last then."""
        if (found := self._kept.get(key)) is not None:
            self._kept.move_to_end(key)
        return found

    def put(self, key: str, kept: Kept) -> None:
        """Keep it; what was used the longest ago goes where there is too much."""
        if _size(kept) * LARGEST_SHARE > self._most:
            return
        if (before := self._kept.pop(key, None)) is not None:
            self._bytes -= _size(before)
        self._kept[key] = kept
        self._bytes += _size(kept)
        while self._bytes > self._most:
            _, gone = self._kept.popitem(last=False)
            self._bytes -= _size(gone)


def _size(kept: Kept) -> int:
    return sum(map(len, kept[1])) + OVERHEAD_BYTES
