"""The layouts of stored programs that were made last.

The next edit begins with them, and so does who shows what the last one has changed.
"""

from __future__ import annotations

from collections import OrderedDict
from dataclasses import fields

import numpy as np

from app.layout import Layout

MOST_BYTES = 4_000_000
"""Of a document and its layout, as they are stored; in memory they take some ten times as much."""


class RecentLayouts:
    """As many layouts as ``most``, by the bytes of their documents and of themselves."""

    def __init__(self, most: int = 3) -> None:
        self._most = most
        self._kept: OrderedDict[tuple[bytes, bytes], Layout] = OrderedDict()

    def get(self, document: bytes, layout: bytes | None) -> Layout | None:
        """What was kept, with its program, if it was."""
        if layout is None or (found := self._kept.get((document, layout))) is None:
            return None
        self._kept.move_to_end((document, layout))
        return found

    def put(self, document: bytes, layout: bytes, laid: Layout) -> None:
        """Keep ``laid``, which from now on nobody may change; the oldest goes."""
        if len(document) + len(layout) > MOST_BYTES:
            return
        for part in (laid.placement, laid.routing):
            for each in fields(part):
                if isinstance(value := getattr(part, each.name), np.ndarray):
                    value.setflags(write=False)
        laid.hues.setflags(write=False)
        self._kept[document, layout] = laid
        self._kept.move_to_end((document, layout))
        while len(self._kept) > self._most:
            self._kept.popitem(last=False)


recent_layouts = RecentLayouts()
"""Of this process."""
