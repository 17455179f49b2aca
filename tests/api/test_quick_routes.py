"""Queries are read as FastAPI reads them."""

from __future__ import annotations

from typing import Annotated, Any
from urllib.parse import quote, urlencode

import pytest
from fastapi import APIRouter
from fastapi import Query as QueryParameters
from fastapi.dependencies.utils import request_params_to_args
from fastapi.exceptions import RequestValidationError
from fastapi.routing import APIRoute
from hypothesis import given
from hypothesis import strategies as st
from pydantic import BaseModel
from starlette.datastructures import QueryParams
from starlette.requests import Request
from starlette.responses import Response

from app.api.queries import ConvertQuery, RenderQuery
from app.api.quick_routes import QuickRoute, Reader

NAMES = ["format", "width", "from", "source", "sweep", "sheet", "noise", "quality", "to", "x", ""]
VALUES = ["", "png", "glb", "12", "1e3", "-1", "true", "True", "tubeloom", "hif", "0.5", "nan", "ä"]


def read_by_fastapi(model: type[BaseModel], query_string: bytes) -> Any:
    """A query as FastAPI reads it: a model, or errors."""

    async def endpoint(query: Annotated[model, QueryParameters()]) -> None:  # type: ignore[valid-type]
        """What asks for it."""

    endpoint.__annotations__["query"] = Annotated[model, QueryParameters()]
    fields = APIRoute("/", endpoint).dependant.query_params
    values, errors = request_params_to_args(fields, QueryParams(query_string))
    return errors or values["query"]


def read_by_us(model: type[BaseModel], query_string: bytes) -> Any:
    """The same as we read it."""
    try:
        return Reader(model).read(query_string)
    except RequestValidationError as error:
        return list(error.errors())


def comparable(found: Any) -> Any:
    """Errors carry exceptions, which are equal to themselves only."""
    if not isinstance(found, list):
        return found
    kept = ("type", "loc", "msg", "input")
    return [{name: str(fault[name]) for name in kept} for fault in found]


@given(
    st.sampled_from([RenderQuery, ConvertQuery]),
    st.lists(st.tuples(st.sampled_from(NAMES), st.sampled_from(VALUES)), max_size=5),
)
def test_every_query_is_read_as_fastapi_reads_it(
    model: type[BaseModel], pairs: list[tuple[str, str]]
) -> None:
    query = urlencode(pairs).encode()
    assert comparable(read_by_us(model, query)) == comparable(read_by_fastapi(model, query))


def test_what_was_read_is_remembered_unless_it_is_long() -> None:
    reader = Reader(RenderQuery)
    assert reader.read(b"width=10") is reader.read(b"width=10")
    long = f"sweep={quote('/style/halo=' + ','.join(['0.1'] * 40))}".encode()
    assert reader.read(long) == reader.read(long)
    assert reader.read(long) is not reader.read(long)


def test_a_fault_is_told_each_time() -> None:
    reader = Reader(RenderQuery)
    for _ in range(2):
        with pytest.raises(RequestValidationError):
            reader.read(b"width=0")


def test_other_functions_are_refused() -> None:
    router = APIRouter(route_class=QuickRoute)

    async def wrong(request: Request, x: int) -> Response:
        raise NotImplementedError

    with pytest.raises(TypeError):
        router.get("/")(wrong)


def test_a_model_that_can_be_changed_is_refused() -> None:
    class Changing(BaseModel):
        x: int = 0

    with pytest.raises(TypeError, match="frozen"):
        Reader(Changing)
