"""The node editor, in a real browser."""

from __future__ import annotations

from tests.browser.conftest import run_script
from tests.service import Service


def test_the_editor_and_its_picture_go_together(service: Service) -> None:
    run_script("editor.mjs", service.url)
