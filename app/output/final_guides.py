"""What guides the denoiser: colours and normals that are seen first, behind clear glass too."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

from app.output.final_variant import is_vectorised

CLEAR_SURFACES = 8
"""Through how many surfaces of clear glass a guide looks; a block has two, and more inside."""


def guide(renderer: Any, *, through_glass: bool) -> Any:
    """An integrator that draws albedo and normal as its last six channels.

    Through clear glass only where the variant is vectorised: else edges behind it are smeared.
    """
    if through_glass and is_vectorised(renderer):
        return _seeing_through(renderer)()
    return renderer.load_dict({"type": "aov", "aovs": "a:albedo,n:sh_normal"})


@lru_cache(maxsize=1)
def _seeing_through(renderer: Any) -> Any:
    import drjit

    class SeeingThrough(renderer.SamplingIntegrator):  # type: ignore[misc]
        """Follows light through clear glass without choosing at random, hence without noise."""

        def __init__(self) -> None:
            super().__init__(renderer.Properties())
            self.context = renderer.BSDFContext()
            self.context.type_mask = renderer.BSDFFlags.DeltaTransmission

        def aov_names(self) -> list[str]:
            return [f"{part}.{axis}" for part in ("albedo", "normal") for axis in "XYZ"]

        def sample(
            self, scene: Any, sampler: Any, ray: Any, medium: Any = None, active: Any = True
        ) -> Any:
            del sampler, medium

            def cross(
                ray: Any, tint: Any, albedo: Any, normal: Any, active: Any, depth: Any
            ) -> Any:
                hit = scene.ray_intersect(ray, active)
                active &= hit.is_valid()
                bsdf = hit.bsdf(ray)
                clear = active & renderer.has_flag(
                    bsdf.flags(), renderer.BSDFFlags.DeltaTransmission
                )
                solid = active & ~clear
                color = bsdf.eval_diffuse_reflectance(hit, solid)
                albedo = drjit.select(solid, tint * color, albedo)
                # Where glass itself is seen last, its edges are still worth keeping.
                normal = drjit.select(active, hit.sh_frame.n, normal)
                sampled, weight = bsdf.sample(
                    self.context, hit, renderer.Float(0.5), renderer.Point2f(0.5), clear
                )
                through = drjit.max(weight) > 0.0
                outward = drjit.select(through, sampled.wo, renderer.reflect(hit.wi))
                tint = drjit.select(clear & through, tint * weight, tint)
                ray = drjit.select(clear, hit.spawn_ray(hit.to_world(outward)), ray)
                return ray, tint, albedo, normal, clear, depth + 1

            state = (
                renderer.Ray3f(ray),
                renderer.Color3f(1.0),
                renderer.Color3f(0.0),
                renderer.Normal3f(0.0),
                renderer.Bool(active),
                renderer.UInt32(0),
            )
            _, _, albedo, normal, _, _ = drjit.while_loop(
                state,
                lambda *now: now[4] & (now[5] < CLEAR_SURFACES),
                cross,
                labels=("ray", "tint", "albedo", "normal", "active", "depth"),
            )
            found = [albedo.x, albedo.y, albedo.z, normal.x, normal.y, normal.z]
            return renderer.Color3f(0.0), renderer.Bool(active), found

    return SeeingThrough
