"""What may be asked of glTF for large scenes, over HTTP."""

from __future__ import annotations

import httpx
import pytest

from tests.output.gltf_reader import Asset
from tests.service import SMALL


@pytest.mark.parametrize("form", ["glb", "gltf"])
@pytest.mark.parametrize(
    ("query", "required", "shows"),
    [
        ("", [], "hyperedge"),
        ("&compress=none&merge=false", [], "hyperedge"),
        ("&compress=quantize", ["KHR_mesh_quantization"], "hyperedge"),
        ("&merge=true", [], "hyperedges"),
        (
            "&compress=meshopt&merge=true",
            ["KHR_mesh_quantization", "EXT_meshopt_compression"],
            "hyperedges",
        ),
    ],
)
def test_gltf_is_compressed_and_merged_as_asked(
    client: httpx.Client, form: str, query: str, required: list[str], shows: str
) -> None:
    response = client.post(f"/v1/render?format={form}{query}", json=SMALL)
    assert response.status_code == 200, response.text
    read = Asset.from_glb if form == "glb" else Asset.from_gltf
    found = read(response.content).json
    assert found.get("extensionsRequired", []) == required
    assert shows in {node.get("extras", {}).get("shows") for node in found["nodes"]}


def test_another_way_has_another_validator(client: httpx.Client) -> None:
    queries = [
        "",
        "compress=quantize",
        "compress=meshopt",
        "merge=true",
        "merge=false",
        "height=99",
    ]
    tags = {client.post(f"/v1/render?{query}", json=SMALL).headers["etag"] for query in queries}
    assert len(tags) == len(queries)


def test_defaults_written_out_are_the_same_question(client: httpx.Client) -> None:
    one = client.post("/v1/render", json=SMALL)
    other = client.post("/v1/render?compress=none", json=SMALL)
    assert one.headers["etag"] == other.headers["etag"]
    assert one.content == other.content


@pytest.mark.parametrize("query", ["compress=draco", "compress=", "merge=1", "merge=maybe"])
def test_what_does_not_exist_is_refused(client: httpx.Client, query: str) -> None:
    response = client.post(f"/v1/render?{query}", json=SMALL)
    assert response.status_code == 400
    (error,) = response.json()["errors"]
    assert error["parameter"] == query.partition("=")[0]
