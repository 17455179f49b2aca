"""A program's layout: where its items stand and its hyperedges run, and what is proven of that."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np

from app.arrays import Floats, Indices
from app.hyperedges.clearance.certificate import certify
from app.hyperedges.flat import route_flat
from app.hyperedges.orthogonal.route import route_in_layers
from app.hyperedges.pinches import find_pinches
from app.hyperedges.previous import Previous
from app.hyperedges.route import route
from app.hyperedges.routing import Routing
from app.hyperedges.stopping import Allowance, Spent, nothing_spent
from app.notations.loader import load_notation
from app.output.clearance_numbers import Verdict
from app.placement.flat import flattened
from app.placement.modes import BY_STRESS
from app.placement.place import place
from app.placement.placement import Placement
from app.placement.standing import Standing
from app.program.former import former_numbers
from app.program.model import Program
from app.scene.palette import palette as find_palette

Progress = Callable[[str, float], None]
"""Told what is being done and which share of the whole is done, from 0 to 1.

It may raise to end the work.
"""

Preview = Callable[[bytes], None]
"""Shown a picture that is not finished, as PNG."""


SPACINGS = (1.15, 1.3, 1.5)
"""How many times as far apart items are placed by stress where tubes find no way between them."""


def silent(_stage: str, _share: float) -> None:
    """Progress that nobody listens to."""


@dataclass(frozen=True, slots=True, eq=False)
class Layout:
    """A program with its placement and its routing.

    ``hues`` (h,) say which colour of the palette each hyperedge has. Where the time for it ran out,
    the layout is not ``complete``: its curves are the best so far.
    """

    program: Program
    placement: Placement
    routing: Routing
    hues: Indices
    complete: bool = True

    @property
    def standing(self) -> Standing:
        """Where the items stand, for whoever places them after an edit."""
        return Standing.of(self.program, self.placement)


def lay_out(
    program: Program,
    previous: Layout | None = None,
    progress: Progress = silent,
    spent: Spent = nothing_spent,
    *,
    curves_anew: bool = False,
) -> Layout:
    """The layout that the document's ``layout`` wishes for.

    With the layout of a ``previous`` state of the program, items that have not changed stay where
    they are, and hyperedges of the same id keep their colours, and their curves to the last bit,
    unless their attachments moved or something new is in their way. In a flat drawing they go where
    they would without any others.

    When all of the time for it is ``spent``, the layout is the best so far, whose curves may
    come too near to each other. One that keeps curves of such a layout is not complete either;
    with ``curves_anew`` none is kept.
    """
    progress = _rising(progress)
    progress("placing items", 0.1)
    find_palette(program.style.palette)  # now, and not when all has been laid out
    standing = None if previous is None else previous.standing

    def placed(spacing: float) -> Placement:
        return place(
            program,
            load_notation(program.notation),
            standing,
            lambda: progress("placing items", 0.1),
            spacing,
        )

    placement = placed(1.0)
    progress("laying out hyperedges", 0.2)
    wishes = program.layout
    hues = _hues(program, previous)
    if wishes.dimensions == 2:
        flat = shown(program, placement)
        curves = wishes.curves or _usual_curves(program)
        routing = route_flat(flat, curves=curves, fidelity=wishes.fidelity)
        return Layout(program, flat, routing, hues)
    if placement.layers is not None and (wishes.curves or _usual_curves(program)) == "steiner":
        routing = route_in_layers(placement.layers, placement.attachment_starts, placement.radii)
        return Layout(program, placement, routing, hues)
    allowance = Allowance(spent)

    def report(share: float) -> None:
        progress("laying out hyperedges", 0.2 + 0.2 * share)
        allowance.check()

    kept = None if previous is None or curves_anew else _previous(program, previous)

    def routed(placement: Placement) -> Routing:
        return route(
            placement,
            curves=wishes.curves or _usual_curves(program),
            fidelity=wishes.fidelity,
            closest=wishes.closest,
            clearance=wishes.clearance,
            routing=wishes.routing,
            join_heights=_join_heights(program),
            previous=kept,
            progress=report,
            allowance=allowance,
        )

    routing = routed(placement)
    may_spread = previous is None and placement.mode in BY_STRESS and not allowance.ran_out
    if may_spread and wishes.clearance is not None:
        placement, routing = _with_room(
            placement, routing, placed, routed, wishes.clearance, allowance
        )
    was_complete = kept is None or previous is None or previous.complete
    return Layout(program, placement, routing, hues, was_complete and not allowance.ran_out)


def _rising(progress: Progress) -> Progress:
    """The same, but what is done again is not said to be less."""
    most = 0.0

    def report(stage: str, share: float) -> None:
        nonlocal most
        most = max(most, share)
        progress(stage, most)

    return report


def _with_room(
    placement: Placement,
    routing: Routing,
    placed: Callable[[float], Placement],
    routed: Callable[[Placement], Routing],
    clearance: float,
    allowance: Allowance,
) -> tuple[Placement, Routing]:
    """A placement by stress and its routing; farther apart, if that leaves fewer faults."""
    best = placement, routing
    fewest = _faults(placement, routing, clearance)
    for spacing in SPACINGS:
        if fewest == 0 or allowance.ran_out:
            break
        wider = placed(spacing)
        if np.array_equal(wider.centers, best[0].centers):
            break
        curves = routed(wider)
        faults = _faults(wider, curves, clearance)
        if faults < fewest and not allowance.ran_out:
            best, fewest = (wider, curves), faults
    return best


def _faults(placement: Placement, routing: Routing, clearance: float) -> int:
    """How many conflicts there are, hyperedges that touch themselves, and pinches."""
    found = certify(routing, placement, clearance)
    return len(found.conflicts) + len(found.own.hyperedges) + len(find_pinches(routing).segments)


def shown(program: Program, placement: Placement) -> Placement:
    """The placement as it is shown: flattened, where the document wishes for a flat drawing."""
    return flattened(placement, program) if program.layout.dimensions == 2 else placement


def judge(layout: Layout, spent: Spent = nothing_spent) -> Verdict | None:
    """What is proven about distances; None where the document wants no clearance.

    When all of the time for it is ``spent``, it is what is known so far.
    """
    clearance = layout.program.layout.clearance
    if clearance is None:
        return None
    check = Allowance(spent).check
    certificate = certify(layout.routing, layout.placement, clearance, check)
    return Verdict(certificate, find_pinches(layout.routing))


def _usual_curves(program: Program) -> Literal["steiner", "prose"]:
    return "prose" if program.layout.fidelity == "paper" else "steiner"


def _join_heights(program: Program) -> Floats:
    return np.array(
        [
            np.nan if hyperedge.join_height is None else hyperedge.join_height
            for hyperedge in program.hyperedges
        ],
        dtype=np.float64,
    )


def _hues(program: Program, previous: Layout | None) -> Indices:
    """Colours (h,) by number: those of before, and for new hyperedges the first that are free."""
    if previous is None:
        return np.arange(len(program.hyperedges))
    numbers = former_numbers(program, previous.program)
    hues = np.where(numbers < 0, -1, previous.hues[numbers] if len(previous.hues) else -1)
    free = np.setdiff1d(np.arange(len(hues)), hues, assume_unique=True)
    new = np.flatnonzero(hues < 0)
    hues[new] = free[: len(new)]
    return hues


def _previous(program: Program, previous: Layout) -> Previous | None:
    if _wishes(previous.program) != _wishes(program):
        return None
    return Previous(previous.placement, previous.routing, former_numbers(program, previous.program))


def _wishes(program: Program) -> tuple[object, ...]:
    """What curves depend on, beside the places of items and hyperedges' own wishes."""
    wishes = program.layout
    return (
        wishes.dimensions,
        wishes.curves,
        wishes.fidelity,
        wishes.closest,
        wishes.clearance,
        wishes.routing,
        wishes.placement,
    )
