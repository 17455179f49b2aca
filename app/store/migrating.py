"""Brings the tables of a database to their newest form."""

from __future__ import annotations

from pathlib import Path

from sqlalchemy import Connection, text

MIGRATIONS = Path(__file__).with_name("migrations")

LOCK = 7_118_252
"""Of PostgreSQL, so that services which start together migrate one after another."""


def upgrade(connection: Connection) -> None:
    """Do all migrations that this database has not seen."""
    from alembic import command
    from alembic.config import Config

    if connection.dialect.name == "postgresql":
        connection.execute(text("SELECT pg_advisory_xact_lock(:lock)"), {"lock": LOCK})
    config = Config()
    config.set_main_option("script_location", str(MIGRATIONS))
    config.attributes["connection"] = connection
    command.upgrade(config, "head")
