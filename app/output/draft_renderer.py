"""pyrender's renderer with our own light: shaders, shadows that fit, and any antialiasing.

Importing this imports pyrender and OpenGL: `app.output.gl_platform.choose_platform` comes first,
and everything here belongs to the one thread that owns the context.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pyrender
from OpenGL import GL
from pyrender.constants import ProgramFlags, RenderFlags
from pyrender.shader_program import ShaderProgramCache
from scipy.ndimage import gaussian_filter

from app.arrays import Floats
from app.output.draft_light import Lighting, ShadowCamera, shadow_camera
from app.output.draft_scene import Batch, DraftScene
from app.output.draft_view import Frame, Pixels
from app.output.gl_buffers import (
    fill_texture,
    framebuffer,
    read_depths,
    read_pixels,
    smooth_texture,
)

SUN_TEXELS = 2048
"""Fixed by pyrender. Fitted to the scene, a texel is smaller than a pixel of usual pictures."""

SKY_TEXELS = 256
"""What it holds is blurred over the width of an item: more would not be seen."""

BLURS = 0.25, 0.8
"""How far the near and the wide darkness beside an item go, in shares of the scene's reach."""

_SHADERS = Path(__file__).with_name("shaders")

_OPAQUE = pyrender.MetallicRoughnessMaterial(name="opaque")
_TRANSLUCENT = pyrender.MetallicRoughnessMaterial(name="translucent", alphaMode="BLEND")
_CATCHER = pyrender.MetallicRoughnessMaterial(name="shadow catcher", alphaMode="BLEND")


class _FrameCamera(pyrender.Camera):  # type: ignore[misc]  # pyrender has no types
    """A camera whose projection is given: that of a tile is not symmetric."""

    def __init__(self, projection: Floats) -> None:
        super().__init__()
        self.projection = projection

    def get_projection_matrix(self, width: int | None = None, height: int | None = None) -> Floats:
        """The projection, whatever the size."""
        del width, height
        return self.projection


