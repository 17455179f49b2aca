import json
from pathlib import Path

import httpx
import pytest
from jsonschema import Draft202012Validator

from app.api.problems import KINDS
from app.api.schema import EXAMPLE
from app.formats.registry import FORMATS

FILE = Path(__file__).parents[2] / "openapi.json"


def test_the_file_says_what_the_service_says(client: httpx.Client) -> None:
    assert json.loads(FILE.read_text()) == client.get("/openapi.json").json(), "run `make openapi`"


def test_the_example_is_rendered(client: httpx.Client) -> None:
    assert client.post("/v1/render", json=EXAMPLE).status_code == 200


def test_every_status_of_a_problem_is_documented() -> None:
    paths = json.loads(FILE.read_text())["paths"]
    documented = {
        status
        for operations in paths.values()
        for operation in operations.values()
        for status in operation["responses"]
    }
    assert {str(kind.status) for kind in KINDS.values()} <= documented


def test_formats_to_choose_from_are_those_that_there_are() -> None:
    parameters = json.loads(FILE.read_text())["paths"]["/v1/convert"]["post"]["parameters"]
    by_name = {parameter["name"]: json.dumps(parameter["schema"]) for parameter in parameters}
    assert all(f'"{name}"' in by_name["from"] for name in FORMATS)
    assert '"tubeloom"' in by_name["to"]


@pytest.mark.parametrize("query", ["", "?patches=true"])
def test_numbers_follow_their_schema(client: httpx.Client, query: str) -> None:
    described = json.loads(FILE.read_text())
    schema = {"$ref": "#/components/schemas/LayoutNumbers", "components": described["components"]}
    numbers = client.post(f"/v1/layout{query}", json=EXAMPLE).json()
    Draft202012Validator(schema).validate(numbers)
