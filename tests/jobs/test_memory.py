from __future__ import annotations

from app.answers import Answer
from app.jobs.memory import OVERHEAD_BYTES, Kept, Memory, body_bytes

ROOM = 4 * (1000 + OVERHEAD_BYTES)
"""For four answers of a thousand bytes."""


def kept(size: int) -> Kept:
    """An answer of so many bytes, in two pieces."""
    return Answer(b"", "image/png", "tag"), (bytes(size // 2), bytes(size - size // 2))


def test_what_was_used_the_longest_ago_goes_first() -> None:
    memory = Memory(ROOM, body_bytes)
    for name in "abcd":
        memory.put(name, kept(1000))
    assert memory.get("a") == kept(1000)
    memory.put("e", kept(1000))
    assert [name for name in "abcde" if memory.get(name)] == list("acde")


def test_what_is_put_again_counts_once() -> None:
    memory = Memory(ROOM, body_bytes)
    for _ in range(9):
        memory.put("a", kept(1000))
    for name in "bcd":
        memory.put(name, kept(1000))
    assert all(memory.get(name) for name in "abcd")


def test_what_would_drive_out_too_much_is_not_kept() -> None:
    memory = Memory(ROOM, body_bytes)
    memory.put("a", kept(1001))
    assert memory.get("a") is None
