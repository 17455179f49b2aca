"""How far an edge can be rounded, and in how many steps."""

from __future__ import annotations

import math

FEWEST, MOST = 2, 4
"""Steps of a quarter turn. Normals are exact, so that two shade as a true rounding does; only the
silhouette tells, and only where the rounding is large beside the solid."""

SHARE = 0.48
"""Of the room between two edges that either may take: both together leave a strip between them."""

FINEST = 1e-5
"""Of a solid's reach: a smaller rounding falls between the steps of single precision."""


def steps(radius: float, angle: float, usual: int, coarseness: float) -> int:
    """In how many steps an arc is cut: ``usual``, or fewer if that is fine enough.

    ``angle`` is that of the arc (radians); a surface that bends so in both directions is off by
    ``coarseness`` at most.

    >>> steps(1.0, math.tau, 32, 0.05)
    15
    >>> steps(1.0, math.tau, 32, 0.0)
    32
    """
    if coarseness <= 0.0:
        return usual
    # In the middle of a face the two add up.
    half = math.acos(max(1.0 - coarseness / (2.0 * radius), 0.0))
    return min(usual, math.ceil(angle / (2.0 * half)))


def rounding(
    edge: float, *, limit: float, reach: float, coarseness: float = 0.0
) -> tuple[float, int]:
    """The radius to round by, and its steps; both 0 for a sharp edge.

    ``edge`` is the radius wished for, ``limit`` the room between opposite edges, ``reach`` the
    largest coordinate, ``coarseness`` how far the steps may be from the rounding.

    >>> rounding(0.1, limit=2.0, reach=1.0)
    (0.1, 2)
    >>> rounding(5.0, limit=2.0, reach=1.0)
    (0.96, 4)
    >>> rounding(0.0, limit=2.0, reach=1.0)
    (0.0, 0)
    """
    held = min(edge, SHARE * limit)
    if held < FINEST * reach or held <= 0:
        return 0.0, 0
    usual = FEWEST if held <= 0.1 * reach else MOST
    return held, steps(held, math.pi / 2, usual, coarseness)
