from __future__ import annotations

from itertools import pairwise

from hypothesis import given
from hypothesis import strategies as st

from app.program.changes import Changes, Differences, combined

NAMES = "abcdef"

states = st.dictionaries(st.sampled_from(NAMES), st.integers(0, 2))
"""What there is, and what it looks like."""


def between(before: dict[str, int], after: dict[str, int]) -> Differences:
    return Differences(
        added=tuple(sorted(after.keys() - before.keys())),
        changed=tuple(
            sorted(name for name in before.keys() & after.keys() if before[name] != after[name])
        ),
        removed=tuple(sorted(before.keys() - after.keys())),
    )


def changes(before: dict[str, int], after: dict[str, int], whole: bool = False) -> Changes:
    return Changes(between(before, after), between(_odd(before), _odd(after)), whole)


def _odd(state: dict[str, int]) -> dict[str, int]:
    return {name: look for name, look in state.items() if look % 2}


@given(states, states, states)
def test_two_changes_come_to_one_that_hides_no_difference(
    first: dict[str, int], second: dict[str, int], third: dict[str, int]
) -> None:
    both = between(first, second).then(between(second, third))
    whole = between(first, third)
    assert both.added == whole.added
    assert both.removed == whole.removed
    # What was changed and changed back is told, for nobody knows any more how it was.
    assert set(whole.changed) <= set(both.changed) <= first.keys() & third.keys()


@given(st.lists(states, min_size=1, max_size=6), st.data())
def test_it_does_not_matter_which_are_put_together_first(
    history: list[dict[str, int]], data: st.DataObject
) -> None:
    steps = [changes(*pair) for pair in pairwise(history)]
    place = data.draw(st.integers(0, len(steps)))
    assert combined(steps[:place]).then(combined(steps[place:])) == combined(steps)


@given(states, states, states)
def test_no_name_is_told_twice(
    first: dict[str, int], second: dict[str, int], third: dict[str, int]
) -> None:
    both = between(first, second).then(between(second, third))
    told = [*both.added, *both.changed, *both.removed]
    assert len(told) == len(set(told))
    assert both.present == {*both.added, *both.changed}


@given(states, states, st.booleans())
def test_changes_are_told_as_json_and_read_again(
    before: dict[str, int], after: dict[str, int], whole: bool
) -> None:
    told = changes(before, after, whole)
    assert Changes.from_json(told.to_json()) == told


def test_what_concerns_the_whole_concerns_it_afterwards_too() -> None:
    assert Changes(whole=True).then(Changes()).whole
    assert Changes().then(Changes(whole=True)).whole
    assert not combined([Changes(), Changes()]).whole
