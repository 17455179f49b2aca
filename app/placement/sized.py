"""Items with their solids, by themselves: before they are arranged."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from app.errors import DocumentError, DocumentTooLarge, Fault, InconsistentDocument, pointer
from app.notations.notation import ItemStyle
from app.placement.family import Family
from app.placement.fitting import fit, resized, shape_of, written_extent
from app.placement.labels import front, strip
from app.placement.turning import UNTURNED, Quaternion, Vector, from_degrees, reach, turned
from app.program import shapes
from app.program.faults import first
from app.program.model import Item, Program
from app.solids.extents import middle_of, size_of
from app.solids.lettering import TextExtent
from app.solids.solid import Box, Size, Solid, Tray

Place = tuple[float, float]


@dataclass(frozen=True, slots=True)
class Footprint:
    """Width and depth seen from above; ``center`` is the solid's own, seen from the middle."""

    size: Place
    center: Place


@dataclass(frozen=True, slots=True)
class Stood:
    """Where an item stood before an edit.

    ``offset`` is from its parent's origin to its solid's centre, ``center`` and ``rotation`` are in
    the world; ``center`` is ``None`` where it had to make way for a neighbour. ``size`` is what it
    had. ``alike``: it has the looks, and so the size, still; ``labelled``: its label, too.
    """

    offset: Vector
    center: Vector | None
    rotation: Quaternion
    size: Size
    alike: bool
    labelled: bool


@dataclass(slots=True)
class Sized:
    """An item with its solid.

    ``contains`` tells whether others stand in it or on it; ``children`` are those of them without
    positions, by number: their solids' centres seen from above,
    relative to its origin. ``lift`` is how high its own solid's centre is over what it stands on,
    where it does not stand there itself. ``stood`` is where it was before an edit; ``grew`` tells
    that it takes other room than then.
    """

    item: Item
    style: ItemStyle
    label: TextExtent | None
    solid: Solid
    size: Size
    turn: Quaternion
    contains: bool = False
    children: dict[int, Place] = field(default_factory=dict)
    lift: float | None = None
    stood: Stood | None = None
    grew: bool = False

    @property
    def is_free(self) -> bool:
        """Whether a place is still to be found."""
        return self.item.position is None

    @property
    def is_kept(self) -> bool:
        """Whether its place is the one it had."""
        return self.is_free and self.stood is not None

    @property
    def is_as_before(self) -> bool:
        """Whether it takes the room that it took, where it took it."""
        stood = self.stood
        return stood is not None and stood.alike and stood.center is not None and not self.grew

    def resize(self, size: Size) -> None:
        """Give a block or a tray another size; what is of another shape has the size that it has.

        Its solid is the same as if it had been made so.
        """
        shape = shape_of(self.item, self.style, self.contains)
        self.solid, self.size = resized(shape, self.solid, size), size

    @property
    def is_alike(self) -> bool:
        """Whether it looks as it did before an edit."""
        return self.stood is not None and self.stood.alike

    def is_as_it_stood(self, offset: Vector) -> bool:
        """Whether ``offset`` is its old one, so that it moves with its parent alone."""
        return (
            self.is_free
            and self.is_alike
            and self.stood is not None
            and (self.stood.offset == offset)
        )

    def forget(self) -> None:
        """Let go of where it stood, to be placed anew."""
        self.stood = None
        self.turn = own_turn(self.item)

    @property
    def has_own_size(self) -> bool:
        """Whether the document or the notation fixes the size."""
        shape = self.item.shape or self.style.shape
        return getattr(shape, "size", None) is not None

    @property
    def can_grow(self) -> bool:
        """Whether it is as large as its contents need."""
        return isinstance(self.solid, Box | Tray) and not self.has_own_size

    @property
    def footprint(self) -> Footprint:
        """The room that the item takes among its siblings, with its label, as it is turned."""
        whole, middle = self.whole
        width, depth, _ = reach(self.turn, whole)
        x, y, _ = turned(self.turn, middle)
        return Footprint((width, depth), (-x, -y))

    @property
    def whole(self) -> tuple[Size, Size]:
        """Size and middle of the box around the solid and its label, from the solid's centre."""
        before = front(self.solid, self.label)
        if self.label is None or not before:
            return self.size, (0.0, 0.0, 0.0)
        width, depth, rise = self.size
        # The label stands on the ground before the solid, and may be taller.
        tallest = max(rise, strip(self.label))
        whole = (max(width, self.label.width), depth + before, tallest)
        return whole, (0.0, -before / 2, (tallest - rise) / 2)

    @property
    def middle(self) -> Size:
        """The solid's centre, seen from the item's origin along its parent's axes."""
        return turned(self.turn, middle_of(self.solid))


def alone(program: Program, family: Family, styles: Sequence[ItemStyle]) -> list[Sized]:
    """All items, none of them around what it contains yet.

    Raises `InconsistentDocument` with every tree that comes to no body, and `DocumentTooLarge`.
    """
    sized: list[Sized] = []
    faults: list[Fault] = []
    for number, item in enumerate(program.items):
        try:
            has_children = bool(family.children[number])
            sized.append(_alone(item, styles[number], has_children, program.style.labels))
        except InconsistentDocument as error:
            faults.extend(_in_tree_of(number, error))
        except DocumentTooLarge as error:
            raise DocumentTooLarge(_in_tree_of(number, error)) from None
    if faults:
        raise InconsistentDocument(first(faults))
    return sized


def _in_tree_of(number: int, error: DocumentError) -> list[Fault]:
    place = pointer("items", number, "shape", "tree")
    return [Fault(place + fault.pointer, fault.detail) for fault in error.faults]


def _alone(item: Item, style: ItemStyle, has_children: bool, labelled: bool) -> Sized:
    shape = shape_of(item, style, has_children)
    label = None
    if labelled and item.label and not isinstance(shape, shapes.Text):
        label = written_extent(item.label, style.label_height)
    contents = (0.0, 0.0)
    if isinstance(shape, shapes.Tray) and not has_children:
        least = style.label_height
        width = least if label is None else label.width
        contents = (width + 2 * style.padding, max(least, strip(label)) + 2 * style.padding)
    solid = fit(shape, item, style, label, contents)
    return Sized(item, style, label, solid, size_of(solid), own_turn(item), has_children)


def own_turn(item: Item) -> Quaternion:
    """How the document turns an item."""
    return from_degrees(*item.rotation) if item.rotation else UNTURNED
