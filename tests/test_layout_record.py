from __future__ import annotations

import io
import json
from dataclasses import fields
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings

from app.layout import Layout, lay_out
from app.layout_record import read_layout, write_layout
from app.program.model import Program
from tests.program.edit_sequences import programs

EXAMPLES = sorted((Path(__file__).parents[1] / "examples").glob("*.json"))


def assert_same(layout: Layout, other: Layout | None) -> None:
    """All that they say is equal, floats to the bit."""
    assert other is not None
    assert other.program == layout.program
    assert other.hues.tolist() == layout.hues.tolist()
    for part in ("placement", "routing"):
        one, two = getattr(layout, part), getattr(other, part)
        for field in fields(one):
            was, now = getattr(one, field.name), getattr(two, field.name)
            if isinstance(was, np.ndarray):
                assert (was.dtype, was.shape) == (now.dtype, now.shape), field.name
                assert was.tobytes() == now.tobytes(), field.name
            else:
                assert was == now, field.name


@settings(max_examples=10)
@given(programs())
def test_a_layout_that_was_written_is_read_as_it_was(program: Program) -> None:
    layout = lay_out(program)
    assert_same(layout, read_layout(program, write_layout(layout)))


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_examples_are_read_as_they_were(path: Path) -> None:
    program = Program.model_validate_json(path.read_bytes())
    layout = lay_out(program)
    assert_same(layout, read_layout(program, write_layout(layout)))


def test_flat_drawings_are_read_as_they_were() -> None:
    document = json.loads((EXAMPLES[0].parent / "id3-clause-2.json").read_bytes())
    document["layout"] = {"dimensions": 2}
    program = Program.model_validate_json(json.dumps(document))
    layout = lay_out(program)
    assert_same(layout, read_layout(program, write_layout(layout)))


def test_the_same_layout_is_the_same_bytes() -> None:
    program = Program.model_validate({"items": [{"id": "a"}, {"id": "b"}]})
    assert write_layout(lay_out(program)) == write_layout(lay_out(program))


def test_what_another_version_wrote_is_not_read() -> None:
    program = Program.model_validate({"items": [{"id": "a"}]})
    written = write_layout(lay_out(program))
    with np.load(io.BytesIO(written)) as arrays:
        told = dict(arrays)
    file = io.BytesIO()
    np.savez(file, **{**told, "form": np.array(0)})
    assert read_layout(program, file.getvalue()) is None


@pytest.mark.parametrize("cut", [0, 1, 100, -1, -200])
def test_what_is_broken_is_not_read(cut: int) -> None:
    program = Program.model_validate({"items": [{"id": "a"}]})
    written = write_layout(lay_out(program))
    assert read_layout(program, written[:cut]) is None


def test_the_layout_of_another_program_is_not_read() -> None:
    program = Program.model_validate({"items": [{"id": "a"}]})
    other = Program.model_validate({"items": [{"id": "a"}, {"id": "b"}]})
    assert read_layout(other, write_layout(lay_out(program))) is None
