"""Documents and layouts as they are stored: deflated.

What was deflated or inflated last is known still, for the next edit and whoever looks at this one
want the same again.
"""

from __future__ import annotations

import threading
import zlib
from collections import OrderedDict

_LEVEL = 1
"""Documents become many times smaller, at some 100 kB in a millisecond."""

LARGEST_KNOWN = 4_000_000
"""Bytes. What is larger is rare, and would take the place of much else."""

MOST_KNOWN = 12


class Deflater:
    """Deflates and inflates, from any thread."""

    def __init__(self) -> None:
        self._known: OrderedDict[bytes, bytes] = OrderedDict()
        self._lock = threading.Lock()

    def deflate(self, data: bytes) -> bytes:
        """``data``, in fewer bytes."""
        deflated = zlib.compress(data, _LEVEL)
        self._keep(deflated, data)
        return deflated

    def inflate(self, deflated: bytes) -> bytes:
        """What `deflate` was given. Raises `zlib.error` for other bytes."""
        with self._lock:
            data = self._known.get(deflated)
        if data is None:
            data = zlib.decompress(deflated)
        self._keep(deflated, data)
        return data

    def _keep(self, deflated: bytes, data: bytes) -> None:
        if len(data) > LARGEST_KNOWN:
            return
        with self._lock:
            self._known[deflated] = data
            self._known.move_to_end(deflated)
            while len(self._known) > MOST_KNOWN:
                self._known.popitem(last=False)


deflater = Deflater()
"""Of this process."""
