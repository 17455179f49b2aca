"""Which column each block of a network stands in, and its place there. Linear in its ends.

Blocks and nets are numbers; ``drivers[net]`` and ``takers[net]`` are the blocks at its ends.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence

Ends = Sequence[tuple[int, ...]]


def depths(least: Sequence[int], anew: Sequence[bool], drivers: Ends, takers: Ends) -> list[int]:
    """The longest way to each block, counted from ``least``.

    No way leads into blocks that start ``anew``; what goes round in a circle all the same is cut at
    its first block.

    >>> depths([0, 1, 1], [True, False, False], [(0,), (1,), (2,)], [(1,), (2,), (1,)])
    [0, 1, 2]
    """
    depth = list(least)
    gives: list[list[int]] = [[] for _ in least]
    waits = [0] * len(least)
    for net, sources in enumerate(drivers):
        for block in sources:
            gives[block].append(net)
        if sources:
            for block in takers[net]:
                waits[block] += not anew[block]
    net_waits = [len(sources) for sources in drivers]
    net_depth = [0] * len(drivers)
    ready = deque(block for block, number in enumerate(waits) if number == 0)
    done = [False] * len(least)
    for first_left in range(len(least)):
        if not ready and not done[first_left]:
            ready.append(first_left)
        while ready:
            block = ready.popleft()
            if done[block]:
                continue
            done[block] = True
            for net in gives[block]:
                net_depth[net] = max(net_depth[net], depth[block])
                net_waits[net] -= 1
                if net_waits[net]:
                    continue
                for taker in takers[net]:
                    if not anew[taker] and not done[taker]:
                        depth[taker] = max(depth[taker], net_depth[net] + 1)
                        waits[taker] -= 1
                        if waits[taker] == 0:
                            ready.append(taker)
    return depth


def levels(columns: Sequence[Sequence[int]], drivers: Ends, takers: Ends) -> list[list[int]]:
    """The same columns, each block level with what drives it: barycentres from left to right."""
    heights: dict[int, float] = {}
    takes: dict[int, list[int]] = {}
    for net, ends in enumerate(takers):
        for block in ends:
            takes.setdefault(block, []).append(net)
    ordered: list[list[int]] = []
    for column in columns:
        net_heights: dict[int, float | None] = {}
        wanted: dict[int, float] = {}
        for place, block in enumerate(column):
            nets = takes.get(block, [])
            for net in nets:
                if net not in net_heights:
                    net_heights[net] = _mean([heights[n] for n in drivers[net] if n in heights])
            seen = [height for net in nets if (height := net_heights[net]) is not None]
            mean = _mean(seen)
            wanted[block] = place / len(column) if mean is None else mean
        order = sorted(column, key=lambda block: wanted[block])
        ordered.append(order)
        heights.update({block: (n + 0.5) / len(order) for n, block in enumerate(order)})
    return ordered


def _mean(values: Sequence[float]) -> float | None:
    return sum(values) / len(values) if values else None
