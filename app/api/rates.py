"""How often, and for how many seconds of work, each asker may ask.

The windows slide: what was counted in the last whole window fades as the present one goes on. They
are kept in memory, each service for itself.
"""

from __future__ import annotations

import math
import time
from collections import OrderedDict
from collections.abc import Mapping
from dataclasses import dataclass

from limits import RateLimitItem, RateLimitItemPerMinute, parse_many

from app.api.problems import TooManyRequestsError
from app.settings import Settings

MOST_ASKERS = 100_000
"""That are remembered; beyond, whoever has not asked for longest is forgotten."""

MILLISECONDS = 1000
"""Budgets are counted in these."""


@dataclass(slots=True)
class Count:
    """What was counted for an asker in the window of that ``number``, and in the one before."""

    number: int
    now: float = 0.0
    before: float = 0.0

    def at(self, window: float) -> float:
        """What counts at the time ``window``, in windows; it must not run backwards."""
        number = math.floor(window)
        if number > self.number:
            self.before = self.now if number == self.number + 1 else 0.0
            self.now, self.number = 0.0, number
        return self.before * (1.0 - (window - number)) + self.now

    def wait(self, window: float, most: float) -> float:
        """How many windows it takes until no more than ``most`` counts, if nothing is added."""
        if self.at(window) <= most:
            return 0.0
        share = window - math.floor(window)
        if self.now <= most:
            return max(1.0 - (most - self.now) / self.before - share, 0.0)
        return 1.0 - share + 1.0 - max(most, 0.0) / self.now


class Limit:
    """So much in a window for each asker, as ``item`` says. ``name`` shows in headers."""

    def __init__(self, item: RateLimitItem, name: str) -> None:
        self.seconds = item.get_expiry()
        self.amount = item.amount
        self.policy = f'"{name}";q={item.amount};w={self.seconds}'
        self._name = name
        self._counts: OrderedDict[str, Count] = OrderedDict()

    def add(self, asker: str, amount: float) -> None:
        """Count ``amount`` for ``asker``, whatever the limit."""
        window = self._window()
        count = self._count(asker, window)
        count.at(window)
        count.now += amount

    def left(self, asker: str) -> float:
        """What ``asker`` may still ask for at once."""
        window = self._window()
        return self.amount - self._count(asker, window).at(window)

    def wait(self, asker: str, amount: float) -> float:
        """The seconds until ``asker`` may ask for ``amount``; 0: now."""
        window = self._window()
        return self.seconds * self._count(asker, window).wait(window, self.amount - amount)

    def header(self, asker: str) -> str:
        """What is left, for the header ``RateLimit``."""
        window = self._window()
        reset = math.ceil((math.floor(window) + 1 - window) * self.seconds)
        return f'"{self._name}";r={max(math.floor(self.left(asker)), 0)};t={reset}'

    def _window(self) -> float:
        return time.monotonic() / self.seconds

    def _count(self, asker: str, window: float) -> Count:
        count = self._counts.get(asker)
        if count is None:
            count = self._counts[asker] = Count(math.floor(window))
            if len(self._counts) > MOST_ASKERS:
                self._counts.popitem(last=False)
        else:
            self._counts.move_to_end(asker)
        return count


class Rates:
    """The limits that one kind of asker keeps to."""

    def __init__(self, rate: str | None, budget_seconds: float | None) -> None:
        items = sorted(parse_many(rate)) if rate else []
        self._limits = [Limit(item, f"requests-{item.get_expiry()}s") for item in items]
        self._budget = (
            Limit(RateLimitItemPerMinute(round(budget_seconds * MILLISECONDS)), "work-ms")
            if budget_seconds
            else None
        )

    def __bool__(self) -> bool:
        return bool(self._limits) or self._budget is not None

    def admit(self, asker: str) -> Mapping[str, str]:
        """Count a request, and say in headers what is left. Raises `TooManyRequestsError`."""
        for limit in self._limits:
            if (seconds := limit.wait(asker, 1)) > 0:
                raise self._refusal(
                    asker,
                    seconds,
                    f"At most {limit.amount} requests are taken in {limit.seconds} seconds.",
                )
        self.afford(asker, 1)
        for limit in self._limits:
            limit.add(asker, 1)
        return self._headers(asker)

    def afford(self, asker: str, milliseconds: float) -> None:
        """Check that the budget has as much left. Raises `TooManyRequestsError`."""
        if self._budget is None:
            return
        wanted = min(milliseconds, self._budget.amount)
        if (seconds := self._budget.wait(asker, wanted)) > 0:
            budget = self._budget.amount / MILLISECONDS
            raise self._refusal(
                asker,
                seconds,
                f"At most {budget:g} seconds of work are done for one asker in a minute.",
            )

    def spend(self, asker: str, seconds: float) -> None:
        """Take the ``seconds`` that were worked from the budget."""
        if self._budget is not None:
            self._budget.add(asker, seconds * MILLISECONDS)

    def _refusal(self, asker: str, seconds: float, why: str) -> TooManyRequestsError:
        headers = {**self._headers(asker), "Retry-After": str(max(math.ceil(seconds), 1))}
        return TooManyRequestsError(f"{why} Try again in {math.ceil(seconds)} seconds.", headers)

    def _headers(self, asker: str) -> Mapping[str, str]:
        limits = [*self._limits, *([self._budget] if self._budget else [])]
        return {
            "RateLimit-Policy": ", ".join(limit.policy for limit in limits),
            "RateLimit": ", ".join(limit.header(asker) for limit in limits),
        }


def rates_of_keys(settings: Settings) -> Rates:
    """What is allowed with one key."""
    return Rates(settings.rate_per_key, settings.budget_seconds)


def rates_of_addresses(settings: Settings) -> Rates:
    """What is allowed from one address, without a key."""
    return Rates(settings.rate_per_address, settings.budget_seconds)
