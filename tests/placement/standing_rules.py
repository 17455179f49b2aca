"""What holds of every placement of items that nobody has placed by hand."""

from __future__ import annotations

import numpy as np
import pytest

from app.placement.placement import Placement
from app.placement.turning import UNTURNED
from app.program.model import Helix, Program
from app.solids.solid import Tray

HAIR = 1e-6


def assert_in_order(program: Program, placement: Placement) -> None:
    """Siblings do not overlap, stand on what holds them, and do not stick out of a tray."""
    numbers = {item.id: number for number, item in enumerate(program.items)}
    half = placement.sizes / 2
    low, high = placement.centers - half, placement.centers + half
    wound = {
        name
        for line in program.layout.constraints
        if isinstance(line, Helix)
        for name in line.items
    }
    # Not turned by a helix, be it with what holds them.
    plain = {
        item.id
        for item in program.items
        if item.id not in wound
        and np.abs(placement.rotations[numbers[item.id]]).tolist() == list(UNTURNED)
    }
    siblings: dict[str | None, list[int]] = {}
    for item in program.items:
        if item.id in plain:
            siblings.setdefault(item.parent, []).append(numbers[item.id])
    for parent, members in siblings.items():
        for place, one in enumerate(members):
            for other in members[:place]:
                apart = np.maximum(low[one] - high[other], low[other] - high[one])[:2].max()
                names = program.items[one].id, program.items[other].id
                assert apart > -HAIR, f"{names} overlap by {-apart}"
        if parent is None:
            assert low[members, 2] == pytest.approx(0.0, abs=HAIR)
            continue
        if parent not in plain:
            continue
        holder = numbers[parent]
        solid = placement.solids[holder]
        if isinstance(solid, Tray):
            assert low[members, 2] == pytest.approx(low[holder, 2] + solid.floor, abs=HAIR)
            if _has_own_size(program, holder):
                continue
            wall = np.array([solid.wall, solid.wall])
            assert (low[members, :2] >= low[holder, :2] + wall - HAIR).all(), f"out of {parent}"
            assert (high[members, :2] <= high[holder, :2] - wall + HAIR).all(), f"out of {parent}"
        else:
            assert low[members, 2] == pytest.approx(high[holder, 2], abs=HAIR)


def _has_own_size(program: Program, number: int) -> bool:
    return getattr(program.items[number].shape, "size", None) is not None
