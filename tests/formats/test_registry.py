import json
from pathlib import Path

import pytest

from app.errors import UnknownName
from app.formats.registry import FORMATS, read, write
from app.program.digest import digest
from app.settings import Settings

EXAMPLES = Path(__file__).parents[2] / "examples"


def test_our_own_document_is_read_and_written_unchanged() -> None:
    program = read("tubeloom", (EXAMPLES / "shapes.json").read_bytes(), Settings())
    assert digest(read("tubeloom", write("tubeloom", program), Settings())) == digest(program)


def test_what_is_written_leaves_defaults_out() -> None:
    program = read("tubeloom", b'{"items": [{"id": "a"}], "view": {"margin": 0.05}}', Settings())
    assert json.loads(write("tubeloom", program)) == {"items": [{"id": "a"}]}


def test_unknown_formats_are_named_with_the_known_ones() -> None:
    with pytest.raises(UnknownName, match="tubeloom, yosys, hif"):
        read("dot", b"{}", Settings())


def test_a_format_without_a_writer_cannot_be_written() -> None:
    program = read("tubeloom", b'{"items": []}', Settings())
    for name, entry in FORMATS.items():
        if not entry.writes:
            with pytest.raises(UnknownName, match="tubeloom"):
                write(name, program)
