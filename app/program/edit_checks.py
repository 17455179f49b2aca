"""Whether an edit fits a program: what it names exists, and what it makes is new."""

from __future__ import annotations

from collections.abc import Collection, Iterable

from app.program.editable import Editable
from app.program.hints import Hints
from app.program.model import Attachment, Hyperedge

End = tuple[str, str | None]
"""What an attachment says: an item, and a point or none."""


class WrongEdit(Exception):
    """An edit cannot be done: at which of its places, and why."""

    def __init__(self, place: tuple[str | int, ...], detail: str) -> None:
        super().__init__(detail)
        self.place, self.detail = place, detail


def must_be_known(
    name: str,
    known: Collection[str],
    hints: Hints,
    *place: str | int,
    what: str = "item",
) -> None:
    """Check that there is something of that name among what is ``known``."""
    if name not in known:
        raise WrongEdit(place, f'There is no {what} "{name}".{hints.at(name, known)}')


def must_be_free(name: str, known: Collection[str], what: str, *place: str | int) -> None:
    """Check that nothing among what is ``known`` has that name already."""
    if name in known:
        raise WrongEdit(place, f'There is a {what} "{name}" already; ids must be unique.')


def must_be_attachable(
    program: Editable, ends: tuple[Attachment, ...], hints: Hints, *place: str | int
) -> None:
    """Check that each of ``ends`` exists, and that none stands twice."""
    seen: set[End] = set()
    for number, end in enumerate(ends):
        must_be_known(end.item, program.items, hints, *place, number, "item")
        points = {point.id for point in program.items[end.item].attachment_points}
        if end.point is not None and end.point not in points:
            raise WrongEdit(
                (*place, number, "point"),
                f'Item "{end.item}" has no attachment point "{end.point}".'
                f"{hints.at(end.point, points)}",
            )
        if said(end) in seen:
            raise WrongEdit((*place, number), "The same attachment stands twice.")
        seen.add(said(end))


def let_go(
    program: Editable, name: str, leaving: tuple[Attachment, ...], *place: str | int
) -> None:
    """Take attachments from a hyperedge that has them, and two at least beside them."""
    whole = program.hyperedges[name]
    must_be_joined(whole, leaving, *place)
    gone = all_said(leaving)
    kept = tuple(end for end in whole.attachments if said(end) not in gone)
    if len(kept) < 2:
        raise WrongEdit(place, f'Then "{name}" would join less than two; remove it instead.')
    program.put_attachments(name, kept)


def must_be_joined(hyperedge: Hyperedge, ends: tuple[Attachment, ...], *place: str | int) -> None:
    """Check that the hyperedge joins each of ``ends``, and that none stands twice."""
    joined = all_said(hyperedge.attachments)
    for number, end in enumerate(ends):
        if said(end) not in joined:
            at = "" if end.point is None else f' at "{end.point}"'
            raise WrongEdit(
                (*place, number), f'"{hyperedge.id}" does not join "{end.item}"{at} (any more).'
            )
        joined.discard(said(end))


def said(attachment: Attachment) -> End:
    """What an attachment says."""
    return attachment.item, attachment.point


def all_said(attachments: Iterable[Attachment]) -> set[End]:
    """What each of ``attachments`` says."""
    return set(map(said, attachments))
