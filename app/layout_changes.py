"""What looks, stands or runs otherwise in one layout than in another."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from app.arrays import Flags, Floats, Indices
from app.grouped import rows_of
from app.layout import Layout
from app.program.changes import Changes, Differences
from app.program.model import Hyperedge, Item, Program


def changes_between(before: Layout | None, after: Layout) -> Changes:
    """What is not the same to the bit in ``after`` as in ``before``, if there was one.

    An item is what it says, where it stands and how large it is; a hyperedge what it says, its
    colour, its thickness and its curves.
    """
    new = after.program
    if before is None:
        return Changes(
            Differences(added=tuple(item.id for item in new.items)),
            Differences(added=tuple(hyperedge.id for hyperedge in new.hyperedges)),
        )
    old = before.program
    return Changes(
        _differences(old.items, new.items, lambda here, there: _stand(before, after, here, there)),
        _differences(
            old.hyperedges, new.hyperedges, lambda here, there: _run(before, after, here, there)
        ),
        whole=_frame(old) != _frame(new),
    )


def _differences(
    before: Sequence[Item | Hyperedge],
    after: Sequence[Item | Hyperedge],
    are_same: Callable[[Indices, Indices], Flags],
) -> Differences:
    """Between parts with ids; ``are_same`` tells which of as many pairs of numbers are drawn so."""
    places = {part.id: number for number, part in enumerate(before)}
    names = {part.id for part in after}
    kept = [(places[part.id], number) for number, part in enumerate(after) if part.id in places]
    here, there = np.array(kept, dtype=np.int64).reshape(-1, 2).T
    changed = [
        after[number].id
        for (place, number), is_drawn_so in zip(kept, are_same(here, there).tolist(), strict=True)
        if not is_drawn_so or not (before[place] is after[number] or before[place] == after[number])
    ]
    return Differences(
        added=tuple(part.id for part in after if part.id not in places),
        changed=tuple(changed),
        removed=tuple(name for name in places if name not in names),
    )


def _stand(before: Layout, after: Layout, here: Indices, there: Indices) -> Flags:
    """Which items ``here`` (k,) stand as those ``there`` (k,) do."""
    same = np.ones(len(here), dtype=np.bool_)
    for name in ("centers", "rotations", "sizes"):
        old, new = (_bits(getattr(layout.placement, name)) for layout in (before, after))
        same &= (old[here] == new[there]).all(axis=1)
    return same


def _run(before: Layout, after: Layout, here: Indices, there: Indices) -> Flags:
    """Which hyperedges ``here`` (k,) look and run as those ``there`` (k,) do."""
    old, new = before.routing, after.routing
    counts = np.diff(old.segment_starts)[here]
    same = (
        (before.hues[here] == after.hues[there])
        & (_bits(old.radii[here]) == _bits(new.radii[there]))
        & (counts == np.diff(new.segment_starts)[there])
    )
    segments, others = (
        _bits(routing.control_points)[rows_of(routing.segment_starts, chosen)]
        for routing, chosen in ((old, here[same]), (new, there[same]))
    )
    strays = (segments != others).any(axis=(1, 2))
    same[np.repeat(np.flatnonzero(same), counts[same])[strays]] = False
    return np.asarray(same)


def _bits(values: Floats) -> NDArray[np.int64]:
    return np.ascontiguousarray(values).view(np.int64)


def _frame(program: Program) -> Program:
    """All of a program but its items and hyperedges, and what tells only where these stand."""
    layout = program.layout.model_copy(update={"constraints": ()})
    return program.model_copy(update={"items": (), "hyperedges": (), "layout": layout})
