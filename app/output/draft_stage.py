"""A scene in its light: all that the renderer must be told of it, before OpenGL hears of it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from app.output.draft_heights import Heights, heights
from app.output.draft_light import Lighting, lighting
from app.output.draft_scene import DraftScene
from app.scene.scene import Light

SUN_TEXELS = 1024, 1536, 2048
"""Sides that the map of shadows may have."""

FINENESS = 1.5
"""How many times the picture's side that is, where it may."""


@dataclass(frozen=True, slots=True, eq=False)
class Stage:
    """A scene in its light, and the side of the map of shadows, in texels."""

    scene: DraftScene
    lighting: Lighting
    heights: Heights | None
    sun_texels: int


def stage(scene: DraftScene, lights: Sequence[Light], side: int) -> Stage:
    """With shadows that are fine enough for pictures of so many pixels along their longer side."""
    fine_enough = (texels for texels in SUN_TEXELS if texels >= FINENESS * side)
    texels = next(fine_enough, SUN_TEXELS[-1])
    return Stage(scene, lighting(lights), heights(scene), texels)
