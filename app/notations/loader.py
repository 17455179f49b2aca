"""Finds notations: the JSON files beside this module."""

from __future__ import annotations

from functools import lru_cache
from importlib.resources import files

from app.errors import UnknownName
from app.notations.notation import Notation


@lru_cache(maxsize=1)
def notation_names() -> tuple[str, ...]:
    """The names of all notations, in alphabetical order."""
    folder = files("app.notations")
    return tuple(
        sorted(
            entry.name.removesuffix(".json")
            for entry in folder.iterdir()
            if entry.name.endswith(".json")
        )
    )


@lru_cache(maxsize=64)
def load_notation(name: str) -> Notation:
    """The notation called ``name``. Raises `UnknownName` where there is none."""
    if name not in notation_names():
        raise UnknownName("notation", name, notation_names())
    return Notation.model_validate_json(files("app.notations").joinpath(f"{name}.json").read_text())
