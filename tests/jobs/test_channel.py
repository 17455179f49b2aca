import asyncio
import socket
import threading

import pytest

from app.answers import Answer, RenderOptions
from app.errors import Fault, InvalidDocument, PictureTooLarge, UnknownName
from app.jobs import channel
from app.jobs.work import Reply, Work
from tests.service import PATIENCE_SECONDS


def test_what_the_service_posts_a_worker_receives() -> None:
    work, document = Work(RenderOptions(), frozenset({"a"})), b"x" * 3_000_000

    async def post(end: socket.socket) -> None:
        _, writer = await asyncio.open_unix_connection(sock=end)
        channel.post(writer, work, document)
        await writer.drain()
        writer.close()
        await writer.wait_closed()

    ours, theirs = socket.socketpair()
    with theirs:
        posting = threading.Thread(target=lambda: asyncio.run(post(ours)))
        posting.start()
        assert channel.receive(theirs) == (work, document)
        posting.join(PATIENCE_SECONDS)


@pytest.mark.parametrize("size", [0, 1, 5_000_000])
def test_what_a_worker_sends_the_service_hears(size: int) -> None:
    head, body = Reply(Answer(b"", "image/png", "tag", "name")), bytes(size)

    async def hear(end: socket.socket) -> tuple[object, tuple[bytes, ...]]:
        reader, writer = await asyncio.open_unix_connection(sock=end)
        heard = await channel.listen(reader)
        writer.close()
        await writer.wait_closed()
        return heard

    ours, theirs = socket.socketpair()
    with theirs:
        sending = threading.Thread(target=channel.send, args=(theirs, head, body))
        sending.start()
        heard, pieces = asyncio.run(hear(ours))
        assert (heard, b"".join(pieces)) == (head, body)
        sending.join(PATIENCE_SECONDS)


def test_the_end_of_the_other_side_is_noticed_in_the_middle_of_a_message() -> None:
    ours, theirs = socket.socketpair()
    with ours, theirs:
        theirs.sendall(channel.pack("head", 100) + b"half")
        theirs.close()
        with pytest.raises(EOFError):
            channel.receive(ours)


@pytest.mark.parametrize(
    "error",
    [
        InvalidDocument([Fault("/items/0", "Wrong.")]),
        UnknownName("notation", "x", ("plain",)),
        PictureTooLarge("Too large."),
    ],
)
def test_errors_arrive_as_they_were(error: Exception) -> None:
    ours, theirs = socket.socketpair()
    with ours, theirs:
        channel.send(theirs, Reply(error))  # type: ignore[arg-type]  # any of the family
        heard = channel.receive(ours)[0].outcome
    assert (type(heard), str(heard)) == (type(error), str(error))
    assert getattr(heard, "faults", None) == getattr(error, "faults", None)
