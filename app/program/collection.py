"""Python's collector of circular garbage, out of the way of large documents."""

from __future__ import annotations

import gc
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def collection_paused() -> Iterator[None]:
    """No passes of the collector within.

    A large document becomes millions of objects that all live and are in no circle; looking
    through them again and again takes longer than reading it.
    """
    if not gc.isenabled():
        yield
        return
    gc.disable()
    try:
        yield
    finally:
        gc.enable()
