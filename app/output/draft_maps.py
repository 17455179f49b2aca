"""Maps of the light on a scene: what the sun sees, and how high items stand around a place.

As all that imports OpenGL: only on the thread that owns the context.
"""

from __future__ import annotations

import numpy as np
from OpenGL import GL

from app.output.draft_light import ShadowCamera, shadow_camera
from app.output.draft_loading import Loaded
from app.output.draft_scene import corners_of
from app.output.draft_view import Uniform
from app.output.gl_buffers import Shape, Target, begin_depth, fill_texture, filtered
from app.output.gl_programs import program

MOST_FITTED = 1 << 18
"""Vertices that the sun's map is fitted to; of more, boxes around them do."""


class LightMaps:
    """Both maps of the scene that was drawn last."""

    def __init__(self) -> None:
        self._sun = _sun_target(1)
        self._heights = int(GL.glGenTextures(1))
        GL.glBindTexture(GL.GL_TEXTURE_2D, self._heights)
        filtered(GL.GL_CLAMP_TO_EDGE)
        self._camera: ShadowCamera | None = None

    def draw(self, loaded: Loaded) -> None:
        """Draw those that the scene has."""
        stage = loaded.stage
        if stage.lighting.sun is not None:
            if self._sun.shape.width != stage.sun_texels:
                self._sun.delete()
                self._sun = _sun_target(stage.sun_texels)
            self._draw_sun(loaded)
        if stage.heights is not None:
            fill_texture(self._heights, stage.heights.values)

    def bind(self, sun: int, sky: int) -> None:
        """Put both on their units."""
        self._sun.bind(0, sun)
        GL.glActiveTexture(GL.GL_TEXTURE0 + sky)
        GL.glBindTexture(GL.GL_TEXTURE_2D, self._heights)

    @property
    def numbers(self) -> dict[str, Uniform]:
        """What shaders must know of the maps."""
        if self._camera is None:
            return {}
        texel = float(self._camera.extent[:2].max()) / self._sun.shape.width
        return {"sun_matrix": self._camera.matrix, "sun_texel": texel}

    def _draw_sun(self, loaded: Loaded) -> None:
        scene = loaded.scene
        fitted = len(scene.positions) <= MOST_FITTED
        points = scene.positions if fitted else corners_of(scene.boxes).astype(np.float32)
        toward = loaded.stage.lighting.toward[0]
        self._camera = shadow_camera(toward, points, edge=8 / self._sun.shape.width)
        self._sun.begin()
        begin_depth()
        loaded.table.bind(0)
        for is_clear in (False, True):
            defines = {"SIEVE": 1} if is_clear else {}
            numbers: dict[str, Uniform] = {"to_clip": self._camera.clip_matrix, "table": 0}
            program("place.vert", "place.frag", **defines).use(numbers)
            for part in scene.sections:
                if part.is_clear == is_clear:
                    loaded.vertices.draw(part.first, part.count)


def _sun_target(texels: int) -> Target:
    target = Target(Shape(texels, texels, (), GL.GL_DEPTH_COMPONENT32F))
    GL.glBindTexture(GL.GL_TEXTURE_2D, target.textures[0])
    filtered(GL.GL_CLAMP_TO_EDGE)  # where nothing is seen: the map is wider than what there is
    for name, value in (
        (GL.GL_TEXTURE_COMPARE_MODE, GL.GL_COMPARE_REF_TO_TEXTURE),
        (GL.GL_TEXTURE_COMPARE_FUNC, GL.GL_LEQUAL),
    ):
        GL.glTexParameteri(GL.GL_TEXTURE_2D, name, value)
    return target
