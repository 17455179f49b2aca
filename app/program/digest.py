"""A program's one canonical form: the same for documents that mean the same."""

from __future__ import annotations

import hashlib

from app.program.model import Program


def canonical(program: Program) -> bytes:
    """The program as JSON in UTF-8, without blanks and without what equals its default.

    Keys stand in the model's order, and in `app.program.base.Data` in alphabetical order; numbers
    are floats, whole or not. So key order, 1 for 1.0 and defaults written out make no difference,
    the order of items does. In ``data``, which goes out as it came in, 1 and 1.0 differ.
    """
    return program.model_dump_json(exclude_defaults=True).encode()


def digest(program: Program) -> str:
    """SHA-256 of the canonical form, in hexadecimal."""
    return hashlib.sha256(canonical(program)).hexdigest()
