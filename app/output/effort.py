"""What a final picture may cost."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Effort:
    """When to stop taking samples: as soon as the first of these says so.

    ``samples`` are those of each pixel; ``None`` is what suits the size. After ``time_limit``
    seconds the best picture so far is the answer. ``noise`` is the standard error that may remain,
    as a share of white. The same ``seed`` gives the same picture, unless time ran out.
    """

    samples: int | None = None
    time_limit: float | None = None
    noise: float | None = None
    denoise: bool = True
    seed: int = 0
