"""Figures of the service under load as Markdown."""

from __future__ import annotations

import os
import platform
from collections.abc import Sequence
from typing import TYPE_CHECKING

from benchmarks.load_mix import SHARES, Replies

if TYPE_CHECKING:
    from benchmarks.load import Figures


def errors(figures: Figures) -> int:
    """Answers that should not have been: at the steady rate all but 200, then all but 503 too."""
    steady, overload = figures.steady, figures.overload
    over = len(overload.all) - overload.count(200) - overload.count(503)
    without_advice = sum(
        reply.status == 503 and "retry-after" not in reply.headers for _, _, reply in overload.all
    )
    return len(steady.all) - steady.count(200) + over + without_advice


def tables(figures: Figures) -> str:
    """All that was found."""
    parts = [_where(figures), _steady(figures), _memory(figures), _overload(figures)]
    return "\n\n".join([*parts, _cached(figures)])


def at_share(ordered: Sequence[float], share: float) -> float:
    """The value below which that share of them lies.

    >>> at_share([1.0, 2.0, 3.0, 4.0], 0.5)
    3.0
    """
    return ordered[min(int(share * len(ordered)), len(ordered) - 1)]


def _where(figures: Figures) -> str:
    return (
        f"Python {platform.python_version()}, {os.cpu_count()} cores, which the client uses too; "
        f"load before it {figures.busy:.1f}, after it {os.getloadavg()[0]:.1f}."
    )


def _steady(figures: Figures) -> str:
    steady = figures.steady
    lasted = max(at for _, at, _ in steady.all)
    title = (
        f"**Steady** (eight askers in turn reach {figures.highest:.1f} a second): "
        f"{len(steady.all)} questions in {lasted:.0f} s, {len(steady.all) / lasted:.1f} a second, "
        f"{len(steady.all) - steady.count(200)} errors"
    )
    lines = [
        title,
        "",
        "| | questions | median | 99th percentile | longest |",
        "|---|--:|--:|--:|--:|",
        *(_times(kind, steady, kind) for kind in SHARES),
        _times("all", steady, None),
    ]
    return "\n".join(lines)


def _times(title: str, replies: Replies, kind: str | None) -> str:
    found = replies.seconds(kind)
    if not found:
        return f"| {title} | 0 | | | |"
    times = (at_share(found, 0.5), at_share(found, 0.99), found[-1])
    return f"| {title} | {len(found)} | " + " | ".join(f"{1e3 * t:.0f} ms" for t in times) + " |"


def _memory(figures: Figures) -> str:
    lines = [
        "**Memory** (resident)",
        "",
        "| after | service | workers together |",
        "|---|--:|--:|",
    ]
    memory = figures.memory
    for share in (0.0, 0.1, 0.25, 0.5, 0.75, 1.0):
        each = memory[round(share * (len(memory) - 1))]
        lines.append(
            f"| {each.at:.0f} s | {each.service / 1e6:.0f} MB | {each.workers / 1e6:.0f} MB |"
        )
    return "\n".join(lines)


def _overload(figures: Figures) -> str:
    replies = figures.overload
    away, inside = replies.seconds(status=503), figures.refusals
    said = (
        f"{len(away)} of {len(replies.all)} were turned away (503 with Retry-After), half within "
        f"{1e3 * at_share(away, 0.5):.0f} ms, 99 % within {1e3 * at_share(away, 0.99):.0f} ms, all "
        f"within {1e3 * away[-1]:.0f} ms (by the service's own log half within "
        f"{1e3 * at_share(inside, 0.5):.0f} ms, 99 % within {1e3 * at_share(inside, 0.99):.0f} ms)"
        if away
        else f"none of {len(replies.all)} was turned away"
    )
    return (
        f"**Beyond the limit** ({len(replies.all) / max(at for _, at, _ in replies.all):.0f} a "
        f"second, nothing cached): {said}; "
        f"{replies.count(200)} were answered; all is as before {figures.recovery:.1f} s after."
    )


def _cached(figures: Figures) -> str:
    lines = [
        "**Cached scenes** (one process; the best of three turns)",
        "",
        "| | bytes | a second | CPU time for each | of bare FastAPI's rate |",
        "|---|--:|--:|--:|--:|",
    ]
    bare = {each.program: each.per_second for each in figures.cached if "FastAPI" in each.who}
    lines += [
        f"| {each.program}, {each.who} | {each.size:,} | {each.per_second:,.0f} "
        f"| {1e6 * each.cpu_seconds:.0f} µs | {each.per_second / bare[each.program]:.2f} |"
        for each in figures.cached
    ]
    return "\n".join(lines)
