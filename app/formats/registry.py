"""The formats of documents, by name.

What reads and writes them is imported when it is first used: the service knows their names alone.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import TYPE_CHECKING, TypeAlias

from app.errors import UnknownName

if TYPE_CHECKING:
    from app.program.model import Layout, Program
    from app.settings import Settings

Reader: TypeAlias = "Callable[[bytes, Settings, Layout], Program]"
"""Reads a document that is to be laid out so, as far as it does not say so itself."""

Writer: TypeAlias = "Callable[[Program], bytes]"


@dataclass(frozen=True, slots=True)
class Format:
    """A format of documents; ``writer`` is ``None`` where programs cannot be written in it."""

    name: str
    title: str
    description: str
    media_type: str
    suffix: str
    reader: Reader
    writer: Writer | None

    @property
    def writes(self) -> bool:
        """Whether programs can be written in it."""
        return self.writer is not None


def _read_program(data: bytes, settings: Settings, _layout: Layout) -> Program:
    from app.program.reading import read_program

    return read_program(data, settings)


def _write_program(program: Program) -> bytes:
    from app.formats import tubeloom

    return tubeloom.write(program)


def _read_yosys(data: bytes, settings: Settings, layout: Layout) -> Program:
    from app.formats import yosys

    return yosys.read(data, settings, layout)


def _read_hif(data: bytes, settings: Settings, _layout: Layout) -> Program:
    from app.formats import hif

    return hif.read(data, settings)


def _write_hif(program: Program) -> bytes:
    from app.formats import hif

    return hif.write(program)


FORMATS: Mapping[str, Format] = MappingProxyType(
    {
        format_.name: format_
        for format_ in (
            Format(
                "tubeloom",
                "Tubeloom program",
                "Items with attachment points, and hyperedges that join them.",
                "application/json",
                ".json",
                _read_program,
                _write_program,
            ),
            Format(
                "yosys",
                "Yosys netlist",
                "What Yosys' write_json makes: cells, module ports and the nets between them.",
                "application/vnd.yosys+json",
                ".json",
                _read_yosys,
                None,
            ),
            Format(
                "hif",
                "Hypergraph (HIF)",
                "The hypergraph interchange format: nodes, edges, and which node is in which edge.",
                "application/vnd.hif+json",
                ".json",
                _read_hif,
                _write_hif,
            ),
        )
    }
)


def read(
    name: str, data: bytes, settings: Settings, wishes: Sequence[tuple[str, object]] = ()
) -> Program:
    """The program in ``data``, a document of the format ``name``.

    ``wishes`` go before what the document says of its layout, key by key. Raises `UnknownName`, and
    `DocumentError` with every fault found in the document.
    """
    if name not in FORMATS:
        raise UnknownName("format", name, tuple(FORMATS))
    from app.program.model import Layout

    wished = Layout.model_validate(dict(wishes))
    program = FORMATS[name].reader(data, settings, wished)
    if not wishes:
        return program
    layout = Layout.model_validate(program.layout.model_dump() | dict(wishes))
    return program.model_copy(update={"layout": layout})


def write(name: str, program: Program) -> bytes:
    """The program as a document of the format ``name``.

    Raises `UnknownName` where there is no such format, or it can only be read.
    """
    writers = {key: entry.writer for key, entry in FORMATS.items() if entry.writer is not None}
    if name not in writers:
        raise UnknownName("format to write", name, tuple(writers))
    return writers[name](program)