class DraftRenderer(pyrender.Renderer):  # type: ignore[misc]  # pyrender has no types
    """Draws draft scenes into the current context, one after another.

    pyrender keeps buffers, programs and passes. Overridden are its shaders; its shadow cameras,
    which are several times wider than the scene; its order of drawing, which is by the origins
    of meshes; its blending, wrong where the background is transparent; and its framebuffer,
    always of four samples, which reads depth back each time.
    """

    # Of the picture that is being drawn.
    _scene: DraftScene
    _lighting: Lighting
    _shadow_cameras: dict[Any, ShadowCamera]
    _eye: Floats

    def __init__(self) -> None:
        super().__init__(1, 1)
        self._program_cache = ShaderProgramCache(shader_dir=str(_SHADERS))
        self._sun = pyrender.DirectionalLight(name="sun")
        self._sky = pyrender.DirectionalLight(name="sky")
        self._sky.shadow_texture = pyrender.Texture(
            width=SKY_TEXELS, height=SKY_TEXELS, source_channels="D", data_format=GL.GL_FLOAT
        )
        self._empty = self._stage(np.zeros(4))
        self._heights = smooth_texture()
        self._samples = self._allocated_samples = 1
        self._main_fb_dims: tuple[int, int] = (0, 0)

    def draw(
        self,
        scene: DraftScene,
        lighting: Lighting,
        background: Floats,
        frames: Sequence[Frame],
        *,
        size: tuple[int, int],
        samples: int,
    ) -> list[Pixels]:
        """One picture of ``size`` (width, height) for each of ``frames``.

        ``background`` (4,) is sRGB multiplied by opacity, and opacity; ``samples`` are those
        of each pixel.
        """
        self.viewport_width, self.viewport_height = size
        self._samples = min(samples, int(GL.glGetIntegerv(GL.GL_MAX_SAMPLES)))
        self._scene, self._lighting = scene, lighting
        self._shadow_cameras = self._fit_shadow_cameras()
        stage = self._stage(background)
        for batches, role, material in (
            (scene.items, "item", _OPAQUE),
            (scene.hyperedges, "hyperedge", _OPAQUE),
            (scene.catcher, "catcher", _CATCHER),
            (scene.translucent, "translucent", _TRANSLUCENT),
        ):
            for batch in batches:
                order = f"{len(stage.mesh_nodes):06}"
                stage.add(pyrender.Mesh([_primitive(batch, material)], name=role), name=order)
        try:
            return list(self._draw_frames(stage, frames))
        finally:
            self._update_context(self._empty, RenderFlags.NONE)  # lets go of the meshes

    def _stage(self, background: Floats) -> Any:
        stage = pyrender.Scene(bg_color=background)
        stage.add(self._sun)
        stage.add(self._sky)
        return stage

    def _draw_frames(self, stage: Any, frames: Sequence[Frame]) -> Iterator[Pixels]:
        flags = RenderFlags.OFFSCREEN | RenderFlags.SHADOWS_DIRECTIONAL
        for frame in frames:
            camera = stage.add(_FrameCamera(frame.projection), pose=np.linalg.inv(frame.view))
            stage.main_camera_node = camera
            self._eye = frame.eye
            yield self.render(stage, flags)
            stage.remove_node(camera)
            flags = RenderFlags.OFFSCREEN  # the shadows are those of the first frame

    def _fit_shadow_cameras(self) -> dict[Any, ShadowCamera]:
        cameras: dict[Any, ShadowCamera] = {}
        scene = self._scene
        if self._lighting.sun is not None:
            casters = [batch.positions for batch in scene.casters]
            cameras[self._sun] = shadow_camera(self._lighting.sun, casters, edge=8 / SUN_TEXELS)
        if scene.items and scene.reach > 0.0:
            cameras[self._sky] = shadow_camera(
                np.array([0.0, 0.0, 1.0]),
                [batch.positions for batch in scene.items],
                edge=1 / SKY_TEXELS,
                margin=3 * scene.reach,
            )
        return cameras

    # What pyrender calls.

    def _sorted_mesh_nodes(self, scene: Any) -> list[Any]:
        return sorted(scene.mesh_nodes, key=lambda node: node.name)

    def _get_light_cam_matrices(
        self, scene: Any, light_node: Any, flags: int
    ) -> tuple[Floats, Floats]:
        del scene, flags
        return np.eye(4), self._shadow_cameras[light_node.light].clip_matrix

    def _shadow_mapping_pass(self, scene: Any, light_node: Any, flags: int) -> None:
        light = light_node.light
        if light not in self._shadow_cameras:
            return
        casters = {"item"} if light is self._sky else {"item", "hyperedge", "translucent"}
        with _only(scene.meshes, casters):
            super()._shadow_mapping_pass(scene, light_node, flags)
        if light is self._sky:
            self._spread_heights()

    def _configure_shadow_mapping_viewport(self, light: Any, flags: int) -> None:
        super()._configure_shadow_mapping_viewport(light, flags)
        texture = light.shadow_texture  # bound by pyrender
        GL.glViewport(0, 0, texture.width, texture.height)
        for name, value in (
            (GL.GL_TEXTURE_COMPARE_MODE, GL.GL_COMPARE_REF_TO_TEXTURE),
            (GL.GL_TEXTURE_COMPARE_FUNC, GL.GL_LEQUAL),
            (GL.GL_TEXTURE_MAG_FILTER, GL.GL_LINEAR),
            (GL.GL_TEXTURE_MIN_FILTER, GL.GL_LINEAR),
            (GL.GL_TEXTURE_WRAP_S, GL.GL_CLAMP_TO_BORDER),  # whose depth 1 is in the light
            (GL.GL_TEXTURE_WRAP_T, GL.GL_CLAMP_TO_BORDER),
        ):
            GL.glTexParameteri(GL.GL_TEXTURE_2D, name, value)

    def _spread_heights(self) -> None:
        """Read back what the sky sees, and blur it: near and wide."""
        camera = self._shadow_cameras[self._sky]
        depths = read_depths(SKY_TEXELS)
        heights = (depths - camera.matrix[2, 3]) / camera.matrix[2, 2]
        heights[depths == 1.0] = self._scene.floor
        width = self._scene.reach * SKY_TEXELS / camera.extent[1::-1]
        blurred = [gaussian_filter(heights, share * width, mode="nearest") for share in BLURS]
        fill_texture(self._heights, np.stack(blurred, axis=-1))

    def _get_primitive_program(self, primitive: Any, flags: int, program_flags: int) -> Any:
        del flags
        defines: dict[str, int] = {}
        if program_flags & ProgramFlags.USE_MATERIAL:
            name = "surface"
            defines["LIGHTS"] = len(self._lighting.toward)
            if self._sun in self._shadow_cameras:
                defines["SUN_CASTS"] = 1
            if self._sky in self._shadow_cameras:
                defines["CONTACTS"] = 1
            if primitive.material is _CATCHER:
                defines["CATCHER"] = 1
        else:
            name = "shadow"
            if primitive.material is _TRANSLUCENT:
                defines["SIEVE"] = 1
        program = self._program_cache.get_program(f"{name}.vert", f"{name}.frag", defines=defines)
        if not program._in_context():  # noqa: SLF001 (as pyrender does here)
            program._add_to_context()  # noqa: SLF001
        return program

    def _bind_lighting(self, scene: Any, program: Any, node: Any, flags: int) -> None:
        del scene, node, flags
        light = self._lighting
        uniforms: dict[str, Floats | int | float] = {
            "eye": self._eye,
            "sky": light.sky,
            "earth": light.earth,
            "reach": self._scene.reach,
        }
        for number, (toward, radiance) in enumerate(zip(light.toward, light.radiance, strict=True)):
            uniforms[f"toward[{number}]"] = toward
            uniforms[f"radiance[{number}]"] = radiance
        for name, camera in (("sun", self._sun), ("sky", self._sky)):
            if camera in self._shadow_cameras:
                uniforms[f"{name}_matrix"] = self._shadow_cameras[camera].matrix
        if self._sun in self._shadow_cameras:
            extent = self._shadow_cameras[self._sun].extent
            uniforms["sun_texel"] = float(extent[:2].max()) / SUN_TEXELS
        for name, value in uniforms.items():
            program.set_uniform(name, value)
        # Two kinds of sampler may not share a unit, not even where neither is used.
        self._bind_texture(self._sun.shadow_texture, "sun_map", program)
        unit = self._get_next_active_texture()
        GL.glActiveTexture(GL.GL_TEXTURE0 + unit)
        GL.glBindTexture(GL.GL_TEXTURE_2D, self._heights)
        program.set_uniform("sky_map", unit)

    def _bind_and_draw_primitive(
        self, primitive: Any, pose: Floats, program: Any, flags: int
    ) -> None:
        if flags & RenderFlags.DEPTH_ONLY:
            super()._bind_and_draw_primitive(primitive, pose, program, flags)
            return
        blended = primitive.material is not _OPAQUE
        GL.glDepthMask(GL.GL_FALSE if blended else GL.GL_TRUE)
        GL.glEnable(GL.GL_BLEND)
        GL.glBlendFunc(GL.GL_ONE, GL.GL_ONE_MINUS_SRC_ALPHA if blended else GL.GL_ZERO)
        GL.glEnable(GL.GL_CULL_FACE)
        GL.glCullFace(GL.GL_BACK)
        primitive._bind()  # noqa: SLF001 (as pyrender does here)
        GL.glDrawElements(GL.GL_TRIANGLES, primitive.indices.size, GL.GL_UNSIGNED_INT, None)
        primitive._unbind()  # noqa: SLF001
        GL.glDepthMask(GL.GL_TRUE)

    def _configure_main_framebuffer(self) -> None:
        size = self.viewport_width, self.viewport_height
        if self._main_fb_dims == size and self._allocated_samples == self._samples:
            return
        self._delete_main_framebuffer()
        self._main_fb, self._main_cb, self._main_db = framebuffer(size, 1)
        self._main_fb_ms, self._main_cb_ms, self._main_db_ms = (
            (self._main_fb, self._main_cb, self._main_db)
            if self._samples == 1
            else framebuffer(size, self._samples)
        )
        self._main_fb_dims, self._allocated_samples = size, self._samples

    def _read_main_framebuffer(self, scene: Any, flags: int) -> Pixels:
        del scene, flags
        width, height = self._main_fb_dims
        if self._samples > 1:
            GL.glBindFramebuffer(GL.GL_READ_FRAMEBUFFER, self._main_fb_ms)
            GL.glBindFramebuffer(GL.GL_DRAW_FRAMEBUFFER, self._main_fb)
            GL.glBlitFramebuffer(
                0, 0, width, height, 0, 0, width, height, GL.GL_COLOR_BUFFER_BIT, GL.GL_NEAREST
            )
        return read_pixels(self._main_fb, width, height)


@contextmanager
def _only(meshes: set[Any], names: set[str]) -> Iterator[None]:
    """Hide the other meshes for a while."""
    hidden = [mesh for mesh in meshes if mesh.name not in names]
    for mesh in hidden:
        mesh.is_visible = False
    try:
        yield
    finally:
        for mesh in hidden:
            mesh.is_visible = True


def _primitive(batch: Batch, material: Any) -> Any:
    return pyrender.Primitive(
        positions=batch.positions,
        normals=batch.normals,
        texcoord_0=batch.surfaces,
        color_0=batch.colors,
        indices=batch.faces,
        material=material,
    )
