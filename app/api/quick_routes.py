"""Routes whose only parameter is a model of the query, read without detours.

FastAPI looks at every field of such a model anew for each request, which takes a millisecond;
here pydantic reads the query at once, and what was read of the same query before is used again.
The interface's description is FastAPI's as ever.
"""

from __future__ import annotations

from collections.abc import Awaitable, Callable, Coroutine
from functools import lru_cache
from typing import Any, get_origin

from fastapi.exceptions import RequestValidationError
from fastapi.routing import APIRoute
from pydantic import BaseModel, ValidationError
from starlette.datastructures import QueryParams
from starlette.requests import Request
from starlette.responses import Response

REMEMBERED = 256
"""Queries whose reading is remembered, of each route."""

REMEMBERED_BYTES = 200
"""Longer ones are read anew: they would take memory, and are seldom sent twice."""


class QuickRoute(APIRoute):
    """A route of a function ``(request, query) -> Response`` whose query is a frozen model."""

    def get_route_handler(self) -> Callable[[Request], Coroutine[Any, Any, Response]]:
        """The function, called with what the query says. Raises `TypeError` for other functions."""
        endpoint: Callable[..., Awaitable[Response]] = self.endpoint
        (field,) = self.dependant.query_params
        model = field.field_info.annotation
        name = self.dependant.request_param_name
        if not (isinstance(model, type) and issubclass(model, BaseModel)) or name is None:
            raise TypeError(f"{endpoint} is not a function of a request and a query.")
        reader = Reader(model)

        async def handle(request: Request) -> Response:
            query = reader.read(request.scope["query_string"])
            return await endpoint(**{name: request, field.name: query})

        return handle


class Reader:
    """Reads queries as a model, whose fields are single values or lists."""

    def __init__(self, model: type[BaseModel]) -> None:
        if not model.model_config.get("frozen"):
            raise TypeError(f"{model.__name__} is not frozen, but shared by requests.")
        self._model = model
        self._lists = frozenset(
            field.validation_alias or name
            for name, field in model.model_fields.items()
            if list in {field.annotation, get_origin(field.annotation)}
        )
        self._remembered = lru_cache(REMEMBERED)(self._read)

    def read(self, query_string: bytes) -> BaseModel:
        """What it says. Raises `RequestValidationError`."""
        if len(query_string) > REMEMBERED_BYTES:
            return self._read(query_string)
        return self._remembered(query_string)

    def _read(self, query_string: bytes) -> BaseModel:
        given = QueryParams(query_string)
        known = {field.alias or name for name, field in self._model.model_fields.items()}
        values: dict[str, Any] = {}
        lists: dict[str, list[str]] = {}
        for name, value in given.multi_items():
            lists.setdefault(name, []).append(value)
        for name, every in lists.items():
            is_one = name not in self._lists and (name in known or len(every) == 1)
            values[name] = every[-1] if is_one else every
        try:
            return self._model.model_validate(values)
        except ValidationError as error:
            faults = [
                {**fault, "loc": ("query", *fault["loc"])}
                for fault in error.errors(include_url=False)
            ]
            raise RequestValidationError(faults) from None
