from typing import Any

import pytest

from app.formats.netlist import Netlist
from app.program.model import Program
from app.program.places import place


@pytest.mark.parametrize(
    ("location", "way"),
    [
        ((), ()),
        (("items", 3, "labl"), ("items", 3, "labl")),
        (("items", 0, "shape", "box", "size", 2), ("items", 0, "shape", "size", 2)),
        (("items", 0, "shape", "tray", "tray"), ("items", 0, "shape", "tray")),
        (("items", 0, "position", 1), ("items", 0, "position", 1)),
        (("style", "background", "literal['transparent']"), ("style", "background")),
        (("items", 0, "data"), ("items", 0, "data")),
    ],
)
def test_a_location_in_a_program_becomes_a_way_into_the_document(
    location: Any, way: tuple[Any, ...]
) -> None:
    assert place(Program, location).way == way


def test_a_location_in_a_netlist_loses_what_names_the_members_of_a_union() -> None:
    way = ("modules", "m", "cells", "c", "connections", "A", 0)
    assert place(Netlist, (*way, "function-before[_whole(), int]")).way == way


def test_the_keys_are_those_of_the_object_with_the_fault() -> None:
    assert place(Program, ("view", "form")).keys == (
        "eye_distance", "field_of_view", "from", "margin", "projection", "stereo",
    )  # fmt: skip
