"""What the page on clients shows for Python is run as it stands there."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from tests.clients.documented import ROOT, blocks, meant_for
from tests.clients.typescript_package import run
from tests.service import Service


@pytest.mark.parametrize("block", blocks("python"))
def test_python(block: str, service: Service, tmp_path: Path) -> None:
    script = tmp_path / "block.py"
    script.write_text(f"import sys\nsys.path.insert(0, {str(ROOT / 'clients' / 'python')!r})\n")
    with script.open("a") as file:
        file.write(meant_for(service, block))
    assert run(sys.executable, str(script), folder=tmp_path)
