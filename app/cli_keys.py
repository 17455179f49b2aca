"""Keys on the command line: the only place where they are made and ended."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

import click

from app.api.scopes import Scope
from app.errors import TubeloomError
from app.settings import Settings

if TYPE_CHECKING:
    from app.store.database import Database


@click.group()
def keys() -> None:
    """Make, list and revoke API keys."""


@keys.command()
@click.argument("name")
@click.option(
    "--scope",
    "scopes",
    type=click.Choice([scope.value for scope in Scope]),
    multiple=True,
    required=True,
    help="What the key is good for; may stand several times.",
)
def create(name: str, scopes: tuple[str, ...]) -> None:
    """Make a key called NAME and write it to standard output, this once."""
    from app.store import keys as stored

    with _database() as database:
        key, secret = database.do(lambda connection: stored.create(connection, name, scopes))
    click.echo(secret)
    click.echo(f"Key {key.id} ({name}). It is shown only now; keep it well.", err=True)


@keys.command("list")
def list_() -> None:
    """List all keys, without what makes them secret."""
    from app.store import keys as stored

    with _database() as database:
        found = database.do(stored.all_keys, writes=False)
    for key in found:
        state = f"revoked {_day(key.revoked_at)}" if key.revoked_at else f"used {_day(key.used_at)}"
        scopes = ",".join(sorted(key.scopes))
        click.echo(f"{key.id}  {scopes:30}  made {_day(key.created_at)}  {state:20}  {key.name}")


@keys.command()
@click.argument("key_id", metavar="ID")
def revoke(key_id: str) -> None:
    """End the key ID, as `list` shows it. Running services notice within seconds."""
    from app.store import keys as stored

    with _database() as database:
        ended = database.do(lambda connection: stored.revoke(connection, key_id))
    if not ended:
        raise click.ClickException(f"There is no valid key {key_id}.")


@contextmanager
def _database() -> Iterator[Database]:
    from app.store.database import Database

    database = Database(Settings().database_url)
    try:
        database.migrate()
        yield database
    except TubeloomError as error:
        raise click.ClickException(str(error)) from error
    finally:
        database.close()


def _day(milliseconds: int | None) -> str:
    if milliseconds is None:
        return "never"
    return time.strftime("%Y-%m-%d", time.gmtime(milliseconds / 1000))
