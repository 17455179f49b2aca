"""A way to find curves of some hyperedges beside those of all others."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from app.arrays import Indices
from app.hyperedges.routing import Routing

Progress = Callable[[float], None]
"""Told which share of the work is done at least, from 0 to 1.

It may raise to end it; where it raises `StoppedError`, the best so far is what comes of it.
"""


@dataclass(frozen=True, slots=True, eq=False)
class Routed:
    """Curves of some hyperedges.

    ``is_proven``: that nothing is wrong with them. ``was_stopped``: before anybody had looked.
    """

    routing: Routing
    is_proven: bool = False
    was_stopped: bool = False


@dataclass(frozen=True, slots=True)
class Router:
    """A way to find curves, by relaxation if it ``is_elastic``.

    ``route(chosen, others, progress)`` makes curves of the hyperedges of the numbers ``chosen``
    (c,), ascending, beside those of all ``others``, in the order of their numbers.
    """

    is_elastic: bool
    route: Callable[[Indices, Routing, Progress], Routed]
