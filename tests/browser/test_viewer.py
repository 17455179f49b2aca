"""The viewer element, in a real browser."""

from __future__ import annotations

from tests.browser.conftest import run_script
from tests.service import Service


def test_the_viewer_does_what_it_says(service: Service) -> None:
    run_script("viewer.mjs", service.url)
