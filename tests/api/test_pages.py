"""The pages for browsers come whole, from here alone, and are kept no longer than they hold."""

from __future__ import annotations

import re

import httpx
import pytest

PAGES = ("/", "/viewer", "/editor", "/litegraph")


@pytest.mark.parametrize("path", PAGES)
def test_a_page_loads_what_is_there_and_from_nowhere_else(client: httpx.Client, path: str) -> None:
    page = client.get(path)
    assert page.status_code == 200
    assert page.headers["content-type"] == "text/html; charset=utf-8"
    assert page.headers["cache-control"] == "no-cache"
    assert "'unsafe-inline'" not in page.headers["content-security-policy"]
    addresses = re.findall(r'(?:src|href)="([^"#]+)"', page.text)
    assert any(address.endswith(".js") for address in addresses)
    for address in addresses:
        assert address.startswith("/"), address
        assert client.get(address).status_code == 200, address


def test_what_is_named_by_its_contents_may_be_kept(client: httpx.Client) -> None:
    script = re.search(r'src="(/web/[^"]+\.js)"', client.get("/viewer").text)
    assert script
    assert "immutable" in client.get(script[1]).headers["cache-control"]
    assert client.get("/web/nothing.js").status_code == 404


def test_the_element_is_to_be_had_under_one_name(client: httpx.Client) -> None:
    element = client.get("/tube-viewer.js")
    assert element.headers["content-type"].startswith("text/javascript")
    assert element.headers["cache-control"] == "no-cache"
    for chunk in re.findall(r'"\./(web/[^"]+\.js)"', element.text):
        assert client.get(f"/{chunk}").status_code == 200
