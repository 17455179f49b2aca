"""All pages, in a real browser: as they look to everybody, and to those who hear or type."""

from __future__ import annotations

from tests.browser.conftest import run_script
from tests.service import Service


def test_nothing_is_wrong_with_the_pages(service: Service) -> None:
    run_script("pages.mjs", service.url)
