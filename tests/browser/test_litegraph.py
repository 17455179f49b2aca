"""The editor that is connected without a framework, in a real browser."""

from __future__ import annotations

from tests.browser.conftest import run_script
from tests.service import Service


def test_three_calls_connect_an_editor(service: Service) -> None:
    run_script("litegraph.mjs", service.url)
