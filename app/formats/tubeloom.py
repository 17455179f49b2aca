"""Our own document."""

from __future__ import annotations

from app.program.model import Program


def write(program: Program) -> bytes:
    """The program as indented JSON, without what equals its default."""
    return program.model_dump_json(indent=1, exclude_defaults=True).encode() + b"\n"
