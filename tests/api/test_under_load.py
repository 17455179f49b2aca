"""The load benchmark in small: no errors, prompt refusals, recovery."""

from __future__ import annotations

from benchmarks import load, load_tables
from benchmarks.load_mix import SHARES
from tests.service import PATIENCE_SECONDS


def test_the_service_answers_all_below_its_limit_and_turns_away_what_is_beyond() -> None:
    # Less than the benchmark asks of the service and promises of it: other tests run meanwhile.
    plan = load.Plan(
        search=1.5, steady=3.0, overload=3.0, cached=1.0, share=0.4, programs=("hello",), rounds=1
    )
    figures = load.measure(plan)
    assert load_tables.errors(figures) == 0
    assert figures.steady.count(200) == len(figures.steady.all) > 3
    assert {kind for kind, _, _ in figures.steady.all} <= set(SHARES)
    turned_away = figures.overload.seconds(status=503)
    assert len(turned_away) > 3
    answered = figures.overload.seconds(status=200)
    assert turned_away[len(turned_away) // 2] < answered[len(answered) // 2]
    assert figures.recovery < PATIENCE_SECONDS
    assert all(rate.per_second > 0 for rate in figures.cached)
    assert "Beyond the limit" in load_tables.tables(figures)
