"""Does the service keep to its published description? Schemathesis asks, with all its checks."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
import schemathesis
from hypothesis import HealthCheck, settings
from schemathesis.config import SchemathesisConfig

from app.formats.registry import FORMATS
from tests.service import PATIENCE_SECONDS, SMALL, Service

# A document can follow the schema and still contradict itself (an attachment to an item that does
# not exist), which JSON Schema cannot say: 422 says it. Everything else that follows the schema
# must be taken, so 400 is not among these.
CONFIG = {
    "checks": {
        "positive_data_acceptance": {"expected-statuses": ["2xx", "422"]},
        # All that stands there by default, and 413, with which large numbers of items are refused.
        "negative_data_rejection": {
            "expected-statuses": ["400", "404", "405", "406", "413", "415", "422"]
        },
    },
    "generation": {"deterministic": True},
    # With so many parameters its examples are tens of thousands: more than a suite has time for.
    "phases": {"coverage": {"enabled": False}},
    # Schemathesis cannot always find what breaks a schema as deep as a tree of solids: it gives up
    # with "Cannot generate an array with 1 demanded elements".
    "operations": [
        {"include-path": "/v1/render", "generation": {"mode": "positive"}},
        # A patch, or an edit's fields, can be right, and make a document that is not.
        {
            "include-path-regex": r"^/v1/programs/\{id\}(/edits)?$",
            "include-method": ["PATCH", "POST"],
            "checks": {
                "positive_data_acceptance": {
                    "expected-statuses": ["2xx", "400", "404", "409", "412", "422"]
                },
            },
        },
        # Documents of jobs are read when their turn comes.
        {
            "include-path": "/v1/jobs",
            "include-method": "POST",
            "generation": {"mode": "positive"},
        },
        # What is stored may not be there, or not be as the request wants it.
        {
            "include-path-regex": "^/v1/(programs|jobs)/",
            "checks": {
                "positive_data_acceptance": {
                    "expected-statuses": ["2xx", "404", "409", "410", "412", "422"]
                },
                "negative_data_rejection": {"expected-statuses": ["4xx"]},
            },
        },
    ],
}

STORED = "contract"
"""Id of a program that is there."""

COSTLY = {"width": (8192, 200), "height": (8192, 150), "samples": (65536, 4), "frames": (1000, 4)}
"""Numbers in queries: the largest that is allowed, and the largest that a test has time for."""


# Another test holds this file equal to what the service says of itself.
schema = schemathesis.openapi.from_path(
    Path(__file__).parents[2] / "openapi.json", config=SchemathesisConfig.from_dict(CONFIG)
)


@schemathesis.hook
def map_case(_context: Any, case: schemathesis.Case[Any]) -> schemathesis.Case[Any]:
    """Let ``from`` agree with the body, which the schema cannot say, and pictures be quick."""
    program = str((case.path_parameters or {}).get("id", ""))
    if "programs" in case.path and case.method != "DELETE" and program[:1] in "0123456789abcdef":
        case.path_parameters["id"] = STORED
    query = case.query or {}
    slow = query.get("quality") == "final" or "motion" in query
    for name, (largest, most) in COSTLY.items():
        asked = query.get(name, most + 1 if slow else None)
        if isinstance(asked, int) and most < asked <= largest:
            query[name] = most
    implied = {found.media_type: name for name, found in FORMATS.items()}
    if case.media_type in implied and case.query and case.query.get("from") in list(FORMATS):
        case.query["from"] = implied[case.media_type]
    return case


@pytest.fixture(scope="module", autouse=True)
def stored(service: Service) -> None:
    with service.client() as client:
        client.put(f"/v1/programs/{STORED}", json=SMALL).raise_for_status()


@schema.exclude(path_regex="/events$").parametrize()  # those streams do not end
@settings(max_examples=25, suppress_health_check=list(HealthCheck))
def test_the_service_does_what_it_says(case: schemathesis.Case[Any], service: Service) -> None:
    case.call_and_validate(base_url=service.url, timeout=PATIENCE_SECONDS)
