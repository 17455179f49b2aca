"""What the page on clients shows is run as it stands there."""

from __future__ import annotations

import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.clients.test_typescript_client import installed, run
from tests.service import Service, running_service

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "clients.md").read_text()


def blocks(language: str) -> list[str]:
    """The fenced blocks of one language."""
    found = re.findall(rf"^```{language}\n(.*?)^```", PAGE, re.MULTILINE | re.DOTALL)
    assert found
    return found


@pytest.fixture(scope="module")
def service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Service]:
    with running_service(tmp_path_factory.mktemp("service")) as service:
        yield service


def meant_for(service: Service, block: str) -> str:
    """A block that speaks to the service, wherever it listens."""
    block = block.replace("Client()", 'Client("http://127.0.0.1:8000")')
    block = block.replace("Client(key", 'Client("http://127.0.0.1:8000", key')
    return block.replace("http://127.0.0.1:8000", service.url).replace("tl_…", "tl_no_key")


@pytest.mark.parametrize("block", blocks("python"))
def test_python(block: str, service: Service, tmp_path: Path) -> None:
    script = tmp_path / "block.py"
    script.write_text(f"import sys\nsys.path.insert(0, {str(ROOT / 'clients' / 'python')!r})\n")
    with script.open("a") as file:
        file.write(meant_for(service, block))
    assert run(sys.executable, str(script), folder=tmp_path)


def test_typescript(service: Service, tmp_path: Path) -> None:
    scripts = [meant_for(service, block) for block in blocks("ts")]
    installed(tmp_path, {f"block{number}.ts": text for number, text in enumerate(scripts)})
    for number in range(len(scripts)):
        said = subprocess.run(
            ["node", f"block{number}.js"], cwd=tmp_path, capture_output=True, text=True, check=False
        )
        assert said.returncode == 0, said.stderr
        assert said.stdout
