"""Pages of a service that wants keys ask for one."""

from __future__ import annotations

from pathlib import Path

from tests.api.keys import bearer, make_key
from tests.browser.conftest import run_script
from tests.service import SMALL, running_service


def test_each_page_asks_for_the_key_and_works_with_it(tmp_path: Path) -> None:
    with running_service(tmp_path, auth="required") as service:
        key = make_key(tmp_path / "data", "render", "read", "write", "jobs")
        with service.client() as client:
            kept = client.put("/v1/programs/kept", json=SMALL, headers=bearer(key))
            assert kept.status_code == 201
        run_script("keys.mjs", service.url, KEY=key)
