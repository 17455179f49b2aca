"""Whatever collecting garbage sets off, what is parsed at that moment comes through."""

from __future__ import annotations

import ast
import gc
from collections.abc import Iterator

import pytest

SOURCE = repr([{"a": (1, -2, [3, "x"])}] * 200)


class Parses:
    """Garbage that parses as it goes, some calls deeper."""

    def __init__(self) -> None:
        self.myself = self

    def __del__(self) -> None:
        self.parse(9)

    def parse(self, calls: int) -> None:
        if calls:
            self.parse(calls - 1)
        else:
            ast.parse("[1, [2]]", mode="eval")


@pytest.fixture
def eager() -> Iterator[None]:
    """Garbage is collected as soon as there is a little."""
    before = gc.get_threshold()
    gc.set_threshold(50, 2, 2)
    yield
    gc.set_threshold(*before)


@pytest.mark.usefixtures("eager")
def test_garbage_that_parses_does_not_disturb_what_is_parsed() -> None:
    expected = ast.dump(ast.parse(SOURCE, mode="eval"))
    for _ in range(20):
        Parses()
        assert ast.dump(ast.parse(SOURCE, mode="eval")) == expected
