"""A program's one canonical form: the same for documents that mean the same."""

from __future__ import annotations

import hashlib
import json

from app.program.model import Program


def canonical(program: Program) -> bytes:
    """The program as JSON with sorted keys, no blanks, and without what equals its default.

    Key order, 1 for 1.0 and defaults written out make no difference; the order of items does.
    """
    document = program.model_dump(mode="json", exclude_defaults=True)
    return json.dumps(
        document, sort_keys=True, separators=(",", ":"), ensure_ascii=False, allow_nan=False
    ).encode("utf-8", "surrogatepass")


def digest(program: Program) -> str:
    """SHA-256 of the canonical form, in hexadecimal."""
    return hashlib.sha256(canonical(program)).hexdigest()
