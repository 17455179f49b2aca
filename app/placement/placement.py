"""Where everything is: what placement hands to hyperedge layout and to the scene."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from app.arrays import Floats, Indices
from app.grouped import rows_of, starts_of
from app.placement.layers.plan import Layers
from app.placement.modes import Mode
from app.solids.solid import Size, Solid, Text


@dataclass(frozen=True, slots=True)
class LabelPlace:
    """A label's solid letters, of ``size``, and where they are in their item's own axes."""

    text: Text
    position: tuple[float, float, float]
    rotation: tuple[float, float, float, float]
    size: Size


@dataclass(frozen=True, slots=True, eq=False)
class Placement:
    """The n items of a program, and the a attachments of its h hyperedges, in the world.

    ``centers`` (n, 3), ``rotations`` (n, 4) as quaternions x, y, z, w, ``sizes`` (n, 3) in the
    items' own axes; ``solids`` and ``labels`` are one for each item, a label ``None`` where there
    is nothing to write. ``attachment_positions`` (a, 3) and unit, outward
    ``attachment_directions`` (a, 3) follow the document's order; those of hyperedge k are
    ``attachment_starts[k]`` to ``attachment_starts[k + 1]`` (h + 1,), and ``attachment_items``
    (a,) are their items' numbers. ``radii`` (h,) are the tubes'. Document units, z up.

    ``parents`` (n,) are the numbers of the items that contain the items, -1 for roots; none where
    that is not known. ``offsets`` (n, 3), from the parent's origin to the solid's centre, and
    ``turns`` (n, 4) are within the parent; they are there where items may be placed anew after an
    edit. ``layers`` are there where the curves are to be constructed in channels between them.
    ``mode`` is by what items without positions were placed.
    """

    centers: Floats
    rotations: Floats
    sizes: Floats
    solids: tuple[Solid, ...]
    labels: tuple[LabelPlace | None, ...]
    attachment_positions: Floats
    attachment_directions: Floats
    attachment_starts: Indices
    attachment_items: Indices
    radii: Floats
    parents: Indices = field(default_factory=lambda: np.empty(0, dtype=np.int64))
    offsets: Floats = field(default_factory=lambda: np.empty((0, 3)))
    turns: Floats = field(default_factory=lambda: np.empty((0, 4)))
    layers: Layers | None = None
    mode: Mode = "rows"

    @property
    def stands(self) -> bool:
        """Whether items stand on something: there is a ground then, and what leaves goes up."""
        return self.mode in {"rows", "ground"}

    def of_hyperedges(self, hyperedges: Indices) -> Placement:
        """All items, and the attachments of ``hyperedges`` (k,) alone, in that order."""
        rows = rows_of(self.attachment_starts, hyperedges)
        return replace(
            self,
            attachment_positions=self.attachment_positions[rows],
            attachment_directions=self.attachment_directions[rows],
            attachment_starts=starts_of(np.diff(self.attachment_starts)[hyperedges]),
            attachment_items=self.attachment_items[rows],
            radii=self.radii[hyperedges],
        )
