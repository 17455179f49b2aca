"""What the page on clients shows."""

from __future__ import annotations

import re
from pathlib import Path

from tests.service import Service

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "clients.md").read_text()


def blocks(language: str) -> list[str]:
    """The fenced blocks of one language."""
    found = re.findall(rf"^```{language}\n(.*?)^```", PAGE, re.MULTILINE | re.DOTALL)
    assert found
    return found


def meant_for(service: Service, block: str) -> str:
    """A block that speaks to the service, wherever it listens."""
    block = block.replace("Client()", 'Client("http://127.0.0.1:8000")')
    block = block.replace("Client(key", 'Client("http://127.0.0.1:8000", key')
    return block.replace("http://127.0.0.1:8000", service.url).replace("tl_…", "tl_no_key")
