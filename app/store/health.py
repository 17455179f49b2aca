"""Whether the database answers."""

from __future__ import annotations

from sqlalchemy import Connection, select

from app.store.tables import keys


def check(connection: Connection) -> None:
    """Read something that is really stored. Raises whatever stands in the way."""
    connection.execute(select(keys.c.id).limit(1)).all()
