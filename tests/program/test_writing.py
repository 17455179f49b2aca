"""Programs are written to the byte as they would be by themselves."""

from __future__ import annotations

from hypothesis import given

from app.program.digest import canonical
from app.program.edits import apply_edits
from app.program.model import Program
from app.program.writing import Writer
from app.settings import Settings
from tests.program.documents import documents
from tests.program.edit_sequences import Json, as_bytes, sequences


@given(documents(), documents())
def test_any_program_is_written_in_its_canonical_form(one: Json, other: Json) -> None:
    writer = Writer()
    for document in (one, other, one):
        program = Program.model_validate(document)
        assert writer.write(program) == canonical(program)


@given(sequences(most=6))
def test_after_each_edit_it_is_the_canonical_form(made: tuple[Program, tuple[Json, ...]]) -> None:
    program, edits = made
    writer, forgetful = Writer(), Writer(most=0)
    for edit in edits:
        program = apply_edits(program, as_bytes(edit), Settings()).program
        assert writer.write(program) == canonical(program) == forgetful.write(program)


def test_the_frame_of_a_program_is_written_around_its_parts() -> None:
    whole = {
        "name": 'of "items":[]',
        "notation": "sparcl",
        "items": [{"id": "a"}, {"id": "b"}],
        "hyperedges": [{"id": "e", "attachments": [{"item": "a"}, {"item": "b"}]}],
        "layout": {"clearance": None},
        "data": {"hyperedges": []},
    }
    for left_out in ("", "name", "hyperedges", "layout", "data"):
        document = {key: value for key, value in whole.items() if key != left_out}
        program = Program.model_validate(document)
        assert Writer().write(program) == canonical(program)
