"""Documents of the paper and of other people, certified clear: no two hyperedges touch."""

from pathlib import Path

import pytest

from app.formats.registry import read
from app.layout import judge, lay_out
from app.settings import Settings
from tests.hyperedges import sampling

EXAMPLES = Path(__file__).parents[2] / "examples"
DOCUMENTS = [
    ("id3-clause-1", "tubeloom"),
    ("id3-clause-2", "tubeloom"),
    ("yosys/up3down5", "yosys"),
    ("hif/e-coli", "hif"),
    ("hif/lesmis", "hif"),
]


@pytest.mark.parametrize(("name", "source"), DOCUMENTS, ids=[name for name, _ in DOCUMENTS])
def test_a_document_is_certified_clear(name: str, source: str) -> None:
    program = read(source, (EXAMPLES / f"{name}.json").read_bytes(), Settings())
    layout = lay_out(program)
    verdict, clearance = judge(layout), program.layout.clearance
    assert verdict is not None
    assert clearance
    certificate = verdict.certificate
    conflicts = certificate.conflicts
    assert list(zip(conflicts.first, conflicts.second, conflicts.lower, strict=True)) == []
    assert certificate.certified
    assert certificate.minimum >= clearance
    assert len(verdict.pinches.segments) == 0
    seen = sampling.sample(layout.routing)
    assert sampling.tubes_too_near(seen, layout.placement.radii, clearance) == set()
