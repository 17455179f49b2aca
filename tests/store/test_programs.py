"""Stored programs in a real SQLite and a real PostgreSQL."""

from __future__ import annotations

import hashlib
import time
from collections.abc import Iterator
from functools import partial
from pathlib import Path

import pytest

from app.answers import Revised
from app.errors import Outdated
from app.program.changes import Changes, Differences
from app.store import programs, requests
from app.store.database import Database
from app.store.records import Head, Record
from app.store.requests import Reply


@pytest.fixture(params=["sqlite", "postgresql"])
def database(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[Database]:
    if request.param == "sqlite":
        url = f"sqlite:///{tmp_path / 'programs.db'}"
    else:
        url = request.getfixturevalue("postgres").url
    database = Database(url)
    database.migrate()
    yield database
    database.close()


@pytest.fixture
def name(request: pytest.FixtureRequest) -> str:
    """An id that no other test has."""
    return f"{request.node.name.partition('[')[0]}-{time.time_ns()}"


def revised(text: str, changes: Changes | None = None) -> Revised:
    return Revised(
        text.encode(),
        b"layout of " + text.encode(),
        hashlib.sha256(text.encode()).hexdigest(),
        name=text,
        items=1,
        hyperedges=0,
        changes=changes or Changes(Differences(added=(text,))),
    )


def add(
    database: Database, name: str, before: Head | None, text: str, keep: int = 100, at: int = 1000
) -> Record:
    return database.do(
        lambda connection: programs.add(
            connection, name, before, "put", revised(text), keep=keep, at=at
        )
    )


def test_what_is_added_is_found_again(database: Database, name: str) -> None:
    record = add(database, name, None, "first")
    content = database.do(partial(programs.load, program=name))
    assert content is not None
    assert content.record == record == database.do(partial(programs.newest, program=name))
    assert content.document == b"first"
    assert content.layout == b"layout of first"
    assert (record.number, record.items, record.changes.items.added) == (1, 1, ("first",))
    assert name in [one.id for one in database.do(lambda c: programs.listing(c, None, 1000))]


def test_only_one_of_two_follows_a_revision(database: Database, name: str) -> None:
    add(database, name, None, "first")
    with pytest.raises(Outdated):
        add(database, name, None, "also first")
    head = database.do(partial(programs.head, program=name))
    assert add(database, name, head, "second").number == 2
    with pytest.raises(Outdated):
        add(database, name, head, "also second")
    assert database.do(partial(programs.head, program=name)) == Head(2, is_deleted=False)


def test_a_change_that_is_stored_twice_is_one(database: Database, name: str) -> None:
    """The connection broke when it was committed, so it is tried again."""
    first = add(database, name, None, "first", at=17)
    assert add(database, name, None, "first", at=17) == first
    assert database.do(partial(programs.head, program=name)) == Head(1, is_deleted=False)


def test_a_name_may_have_any_characters(database: Database, name: str) -> None:
    add(database, name, None, "nul \0 and emoji \N{PIG NOSE}")
    record = database.do(partial(programs.newest, program=name))
    assert record is not None
    assert record.name == "nul \N{REPLACEMENT CHARACTER} and emoji \N{PIG NOSE}"
    assert record.changes.items.added == ("nul \0 and emoji \N{PIG NOSE}",)


def test_as_many_revisions_are_kept_as_are_wanted(database: Database, name: str) -> None:
    head = None
    for number in range(1, 8):
        add(database, name, head, str(number), keep=3)
        head = Head(number, is_deleted=False)
    kept = database.do(partial(programs.kept_after, program=name, number=0))
    assert [record.number for record in kept] == [5, 6, 7]
    assert database.do(partial(programs.load, program=name, number=4)) is None
    old = database.do(partial(programs.load, program=name, number=5))
    assert old is not None
    assert old.document == b"5"


def test_a_change_in_many_steps_takes_no_place_from_others(database: Database, name: str) -> None:
    head = None
    for number in range(1, 31):
        is_step = number > 10
        database.do(
            partial(
                programs.add,
                program=name,
                before=head,
                cause="edit",
                revised=revised(str(number)),
                undo_to=9 if is_step else number - 1,
                keep=8,
                at=1000,
            )
        )
        head = Head(number, is_deleted=False)
    kept = database.do(partial(programs.kept_after, program=name, number=0))
    assert [record.number for record in kept] == [5, 6, 7, 8, 9, 29, 30]
    add(database, name, head, "another", keep=8)
    add(database, name, Head(31, is_deleted=False), "and another", keep=8)
    kept = database.do(partial(programs.kept_after, program=name, number=0))
    assert [record.number for record in kept] == [5, 6, 7, 8, 9, 30, 31, 32]


def test_numbers_go_on_after_a_program_was_deleted(database: Database, name: str) -> None:
    add(database, name, None, "first")
    first = Head(1, is_deleted=False)
    record = database.do(lambda connection: programs.end(connection, name, first, 5))
    assert (record.number, record.cause) == (2, "delete")
    assert database.do(partial(programs.load, program=name)) is None
    assert database.do(partial(programs.load, program=name, number=1)) is None
    assert database.do(partial(programs.load, program=name, number=2)) is None
    assert name not in [one.id for one in database.do(lambda c: programs.listing(c, None, 1000))]
    deleted = database.do(partial(programs.head, program=name))
    assert deleted == Head(2, is_deleted=True)
    assert add(database, name, deleted, "anew").number == 3
    assert database.do(partial(programs.heads, names=[name, "no such"])) == {name: 3}


def test_a_list_goes_on_where_it_ended(database: Database, name: str) -> None:
    names = [f"{name}-{number}" for number in range(5)]
    for each in names:
        add(database, each, None, each)
    page = database.do(lambda connection: programs.listing(connection, f"{name}-1", 2))
    assert [one.id for one in page] == names[2:4]


def test_an_answer_is_kept_once(database: Database, name: str) -> None:
    reply = Reply("what was asked", 201, {"ETag": '"1"'}, b"{}")
    assert database.do(lambda connection: requests.find(connection, name[-64:])) is None
    database.do(lambda connection: requests.keep(connection, name[-64:], reply))
    assert database.do(lambda connection: requests.find(connection, name[-64:])) == reply
    with pytest.raises(Outdated):
        database.do(lambda connection: requests.keep(connection, name[-64:], reply))
