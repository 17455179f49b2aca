"""Edits by what they mean, as they stand in JSON; `app.program.edits` does them."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, JsonValue

from app.program.base import Id, Many, Part
from app.program.model import Attachment, Hyperedge, Item

MOST_EDITS = 1_000
"""That are done as one."""

Fields = dict[str, JsonValue]
"""What is to be written into a part; null takes a field away (RFC 7396)."""


class AddItem(Part):
    """A new item, after all others."""

    type: Literal["add_item"]
    item: Item


class RemoveItem(Part):
    """An item goes, with all that it contains and with the ends of hyperedges on them.

    A hyperedge that has less than two attachments left goes too.
    """

    type: Literal["remove_item"]
    id: Id


class RenameItem(Part):
    """Another id for an item, wherever it stands. The item stays where it is."""

    type: Literal["rename_item"]
    id: Id
    to: Id


class SetItem(Part):
    """Other fields of an item, such as its label, shape, position or colour."""

    type: Literal["set_item"]
    id: Id
    fields: Fields = Field(
        description="As in JSON Merge Patch; not `id` and `parent`. A shape of another type takes "
        "nothing from the old one."
    )


class Reparent(Part):
    """An item moves into another one, or out to the world (null)."""

    type: Literal["reparent"]
    id: Id
    parent: Id | None = Field(description="The item that shall contain it; null: none.")


class Group(Part):
    """Items of one parent move into a new item around them, a tray if nothing else is said."""

    type: Literal["group"]
    items: Many[Id] = Field(min_length=1)
    tray: Item = Field(description="The new item; it gets the parent that the items had.")


class Ungroup(Part):
    """What an item contains moves out of it, and the item goes."""

    type: Literal["ungroup"]
    id: Id


class AddHyperedge(Part):
    """A new hyperedge, after all others."""

    type: Literal["add_hyperedge"]
    hyperedge: Hyperedge


class RemoveHyperedge(Part):
    """A hyperedge goes; the items that it joined stay."""

    type: Literal["remove_hyperedge"]
    id: Id


class RenameHyperedge(Part):
    """Another id for a hyperedge, which keeps its place and its colour."""

    type: Literal["rename_hyperedge"]
    id: Id
    to: Id


class SetHyperedge(Part):
    """Other fields of a hyperedge, such as its label, colour or radius."""

    type: Literal["set_hyperedge"]
    id: Id
    fields: Fields = Field(description="As in JSON Merge Patch; not `id` and `attachments`.")


class Connect(Part):
    """A hyperedge joins further attachments."""

    type: Literal["connect"]
    id: Id
    attachments: Many[Attachment] = Field(min_length=1)


class Disconnect(Part):
    """A hyperedge lets go of attachments; two at least must stay."""

    type: Literal["disconnect"]
    id: Id
    attachments: Many[Attachment] = Field(min_length=1)


class Merge(Part):
    """Two hyperedges become one: the first joins what both joined, the other one goes."""

    type: Literal["merge"]
    id: Id
    other: Id


class Split(Part):
    """A hyperedge becomes two: some of its attachments go to a new one that looks the same."""

    type: Literal["split"]
    id: Id
    into: Id = Field(description="Id of the new hyperedge.")
    attachments: Many[Attachment] = Field(min_length=2, description="Of the new hyperedge.")
    shared: Many[Attachment] = Field((), description="Those of them that the old one keeps too.")


class SetProgram(Part):
    """Another name, notation, layout, style, view or data of the whole program."""

    type: Literal["set_program"]
    fields: Fields = Field(description="As in JSON Merge Patch; not `items` and `hyperedges`.")


Edit = Annotated[
    AddItem
    | RemoveItem
    | RenameItem
    | SetItem
    | Reparent
    | Group
    | Ungroup
    | AddHyperedge
    | RemoveHyperedge
    | RenameHyperedge
    | SetHyperedge
    | Connect
    | Disconnect
    | Merge
    | Split
    | SetProgram,
    Field(discriminator="type"),
]


class EditList(Part):
    """Edits that are done one after another, all of them or none."""

    edits: Many[Edit] = Field(min_length=1, max_length=MOST_EDITS)
