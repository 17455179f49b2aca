"""The numbers of a layout.

Positions are world positions (x, y, z), z up, in units of the document; rotations are quaternions
(x, y, z, w).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

Triple: TypeAlias = tuple[float, float, float]
Quad: TypeAlias = tuple[float, float, float, float]
Controls: TypeAlias = tuple[Triple, Triple, Triple, Triple]


@dataclass(frozen=True, slots=True)
class PlacedItem:
    """Where an item stands."""

    id: str
    center: Triple
    size: Triple
    rotation: Quad


@dataclass(frozen=True, slots=True)
class PlacedAttachment:
    """Where a hyperedge ends; ``point`` is None for the item's default attachment point."""

    item: str
    point: str | None
    position: Triple
    direction: Triple


@dataclass(frozen=True, slots=True)
class End:
    """An end of a segment: the number of an attachment, or of a join, of its hyperedge."""

    attachment: int | None = None
    join: int | None = None


@dataclass(frozen=True, slots=True)
class PatchPair:
    """A tube as two bicubic Bezier patches, each of four rows of control points."""

    top: tuple[Controls, Controls, Controls, Controls]
    bottom: tuple[Controls, Controls, Controls, Controls]


@dataclass(frozen=True, slots=True)
class Segment:
    """One cubic Bezier curve; ``patches`` only where they were asked for."""

    from_: End
    to: End
    control_points: Controls
    patches: tuple[PatchPair, ...] | None = None


@dataclass(frozen=True, slots=True)
class Join:
    """Where three segments meet with one tangent, or two, at a bend."""

    position: Triple
    tangent: Triple


@dataclass(frozen=True, slots=True)
class RoutedHyperedge:
    """A hyperedge's curves; ``join_plane`` is the height z of its joins, ``color`` as drawn."""

    id: str
    color: str
    join_plane: float | None
    radius: float
    attachments: tuple[PlacedAttachment, ...]
    segments: tuple[Segment, ...]
    joins: tuple[Join, ...]


@dataclass(frozen=True, slots=True)
class Contact:
    """The nearest place of two hyperedges, or of one and an item that it does not attach to."""

    hyperedges: tuple[str, ...]
    item: str | None
    place: Triple
    distance: float


@dataclass(frozen=True, slots=True)
class OwnContact:
    """Where a hyperedge touches itself, beyond its joins."""

    hyperedge: str
    place: Triple
    distance: float


@dataclass(frozen=True, slots=True)
class Pinch:
    """A segment that bends more tightly than its tube can follow."""

    hyperedge: str
    segment: int
    radius_of_curvature: float


@dataclass(frozen=True, slots=True)
class Clearance:
    """What is proven about distances: no two surfaces are nearer than ``minimum``.

    Not ``complete`` where there are more conflicts than these, or nobody had the time to look.
    """

    required: float
    certified: bool
    minimum: float
    nearest: Contact | None
    conflicts: tuple[Contact, ...]
    own_contacts: tuple[OwnContact, ...]
    pinches: tuple[Pinch, ...]
    complete: bool = True


@dataclass(frozen=True, slots=True)
class Overlap:
    """Two items that stand in each other, and how far one has to move for them to part."""

    items: tuple[str, str]
    depth: float


@dataclass(frozen=True, slots=True)
class Layout:
    """Where everything is; ``clearance`` is None where the program asks for none.

    ``stopped_by`` is ``"deadline"`` where this is the best that there was time for.
    """

    items: tuple[PlacedItem, ...]
    hyperedges: tuple[RoutedHyperedge, ...]
    overlaps: tuple[Overlap, ...]
    clearance: Clearance | None
    stopped_by: str | None = None
