"""Messages between the service and its workers: a pickled head, and raw bytes after it.

Documents and answers travel as raw bytes, so that hundreds of megabytes are copied once. Both
ends are our own processes, joined by a socket that nobody else can reach; hence pickle.
"""

from __future__ import annotations

import asyncio
import pickle
import socket
import struct
from typing import Any

_LENGTHS = struct.Struct("!QQ")
"""Of the head and of the payload, in bytes."""

_PIECE = 1 << 20
"""How much an event loop reads at a time: so little that others are not kept waiting."""


def pack(head: object, payload_bytes: int) -> bytes:
    """The start of a message whose payload of so many bytes follows."""
    pickled = pickle.dumps(head, protocol=5)
    return _LENGTHS.pack(len(pickled), payload_bytes) + pickled


def send(end: socket.socket, head: object, payload: bytes = b"") -> None:
    """Send a message from a worker. Raises `OSError` when nobody listens any more."""
    end.sendall(pack(head, len(payload)))
    if payload:
        end.sendall(payload)


def receive(end: socket.socket) -> tuple[Any, bytes]:
    """Wait for a message in a worker.

    Raises `EOFError` when nobody sends any more, and `MemoryError` where the message is too large,
    all of which has been read then.
    """
    head_bytes, payload_bytes = _LENGTHS.unpack(_exactly(end, _LENGTHS.size))
    try:
        head = pickle.loads(_exactly(end, head_bytes))  # noqa: S301 - from our own process
    except MemoryError:
        _skip(end, payload_bytes)
        raise
    return head, bytes(_exactly(end, payload_bytes))


def post(writer: asyncio.StreamWriter, head: object, payload: bytes = b"") -> None:
    """Send a message from the service, without waiting."""
    writer.write(pack(head, len(payload)))
    if payload:
        writer.write(payload)


async def listen(reader: asyncio.StreamReader) -> tuple[Any, tuple[bytes, ...]]:
    """Wait for a message in the service. Raises `EOFError` when the worker has gone.

    The payload comes in the pieces in which it arrived: to join hundreds of megabytes would keep
    everybody else waiting.
    """
    lengths = await reader.readexactly(_LENGTHS.size)
    head_bytes, missing = _LENGTHS.unpack(lengths)
    head = pickle.loads(await reader.readexactly(head_bytes))  # noqa: S301 - from our own process
    pieces = []
    while missing:
        piece = await reader.read(min(_PIECE, missing))
        if not piece:
            raise EOFError
        pieces.append(piece)
        missing -= len(piece)
    return head, tuple(pieces)


def _exactly(end: socket.socket, size: int) -> bytearray:
    try:
        data = bytearray(size)
    except MemoryError:
        _skip(end, size)
        raise
    view, filled = memoryview(data), 0
    while filled < size:
        got = end.recv_into(view[filled:])
        if not got:
            raise EOFError
        filled += got
    return data


def _skip(end: socket.socket, size: int) -> None:
    """Read so many bytes, and forget them."""
    while size:
        got = len(end.recv(min(size, 1 << 16)))
        if not got:
            raise EOFError
        size -= got
