"""Memory that answers have taken is given back to the system when they have gone."""

from __future__ import annotations

import ctypes

LARGE_BYTES = 128 * 1024
"""Blocks of this size on are kept apart."""

_M_MMAP_THRESHOLD = -3


def return_large_blocks() -> None:
    """Have the C library give each large block back as soon as it is freed.

    Without this, glibc takes the largest block that was ever freed as the bound from which blocks
    on are kept apart, and those below it lie among others: a service that once sent many large
    answers would stay as large. Where the library has no such setting, nothing is done.
    """
    try:
        ctypes.CDLL(None).mallopt(_M_MMAP_THRESHOLD, LARGE_BYTES)
    except (AttributeError, OSError):
        return
