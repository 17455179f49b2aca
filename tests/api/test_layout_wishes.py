"""What may be asked of a layout where the document's format cannot say it."""

from __future__ import annotations

import json
from pathlib import Path

import httpx
import pytest

from tests.service import SMALL, fresh

NETLIST = Path(__file__).parents[2] / "examples" / "yosys" / "hyperedges.json"


def layout(client: httpx.Client, **query: str) -> httpx.Response:
    return client.post(
        "/v1/layout", params={"from": "yosys", **query}, content=NETLIST.read_bytes()
    )


def test_a_netlist_gets_the_clearance_that_is_asked_for(client: httpx.Client) -> None:
    assert layout(client, clearance="0.1").json()["clearance"]["required"] == 0.1
    assert layout(client, clearance="none").json()["clearance"] is None
    assert layout(client).json()["clearance"]["required"] == 0.05


def test_a_netlist_is_routed_as_is_asked_for(client: httpx.Client) -> None:
    curves = [
        json.dumps([each["segments"] for each in layout(client, routing=name).json()["hyperedges"]])
        for name in ("planes", "elastic", "planes")
    ]
    assert curves[0] == curves[2] != curves[1]


def test_a_netlist_is_placed_in_layers_as_is_asked_for(client: httpx.Client) -> None:
    netlist = NETLIST.with_name("up3down5.json").read_bytes()

    def ask(call: str, **query: str) -> httpx.Response:
        params = {"from": "yosys", "placement": "layers", **query}
        return client.post(f"/v1/{call}", params=params, content=netlist).raise_for_status()

    layers, bits = (ask("layout", **query).json() for query in ({}, {"bundles": "none"}))
    assert layers["clearance"]["certified"]
    assert len(layers["hyperedges"]) == 20 < len(bits["hyperedges"])
    assert ask("render", format="png").content.startswith(b"\x89PNG")


def test_a_hypergraph_is_placed_as_is_asked_for(client: httpx.Client) -> None:
    star = {"incidences": [{"edge": e, "node": n} for e in range(6) for n in ("hub", f"n{e}")]}
    depths = {}
    for mode in ("rows", "ground", "sheet", "space"):
        query = {"from": "hif", "placement": mode}
        response = client.post("/v1/layout", params=query, json=star)
        numbers = response.raise_for_status().json()
        assert numbers["clearance"]["certified"]
        places = [each["center"] for each in numbers["items"]]
        depths[mode] = [len({round(place[axis], 6) for place in places}) for axis in (1, 2)]
    assert depths["sheet"][0] == 1 < depths["sheet"][1]
    # A large ball stands higher than the others.
    assert depths["ground"][1] <= 2 < depths["ground"][0]
    assert min(depths["space"]) > 2
    assert depths["rows"] != depths["ground"]


def test_what_is_asked_goes_before_the_document(client: httpx.Client) -> None:
    document = SMALL | {"layout": {"clearance": 0.2}}
    answers = [
        client.post("/v1/layout", params=query, json=document).json()["clearance"]["required"]
        for query in ({}, {"clearance": "0.1"})
    ]
    assert answers == [0.2, 0.1]


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("clearance", "-1"),
        ("clearance", "null"),
        ("clearance", "nan"),
        ("routing", "best"),
        ("placement", "heap"),
    ],
)
def test_what_cannot_be_asked_is_named(client: httpx.Client, name: str, value: str) -> None:
    response = layout(client, **{name: value})
    assert response.status_code == 400
    assert name in {error["parameter"] for error in response.json()["errors"]}


def test_a_stored_program_is_laid_out_already(client: httpx.Client) -> None:
    name = fresh("laid").replace(" ", "-")
    client.put(f"/v1/programs/{name}", json=SMALL).raise_for_status()
    response = client.post(f"/v1/jobs?program={name}&format=png&routing=elastic")
    assert response.status_code == 422
    assert "laid out already" in response.json()["detail"]
