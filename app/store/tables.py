"""The tables. Times are whole milliseconds since 1970; what changes here needs a migration."""

from __future__ import annotations

from sqlalchemy import (
    BigInteger,
    Column,
    Float,
    ForeignKey,
    Index,
    Integer,
    LargeBinary,
    MetaData,
    String,
    Table,
    Text,
)

metadata = MetaData(
    naming_convention={
        "pk": "pk_%(table_name)s",
        "ix": "ix_%(table_name)s_%(column_0_name)s",
        "uq": "uq_%(table_name)s_%(column_0_name)s",
        "fk": "fk_%(table_name)s_%(column_0_name)s",
    }
)

programs = Table(
    "programs",
    metadata,
    Column("id", String(200), primary_key=True),
    Column("revision", Integer, nullable=False, doc="The newest one's number."),
    Column("created_at", BigInteger, nullable=False),
    Column("updated_at", BigInteger, nullable=False),
    Column("deleted_at", BigInteger, doc="The row stays, so that numbers go on after a new start."),
)

revisions = Table(
    "revisions",
    metadata,
    Column("program", ForeignKey("programs.id", ondelete="CASCADE"), primary_key=True),
    Column("number", Integer, primary_key=True, autoincrement=False),
    Column("cause", String(20), nullable=False, doc="put, patch, edit, undo, redo or delete."),
    Column("name", String(500)),
    Column("items", Integer, nullable=False),
    Column("hyperedges", Integer, nullable=False),
    Column("digest", String(64), nullable=False, doc="Of document and layout."),
    Column("document", LargeBinary, nullable=False, doc="In canonical form, deflated."),
    Column("layout", LargeBinary, nullable=False, doc="As app.layout_record writes it."),
    Column("changes", Text, nullable=False, doc="Since the revision before, as JSON."),
    Column("undo_to", Integer, doc="The revision whose content an undo restores."),
    Column("redo_to", Integer, doc="The revision whose content a redo restores."),
    Column("created_at", BigInteger, nullable=False),
    Column("stopped_by", String(20), doc="What ended the layout early: deadline, or nothing."),
)

requests = Table(
    "requests",
    metadata,
    Column("id", String(64), primary_key=True, doc="Digest of who asked what by which key."),
    Column("fingerprint", String(64), nullable=False, doc="Digest of the body."),
    Column("status", Integer, nullable=False),
    Column("headers", Text, nullable=False, doc="Of the answer, as JSON."),
    Column("body", LargeBinary, nullable=False),
    Column("created_at", BigInteger, nullable=False, index=True),
)
"""Answers to requests that came with an Idempotency-Key."""

jobs = Table(
    "jobs",
    metadata,
    Column("id", String(32), primary_key=True),
    Column("state", String(10), nullable=False, doc="waiting, running, done, failed, cancelled."),
    Column("digest", String(64), nullable=False, index=True, doc="Of document and options."),
    Column("owner", String(32), doc="The key that asked."),
    Column("document", LargeBinary, nullable=False),
    Column("layout", LargeBinary, doc="Of a stored program."),
    Column("options", Text, nullable=False, doc="As JSON."),
    Column("attempts", Integer, nullable=False, default=0),
    Column("stage", String(100)),
    Column("share", Float, nullable=False, default=0.0),
    Column("problem", Text, doc="What went wrong, as JSON."),
    Column("result", String(64), doc="Key of a result."),
    Column("deadline_seconds", Float, nullable=False),
    Column("created_at", BigInteger, nullable=False),
    Column("started_at", BigInteger),
    Column("finished_at", BigInteger),
    Column("leased_by", String(32), doc="The service that works on it."),
    Column("leased_until", BigInteger),
    Index("ix_jobs_state_created_at", "state", "created_at"),
)

results = Table(
    "results",
    metadata,
    Column("key", String(64), primary_key=True),
    Column("media_type", String(100), nullable=False),
    Column("notes", Text, nullable=False, doc="What else is to be said of it, as JSON."),
    Column("size", BigInteger, nullable=False),
    Column("created_at", BigInteger, nullable=False),
    Column("used_at", BigInteger, nullable=False, index=True),
    Column("kept_until", BigInteger, nullable=False, default=0, doc="A job's result."),
)
"""What is in the object store, so that it can be kept within bounds."""

keys = Table(
    "keys",
    metadata,
    Column("id", String(32), primary_key=True),
    Column("hash", String(64), nullable=False, unique=True),
    Column("name", String(200), nullable=False),
    Column("scopes", Text, nullable=False, doc="Names with blanks between them."),
    Column("created_at", BigInteger, nullable=False),
    Column("used_at", BigInteger),
    Column("revoked_at", BigInteger),
)
