"""What has been checked is not checked again, and nothing that is wrong gets through by that."""

from __future__ import annotations

from typing import Any

from hypothesis import given
from hypothesis import strategies as st

from app.errors import DocumentError, Fault
from app.program.checking import check
from app.program.model import Attachment, Item, Program
from app.program.trusted import Trusted
from app.settings import Settings
from tests.program.edit_sequences import programs

SETTINGS = Settings(max_depth=4)


def faults(program: Program, checked: Program | None = None) -> list[Fault]:
    try:
        check(program, SETTINGS, checked)
    except DocumentError as error:
        return list(error.faults)
    return []


@st.composite
def meddled(draw: st.DrawFn) -> tuple[Program, Program]:
    """A program that is right, and what somebody made of it who did not care."""
    before = draw(programs())
    names = [*(item.id for item in before.items), "elsewhere"]
    items = list(before.items)
    for _ in range(draw(st.integers(0, 3))):
        place = draw(st.integers(0, len(items) - 1))
        fields = st.fixed_dictionaries(
            {},
            optional={
                "id": st.sampled_from(names),
                "parent": st.sampled_from([None, *names]),
                "label": st.sampled_from(["", "A"]),
            },
        )
        match draw(st.integers(0, 2)):
            case 0:
                items[place] = items[place].model_copy(update=draw(fields))
            case 1 if len(items) > 1:
                del items[place]
            case _:
                fresh: dict[str, Any] = {"id": "new", **draw(fields)}
                items.insert(place, Item.model_validate(fresh))
    hyperedges = list(before.hyperedges)
    if draw(st.booleans()) and hyperedges:
        ends = draw(st.lists(st.sampled_from(names), min_size=2, max_size=3))
        attachments = tuple(Attachment(item=name, point=None) for name in ends)
        hyperedges[0] = hyperedges[0].model_copy(update={"attachments": attachments})
    if draw(st.booleans()) and hyperedges:
        hyperedges.append(hyperedges[-1])
    after = {"items": tuple(items), "hyperedges": tuple(hyperedges)}
    return before, before.model_copy(update=after)


@given(meddled())
def test_all_that_is_wrong_is_found_beside_what_is_trusted(made: tuple[Program, Program]) -> None:
    before, after = made
    if not faults(before):
        assert faults(after, before) == faults(after)


@given(programs())
def test_the_same_program_is_trusted_whole(program: Program) -> None:
    trusted = Trusted.of(program, program)
    assert trusted.parents
    assert trusted.all_hyperedges
    assert trusted.items == {id(item) for item in program.items}


def test_points_that_are_gone_are_missed() -> None:
    point = {"id": "p", "position": [0, 0, 0], "direction": [0, 0, 1]}
    ends = [{"item": "a", "point": "p"}, {"item": "b"}]
    before = Program.model_validate(
        {
            "items": [{"id": "a", "attachment_points": [point]}, {"id": "b"}],
            "hyperedges": [{"id": "e", "attachments": ends}],
        }
    )
    bare = before.items[0].model_copy(update={"attachment_points": ()})
    after = before.model_copy(update={"items": (bare, before.items[1])})
    assert [fault.pointer for fault in faults(after, before)] == [
        "/hyperedges/0/attachments/0/point"
    ]
