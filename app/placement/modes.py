"""The ways in which items without positions are placed."""

from __future__ import annotations

from typing import Literal, TypeAlias

Mode: TypeAlias = Literal["rows", "layers", "ground", "sheet", "space"]
"""In rows by what contains them; in layers by how hyperedges flow; or by what these join: on the
ground, on an upright sheet that faces the reader, or in space."""

BY_STRESS: frozenset[Mode] = frozenset({"ground", "sheet", "space"})
"""Modes in which what hyperedges join stands together."""
