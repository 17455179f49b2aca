"""What a routing is worth: how much of it is clear, how high, how short and how smooth."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from app.hyperedges.clearance.certificate import Certificate, certify
from app.hyperedges.routing import Routing
from app.placement.placement import Placement
from tests.hyperedges.sampling import lengths, pinched


@dataclass(frozen=True, slots=True)
class RouteFigures:
    """Figures of one routing; lengths in document units.

    Of its ``hyperedges`` ``cut`` pass through another one or through an item, ``near`` come nearer
    than the clearance to one, and ``own`` touch themselves. ``highest`` is the highest join plane.
    ``tree`` is the length of the straight lines between attachments, joins and bends, ``length``
    that of the curves along them.
    """

    hyperedges: int
    cut: int
    near: int
    own: int
    certified: bool
    highest: float
    segments: int
    pinched: int
    length: float
    tree: float

    @property
    def stretch(self) -> float:
        """Length of the curves over that of their trees."""
        return self.length / self.tree if self.tree else 1.0

    @property
    def notes(self) -> dict[str, str]:
        """The figures in words, for a table."""
        return {
            "clear": "yes" if self.certified else "no",
            "cut": f"{self.cut / self.hyperedges:.0%}",
            "too near": f"{self.near / self.hyperedges:.0%}",
            "highest join plane": f"{self.highest:.1f}",
            "segments": str(self.segments),
            "pinched": str(self.pinched),
            "curves over trees": f"{self.stretch:.2f}",
        }


def figures(
    routing: Routing, placement: Placement, clearance: float, proof: Certificate | None = None
) -> RouteFigures:
    """Figures of ``routing``; ``proof`` is its certificate for ``clearance``, if there is one."""
    proof = proof or certify(routing, placement, clearance)
    ends = routing.control_points[:, [0, 3]]
    return RouteFigures(
        hyperedges=len(routing.radii),
        cut=_in_conflict(proof, 0.0),
        near=_in_conflict(proof, clearance),
        own=len(proof.own.hyperedges),
        certified=proof.certified,
        highest=float(routing.join_planes.max(initial=0.0)),
        segments=len(routing.control_points),
        pinched=len(pinched(routing)),
        length=float(lengths(routing).sum()),
        tree=float(np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1).sum()),
    )


def _in_conflict(proof: Certificate, clearance: float) -> int:
    """How many hyperedges come nearer than ``clearance`` to another one or to an item."""
    found = proof.conflicts
    hit = found.lower < clearance
    others = found.second[hit & ~found.with_items]
    return len(np.union1d(found.first[hit], others))
