"""Scenes that OpenGL has at hand. As all that imports it: on the thread that owns the context."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from app.output.draft_scene import DraftScene
from app.output.draft_stage import Stage
from app.output.draft_view import Uniform
from app.output.gl_buffers import Table, Vertices


@dataclass(eq=False)
class Loaded:
    """A stage whose triangles OpenGL has at hand."""

    stage: Stage
    vertices: Vertices = field(init=False)
    table: Table = field(init=False)

    def __post_init__(self) -> None:
        scene = self.stage.scene
        attributes = (scene.positions, scene.normals, scene.rows, scene.coordinates)
        self.vertices = Vertices(attributes, scene.faces)
        self.table = Table(scene.table)

    @property
    def scene(self) -> DraftScene:
        """What there is to see."""
        return self.stage.scene

    @cached_property
    def defines(self) -> dict[str, int]:
        """What of the light and of surfaces shaders must reckon with."""
        table, stage = self.scene.table[1:], self.stage
        found: dict[str, int | np.bool_] = {
            "LIGHTS": len(stage.lighting.toward),
            "SUN_CASTS": stage.lighting.sun is not None,
            "CONTACTS": stage.heights is not None,
            "METALS": (table[:, 1, 0] > 0.0).any(),
            "COATS": (table[:, 1, 2] > 0.0).any(),
            "PLAIN": (table[:, 2, 2] < 0.5).any(),
            "ALBEDOS": any(part.texture and not part.is_clear for part in self.scene.sections),
            "HALOS": (table[:, 2, 0] > 0.0).any(),
            "CLEARS": any(part.is_clear for part in self.scene.sections),
        }
        return {name: int(value) for name, value in found.items() if value}

    @property
    def numbers(self) -> dict[str, Uniform]:
        """What shaders must know of the light."""
        light, heights = self.stage.lighting, self.stage.heights
        found: dict[str, Uniform] = {
            "toward": light.toward,
            "radiance": light.radiance,
            "sky": light.sky,
            "earth": light.earth,
            "unshaded": light.on_the_ground,
            "reach": self.scene.reach,
        }
        if heights is not None:
            found["sky_matrix"] = heights.matrix
        return found

    def delete(self) -> None:
        """Give the memory back."""
        self.vertices.delete()
        self.table.delete()
