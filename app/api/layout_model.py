"""What ``/v1/layout`` answers, for the interface's documentation; `app.output.numbers` writes it.

Positions are world positions, z up, in document units; quaternions are x, y, z, w.
"""

from __future__ import annotations

from typing import Literal, TypeAlias

from pydantic import BaseModel, ConfigDict, Field

Triple: TypeAlias = tuple[float, float, float]
Quad: TypeAlias = tuple[float, float, float, float]
Controls: TypeAlias = tuple[Triple, Triple, Triple, Triple]


class PlacedItem(BaseModel):
    """Where an item stands."""

    id: str
    center: Triple
    size: Triple
    rotation: Quad


class PlacedAttachment(BaseModel):
    """Where a hyperedge ends."""

    item: str
    point: str | None
    position: Triple
    direction: Triple


class End(BaseModel):
    """An end of a segment: an attachment or a join of its hyperedge, by number."""

    attachment: int | None = None
    join: int | None = None


class PatchPair(BaseModel):
    """The paper's tube: a top and a bottom bicubic Bezier patch, four rows of control points."""

    top: tuple[Controls, Controls, Controls, Controls]
    bottom: tuple[Controls, Controls, Controls, Controls]


class Segment(BaseModel):
    """One cubic Bezier curve."""

    from_: End = Field(alias="from")
    to: End
    control_points: Controls
    patches: list[PatchPair] | None = None


class Join(BaseModel):
    """Where three segments meet with one tangent, or two, at a bend."""

    position: Triple
    tangent: Triple


class RoutedHyperedge(BaseModel):
    """A hyperedge's curves, the paper's in the order in which CURVES makes them."""

    id: str
    color: str = Field(
        description="As it is drawn, `#rrggbb`: its own, its kind's or the palette's.",
        pattern="^#[0-9a-f]{6}$",
    )
    join_plane: float | None = Field(description="Height z of the joins.")
    radius: float
    attachments: list[PlacedAttachment]
    segments: list[Segment]
    joins: list[Join]


class Contact(BaseModel):
    """The nearest place of two hyperedges, or of one and an item."""

    hyperedges: list[str]
    item: str | None
    place: Triple
    distance: float = Field(description="Between the surfaces, a proven lower bound.")


class Conflict(Contact):
    """A contact that is nearer than is required."""

    remedy: str = Field(description="What would make room there, in words.")


class Overlap(BaseModel):
    """Two items that stand in each other, neither of which contains the other."""

    items: tuple[str, str]
    depth: float = Field(description="How far one has to move for their boxes to part.")


class OwnContact(BaseModel):
    """Where a hyperedge touches itself, beyond its joins."""

    hyperedge: str
    place: Triple
    distance: float


class Pinch(BaseModel):
    """A segment that bends more tightly than 1.5 times its tube's radius."""

    hyperedge: str
    segment: int
    radius_of_curvature: float


class Clearance(BaseModel):
    """What is proven about distances; own contacts and pinches do not decide ``certified``."""

    required: float
    certified: bool
    minimum: float = Field(description="No two surfaces are nearer; a proven lower bound.")
    nearest: Contact | None
    conflicts: list[Conflict]
    own_contacts: list[OwnContact]
    pinches: list[Pinch]
    complete: Literal[False] | None = Field(
        None,
        description="False where there are more conflicts than are listed, or there was not time "
        "enough to look for them all; left out elsewhere.",
    )


class LayoutNumbers(BaseModel):
    """Where everything is, and whether it is clear of everything else."""

    model_config = ConfigDict(title="Layout")

    items: list[PlacedItem]
    hyperedges: list[RoutedHyperedge]
    overlaps: list[Overlap] = Field(description="At most 1,000, sorted as the items are.")
    clearance: Clearance | None = Field(description="Null where layout.clearance is null.")
    stopped_by: Literal["deadline"] | None = Field(
        None,
        description="`deadline` where there was not time enough for the layout, which is the best "
        "so far; left out elsewhere.",
    )
