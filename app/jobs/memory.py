"""What is at hand: what was used last, in the service's own memory."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable
from typing import Generic, TypeAlias, TypeVar

from app.answers import Answer

Value = TypeVar("Value")

Kept: TypeAlias = tuple[Answer, tuple[bytes, ...]]
"""An answer without its body, and its body in pieces."""

LARGEST_SHARE = 4
"""What is larger than this part of a store is not kept in it: too much else would have to go."""

OVERHEAD_BYTES = 2048
"""What an answer takes beside its body, so that very many small ones count too."""


def body_bytes(kept: Kept) -> int:
    """The size of an answer's body."""
    return sum(map(len, kept[1]))


class Memory(Generic[Value]):
    """Values by their keys, of at most ``most_bytes`` together; ``size`` tells that of one."""

    def __init__(self, most_bytes: int, size: Callable[[Value], int]) -> None:
        self._most, self._bytes = most_bytes, 0
        self._size = size
        self._kept: OrderedDict[str, Value] = OrderedDict()

    def get(self, key: str) -> Value | None:
        """What is kept under this key; it is used last then."""
        if (found := self._kept.get(key)) is not None:
            self._kept.move_to_end(key)
        return found

    def put(self, key: str, value: Value) -> None:
        """Keep it; what was used the longest ago goes where there is too much."""
        size = self._bytes_of(value)
        if size * LARGEST_SHARE > self._most:
            return
        if (before := self._kept.pop(key, None)) is not None:
            self._bytes -= self._bytes_of(before)
        self._kept[key] = value
        self._bytes += size
        while self._bytes > self._most:
            _, gone = self._kept.popitem(last=False)
            self._bytes -= self._bytes_of(gone)

    def _bytes_of(self, value: Value) -> int:
        return self._size(value) + OVERHEAD_BYTES
