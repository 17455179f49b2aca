"""What a notation says: how each kind looks, and how contents are arranged."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from app.program.base import Color, Length, Part
from app.program.model import Finish, MaterialName, Share
from app.program.shapes import Shape


class ItemStyle(Part):
    """How an item of one kind looks. Lengths in document units."""

    shape: Shape | None = Field(
        None, description="Left out: a tray where the item has children, else a box."
    )
    material: MaterialName = "matte"
    finish: Finish | None = None
    translucency: Share | None = None
    color: Color = "#c9d3df"
    label_color: Color = "#1f2933"
    label_height: Length = Field(0.3, description="Of a capital letter.")
    arrangement: Literal["row", "column", "rows"] = Field(
        "rows", description="How children stand: in one row, one column, or rows of even length."
    )
    caption: Literal["front", "left"] = Field(
        "front", description="Where a tray's label lies: before its contents, or to their left."
    )
    gap: Length = Field(0.25, description="Between children.")
    padding: Length = Field(0.14, description="Between a tray's wall and its contents.")
    stores: bool = Field(
        False, description="Whether it holds a state: in layers, cycles begin at it."
    )
    is_last: bool = Field(False, description="Whether it stands in the last of the layers.")


class HyperedgeStyle(Part):
    """How a hyperedge of one kind looks."""

    material: MaterialName = "plastic"
    finish: Finish | None = None
    translucency: Share | None = None
    color: Color | None = Field(None, description="Left out: each its own, from the palette.")
    radius: Length = 0.08
    weight: float = Field(
        1.0, ge=0.01, le=100, description="How short it should be in layers, over others."
    )


class Notation(Part):
    """A notation: styles by kind, with one for kinds that it does not name."""

    name: str
    title: str
    description: str
    items: dict[str, ItemStyle] = Field(default_factory=dict)
    other_items: ItemStyle = ItemStyle()
    hyperedges: dict[str, HyperedgeStyle] = Field(default_factory=dict)
    other_hyperedges: HyperedgeStyle = HyperedgeStyle()

    def item_style(self, kind: str | None) -> ItemStyle:
        """How items of ``kind`` look."""
        return self.other_items if kind is None else self.items.get(kind, self.other_items)

    def hyperedge_style(self, kind: str | None) -> HyperedgeStyle:
        """How hyperedges of ``kind`` look."""
        if kind is None:
            return self.other_hyperedges
        return self.hyperedges.get(kind, self.other_hyperedges)
