"""The playground, in a real browser."""

from __future__ import annotations

from tests.browser.conftest import run_script
from tests.service import Service


def test_the_playground_does_what_it_says(service: Service) -> None:
    run_script("playground.mjs", service.url)
