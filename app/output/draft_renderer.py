"""Draws draft scenes: first what is seen at each sample, then the light on that.

Passes: a map of what the sun sees, and one of how high items are; the shells of tubes that have
halos; surfaces, as no more than normal and row for each of four samples in a pixel; what is
translucent, as lists; and at last the picture, in which samples of one surface are shaded once.

Importing this imports OpenGL: `app.output.gl_platform.choose_platform` comes first, and everything
here belongs to the one thread that owns the context.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

import numpy as np
from OpenGL import GL

from app.arrays import Floats, Singles
from app.output.draft_lists import USUAL, Lists
from app.output.draft_loading import Loaded
from app.output.draft_maps import LightMaps
from app.output.draft_scene import Section
from app.output.draft_stage import Stage
from app.output.draft_textures import Grains
from app.output.draft_view import Frame, Pixels, Uniform
from app.output.gl_buffers import Shape, Target, begin_depth, read_depths, read_pixels
from app.output.gl_programs import program

TABLE, SUN, SKY, SURFACES, DEPTHS, ALBEDOS, SHELLS, SHELL_DEPTHS, GRAIN, HEADS = range(10)
"""Units of textures: no two kinds may share one, so each has its own."""

_UNITS: dict[str, Uniform] = {
    "table": TABLE,
    "sun_map": SUN,
    "sky_map": SKY,
    "surfaces": SURFACES,
    "depths": DEPTHS,
    "albedos": ALBEDOS,
    "shells": SHELLS,
    "shell_depths": SHELL_DEPTHS,
    "grain": GRAIN,
    "first_nodes": HEADS,
}


_LIGHT = ("LIGHTS", "SUN_CASTS", "CONTACTS", "METALS", "COATS", "PLAIN")
"""Definitions that shaders of light know."""

_NOTHING = np.zeros(4, dtype=np.uint32)


class DraftRenderer:
    """Draws into the current context, one picture after another."""

    def __init__(self) -> None:
        self._maps = LightMaps()
        self._grains = Grains()
        self._lists = Lists()
        self._targets: dict[str, Target] = {}
        self._mapped: Loaded | None = None
        self._most_samples = int(GL.glGetIntegerv(GL.GL_MAX_INTEGER_SAMPLES))
        GL.glPixelStorei(GL.GL_PACK_ALIGNMENT, 1)

    def load(self, stage: Stage) -> Loaded:
        """Give the scene to OpenGL; `unload` takes it back."""
        return Loaded(stage)

    @contextmanager
    def loaded(self, stage: Stage) -> Iterator[Loaded]:
        """For a while."""
        loaded = self.load(stage)
        try:
            yield loaded
        finally:
            self.unload(loaded)

    def unload(self, loaded: Loaded) -> None:
        """Forget the scene."""
        if self._mapped is loaded:
            self._mapped = None
        loaded.delete()

    def draw(
        self,
        loaded: Loaded,
        frame: Frame,
        background: Floats,
        size: tuple[int, int],
        samples: int,
    ) -> Pixels:
        """The picture, (height, width, 4), of ``size`` (width, height), from top to bottom.

        ``background`` (4,) and what comes back are sRGB multiplied by opacity, and opacity;
        ``samples`` are those of each pixel.
        """
        if self._mapped is not loaded:
            self._maps.draw(loaded)
            self._mapped = loaded
        has_ground = float(loaded.scene.ground is not None)
        shot = _Shot(
            loaded,
            size,
            max(1, min(samples, self._most_samples)),
            {
                **_UNITS,
                **self._maps.numbers,
                **loaded.numbers,
                **frame.numbers(size),
                "ground": frame.ground_depths(loaded.scene.floor, size) * has_ground,
                "rows": size[1],
                "background": background,
            },
        )
        loaded.table.bind(TABLE)
        self._maps.bind(SUN, SKY)
        if "HALOS" in loaded.defines:
            self._draw_shells(shot)
        self._draw_surfaces(shot)
        if "CLEARS" in loaded.defines:
            self._draw_lists(shot)
        return self._draw_picture(shot)

    def depths(self, loaded: Loaded, frame: Frame, size: tuple[int, int]) -> Singles:
        """Depths (height, width) from 0 to 1 of the nearest surfaces, from top to bottom."""
        shot = _Shot(loaded, size, 0, frame.numbers(size))
        self._target("depths", shot, ())
        begin_depth()
        shot.use("place.vert", "place.frag")
        loaded.vertices.draw(0, len(loaded.scene.faces))
        return read_depths(*size)[::-1]

    def _draw_shells(self, shot: _Shot) -> None:
        target = self._target("shells", shot, (GL.GL_R32UI,))
        begin_depth()
        GL.glClearBufferuiv(GL.GL_COLOR, 0, _NOTHING)
        for part in shot.parts:
            if part.shows == "hyperedge":
                shot.draw(part, "shell.vert", "shell.frag")
        target.bind(0, SHELLS)
        target.bind(1, SHELL_DEPTHS)

    def _draw_surfaces(self, shot: _Shot) -> None:
        has_albedos = "ALBEDOS" in shot.loaded.defines
        formats = (GL.GL_RG32UI, GL.GL_RGBA8) if has_albedos else (GL.GL_RG32UI,)
        target = self._target("surfaces", shot, formats)
        begin_depth()
        GL.glClearBufferuiv(GL.GL_COLOR, 0, _NOTHING)
        for part in shot.parts:
            if not part.is_clear:
                self._grains.bind(part.texture, GRAIN)
                shot.draw(part, "surface.vert", "octahedron.glsl+surface.frag", "ALBEDOS")
        target.bind(0, SURFACES)
        target.bind(len(formats), DEPTHS)
        if has_albedos:
            target.bind(1, ALBEDOS)

    def _draw_lists(self, shot: _Shot) -> None:
        """Draw them, and once more where they were longer than there was room for."""
        room = USUAL
        while True:
            self._lists.begin(shot.size, shot.samples, room)
            GL.glDisable(GL.GL_DEPTH_TEST)
            for part in shot.parts:
                if part.is_clear:
                    self._grains.bind(part.texture, GRAIN)
                    shot.draw(part, "surface.vert", "lists.glsl+light.glsl+glass.frag", *_LIGHT)
            count = self._lists.end()
            if count <= self._lists.room:
                break
            room = count
        self._lists.bind(HEADS)

    def _draw_picture(self, shot: _Shot) -> Pixels:
        self._target("picture", shot, (GL.GL_RGBA8,), is_plain=True)
        GL.glDisable(GL.GL_DEPTH_TEST)
        fragment = "octahedron.glsl+light.glsl+picture.frag"
        if "CLEARS" in shot.loaded.defines:
            fragment = "lists.glsl+layers.glsl+" + fragment
        shot.use("screen.vert", fragment, *_LIGHT, "ALBEDOS", "CLEARS")
        GL.glDrawArrays(GL.GL_TRIANGLES, 0, 3)
        return read_pixels(*shot.size)

    def _target(
        self, name: str, shot: _Shot, formats: tuple[int, ...], *, is_plain: bool = False
    ) -> Target:
        """The target of that name, to draw into from now on; made anew where it does not fit."""
        samples, depth_format = shot.samples, GL.GL_DEPTH_COMPONENT32F
        wanted = (
            Shape(*shot.size, formats)
            if is_plain
            else Shape(*shot.size, formats, depth_format, samples)
        )
        known = self._targets.get(name)
        if known is None or known.shape != wanted:
            if known is not None:
                known.delete()
            self._targets[name] = Target(wanted)
        self._targets[name].begin()
        return self._targets[name]


@dataclass(frozen=True, slots=True, eq=False)
class _Shot:
    """One picture of a scene, and all that shaders are told of it."""

    loaded: Loaded
    size: tuple[int, int]
    samples: int
    numbers: dict[str, Uniform]

    @property
    def parts(self) -> tuple[Section, ...]:
        return self.loaded.scene.sections

    def use(self, vertex: str, fragment: str, *defines: str, **more: int) -> None:
        """Draw with these shaders, with those of the scene's ``defines`` that are asked for."""
        known = self.loaded.defines
        chosen = {name: known[name] for name in defines if name in known}
        program(vertex, fragment, SAMPLES=self.samples, **chosen, **more).use(self.numbers)

    def draw(self, part: Section, vertex: str, fragment: str, *defines: str) -> None:
        more: dict[str, int] = {"TEXTURE": 1} if part.texture else {}
        if part.is_clear:
            more["CLEAR"] = 1
        if part.shows == "hyperedge" and "HALOS" in self.loaded.defines:
            more["HALOS"] = 1
            fragment = "halo.glsl+" + fragment
        self.use(vertex, fragment, *defines, **more)
        self.loaded.vertices.draw(part.first, part.count)
