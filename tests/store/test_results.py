"""Results in real folders and in memory, with a real database."""

from __future__ import annotations

import asyncio
import os
import socket
import time
from collections.abc import Callable, Coroutine, Iterator
from pathlib import Path
from typing import Any

import pytest
from sqlalchemy import delete

from app.errors import StoreUnavailable
from app.store import results as module
from app.store.database import Database
from app.store.results import Result, Results
from app.store.tables import results as results_table

KEYS = [f"{number:064x}" for number in range(8)]
JSON = "application/json"
FAR = 4_000_000_000_000
"""Later than now, in milliseconds since 1970."""

Work = Callable[[Results], Coroutine[Any, Any, None]]


@pytest.fixture(params=["sqlite", "postgresql"])
def database(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[Database]:
    """One without results."""
    if request.param == "sqlite":
        found = Database(f"sqlite:///{tmp_path / 'a.db'}")
    else:
        found = Database(request.getfixturevalue("postgres").url)
    found.migrate()
    found.do(lambda connection: connection.execute(delete(results_table)))
    yield found
    found.close()


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Of results."""
    return tmp_path / "results"


def do(place: str | Path, database: Database, work: Work, most_bytes: int = 10_000) -> None:
    """Open results, do ``work`` with them, close them."""

    async def all_of_it() -> None:
        async with Results(place, database, most_bytes) as results:
            await work(results)

    asyncio.run(all_of_it())


def files(folder: Path) -> list[Path]:
    """What lies there."""
    return sorted(path for path in folder.rglob("*") if path.is_file())


def age(path: Path) -> None:
    """Let a file be an hour old."""
    then = time.time() - 3600
    os.utime(path, (then, then))


@pytest.mark.parametrize("place", ["folder", "file", "memory"])
def test_what_is_put_can_be_had_again(place: str, folder: Path, database: Database) -> None:
    places: dict[str, str | Path] = {"file": folder.as_uri(), "memory": "memory://"}

    async def work(results: Results) -> None:
        assert await results.get(KEYS[0]) is None
        await results.put(KEYS[0], (b"ab", b"c"), JSON, {"name": "Ä", "etag": "1"})
        assert await results.get(KEYS[0]) == Result((b"abc",), JSON, {"name": "Ä", "etag": "1"})
        assert await results.get(KEYS[1]) is None

    do(places.get(place, folder), database, work)


def test_an_empty_body_and_one_of_many_pieces_stay_what_they_are(
    folder: Path, database: Database
) -> None:
    large = os.urandom(9_000_000)

    async def work(results: Results) -> None:
        await results.put(KEYS[0], (), JSON, {})
        await results.put(KEYS[1], (large[:5_000_000], large[5_000_000:]), JSON, {})
        empty, whole = await results.get(KEYS[0]), await results.get(KEYS[1])
        assert empty is not None
        assert empty.size == 0
        assert whole is not None
        assert len(whole.pieces) == 3
        assert b"".join(whole.pieces) == large

    do(folder, database, work, most_bytes=10**8)


def test_results_outlive_the_service(folder: Path, database: Database) -> None:
    async def write(results: Results) -> None:
        await results.put(KEYS[0], (b"abc",), JSON, {})

    async def read(results: Results) -> None:
        assert await results.get(KEYS[0]) == Result((b"abc",), JSON, {})

    do(folder, database, write)
    do(folder, database, read)


def test_over_the_bound_the_one_goes_that_was_used_the_longest_ago(
    folder: Path, database: Database
) -> None:
    async def work(results: Results) -> None:
        for key in KEYS[:3]:
            await results.put(key, (bytes(300),), JSON, {})
            await asyncio.sleep(0.003)  # the time is known to the millisecond
        assert await results.get(KEYS[0]) is not None
        await results.put(KEYS[3], (bytes(300),), JSON, {})
        there = [await results.get(key) is not None for key in KEYS[:4]]
        assert there == [True, False, True, True]

    do(folder, database, work, most_bytes=1000)
    assert len(files(folder)) == 3


def test_a_use_is_remembered_beyond_the_end_of_a_service(folder: Path, database: Database) -> None:
    async def write(results: Results) -> None:
        for key in KEYS[:3]:
            await results.put(key, (bytes(300),), JSON, {})
            await asyncio.sleep(0.003)
        results.touch(KEYS[0])

    async def write_more(results: Results) -> None:
        await results.put(KEYS[3], (bytes(300),), JSON, {})
        assert await results.get(KEYS[0]) is not None

    do(folder, database, write, most_bytes=1000)
    do(folder, database, write_more, most_bytes=1000)


def test_what_is_kept_until_later_stays(folder: Path, database: Database) -> None:
    async def work(results: Results) -> None:
        await results.put(KEYS[0], (bytes(300),), JSON, {}, kept_until=FAR)
        await results.put(KEYS[1], (bytes(300),), JSON, {}, kept_until=1)
        assert await results.keep(KEYS[1], FAR)
        assert not await results.keep(KEYS[7], FAR)
        await results.put(KEYS[1], (bytes(300),), JSON, {})
        for key in KEYS[2:6]:
            await asyncio.sleep(0.003)
            await results.put(key, (bytes(300),), JSON, {})
        there = [await results.get(key) is not None for key in KEYS[:6]]
        assert there == [True, True, False, False, False, True]

    do(folder, database, work, most_bytes=1000)


def test_what_is_larger_than_the_store_is_kept_only_if_it_must_be(
    folder: Path, database: Database
) -> None:
    async def work(results: Results) -> None:
        await results.put(KEYS[0], (bytes(2000),), JSON, {})
        await results.put(KEYS[1], (bytes(2000),), JSON, {}, kept_until=FAR)
        assert await results.get(KEYS[0]) is None
        assert await results.get(KEYS[1]) is not None

    do(folder, database, work, most_bytes=1000)


@pytest.mark.parametrize("harm", ["cut", "changed", "gone"])
def test_a_broken_object_is_a_miss_and_can_be_put_again(
    harm: str, folder: Path, database: Database
) -> None:
    async def work(results: Results) -> None:
        await results.put(KEYS[0], (b"abcdef",), JSON, {})
        (file,) = files(folder)
        if harm == "gone":
            file.unlink()
        else:
            file.write_bytes(b"abc" if harm == "cut" else b"abcdeg")
        assert await results.get(KEYS[0]) is None
        assert files(folder) == []
        await results.put(KEYS[0], (b"abcdef",), JSON, {})
        assert await results.get(KEYS[0]) is not None

    do(folder, database, work)


def test_two_services_share_a_folder_and_a_database(folder: Path, database: Database) -> None:
    async def all_of_it() -> None:
        async with (
            Results(folder, database, 10_000) as one,
            Results(folder, database, 10_000) as other,
        ):
            await one.put(KEYS[0], (b"abc",), JSON, {})
            assert await other.get(KEYS[0]) is not None
            await asyncio.gather(
                *(each.put(key, (key.encode(),), JSON, {}) for key in KEYS for each in (one, other))
            )
            for key in KEYS:
                assert await one.get(key) == Result((key.encode(),), JSON, {})
            await other.put(KEYS[0], (b"new",), JSON, {})
            assert await one.get(KEYS[0]) == Result((b"new",), JSON, {})

    asyncio.run(all_of_it())
    assert len(files(folder)) == len(KEYS)


def test_what_a_crash_left_is_deleted_at_the_next_start(folder: Path, database: Database) -> None:
    async def write(results: Results) -> None:
        await results.put(KEYS[0], (b"abc",), JSON, {})

    async def clean(results: Results) -> None:
        await results.clean()
        assert await results.get(KEYS[0]) is not None

    do(folder, database, write)
    (kept,) = files(folder)
    orphan, young = kept.with_name(f"{KEYS[1]}.{'a' * 32}"), kept.with_name(f"{KEYS[2]}.{'a' * 32}")
    unfinished = kept.with_name(f"{KEYS[3]}.{'a' * 32}#1")
    for path in (orphan, young, unfinished):
        path.write_bytes(b"whatever")
    for path in (kept, orphan, unfinished):
        age(path)
    do(folder, database, clean)
    assert files(folder) == [kept, young]


def test_a_row_whose_object_is_gone_is_deleted_at_the_next_start(
    folder: Path, database: Database, monkeypatch: pytest.MonkeyPatch
) -> None:
    async def write(results: Results) -> None:
        await results.put(KEYS[0], (b"abc",), JSON, {})

    async def clean(results: Results) -> None:
        await results.clean()
        assert not await results.keep(KEYS[0], FAR)

    do(folder, database, write)
    files(folder)[0].unlink()
    monkeypatch.setattr(module, "ORPHAN_SECONDS", -1.0)
    do(folder, database, clean)


def test_keys_and_places_that_cannot_be_are_refused(folder: Path, database: Database) -> None:
    async def work(results: Results) -> None:
        for key in ("../../etc/passwd", "a", KEYS[0].upper().replace("0", "A")):
            with pytest.raises(ValueError, match="64 hexadecimal digits"):
                await results.get(key)

    do(folder, database, work)
    with pytest.raises(ValueError, match="nonsense"):
        Results("nonsense://x", database, 1)


def test_a_store_that_does_not_answer_is_a_miss(
    folder: Path, database: Database, monkeypatch: pytest.MonkeyPatch
) -> None:
    async def write(results: Results) -> None:
        await results.put(KEYS[0], (b"abc",), JSON, {})

    async def read(results: Results) -> None:
        assert await results.get(KEYS[0]) is None

    do(folder, database, write)
    with socket.create_server(("127.0.0.1", 0)) as silent:
        monkeypatch.setenv("AWS_ENDPOINT_URL", f"http://127.0.0.1:{silent.getsockname()[1]}")
        for name in ("AWS_ACCESS_KEY_ID", "AWS_SECRET_ACCESS_KEY", "AWS_DEFAULT_REGION"):
            monkeypatch.setenv(name, "a")
        monkeypatch.setenv("AWS_ALLOW_HTTP", "true")
        do("s3://bucket/results", database, read)
    do(folder, database, write)


def test_a_store_that_is_not_there_is_told_to_who_puts(
    database: Database, monkeypatch: pytest.MonkeyPatch
) -> None:
    async def work(results: Results) -> None:
        with pytest.raises(StoreUnavailable):
            await results.put(KEYS[0], (b"abc",), JSON, {})
        assert await results.get(KEYS[0]) is None

    with socket.create_server(("127.0.0.1", 0)) as gone:
        port = gone.getsockname()[1]
    monkeypatch.setenv("AWS_ENDPOINT_URL", f"http://127.0.0.1:{port}")
    for name in ("AWS_ACCESS_KEY_ID", "AWS_SECRET_ACCESS_KEY", "AWS_DEFAULT_REGION"):
        monkeypatch.setenv(name, "a")
    monkeypatch.setenv("AWS_ALLOW_HTTP", "true")
    do("s3://bucket/results", database, work)
