"""From query parameters to what the pipeline is asked."""

from __future__ import annotations

from collections.abc import Mapping

from app.answers import LayoutWishes, RenderOptions
from app.api.negotiation import choose
from app.api.problems import ContradictionError
from app.api.queries import SceneQuery
from app.output.effort import Effort
from app.output.media import SceneFormat

SCENES: Mapping[str, SceneFormat] = {scene.media_type: scene for scene in SceneFormat}


def scene_format(query: SceneQuery, accept: str | None) -> SceneFormat:
    """The format of the answer. Raises `NotAcceptableError` and `ContradictionError`."""
    if not (query.sheet or query.sweep):
        return query.format or choose(accept, SCENES)
    if query.sheet and query.sweep:
        raise ContradictionError("A picture is either a sheet of views or a sweep.")
    if query.format not in {None, SceneFormat.PNG}:
        raise ContradictionError(f"Sheets and sweeps are pictures: png, not {query.format}.")
    return choose(accept, {SceneFormat.PNG.media_type: SceneFormat.PNG})


def render_options(
    query: SceneQuery, wanted: SceneFormat, source: str, wishes: LayoutWishes = ()
) -> RenderOptions:
    """What the pipeline is asked; ``source`` is the format of the document."""
    return RenderOptions(
        format=wanted,
        width=query.width,
        height=query.height,
        quality=query.quality,
        source=source,
        scale=query.scale,
        parts=query.parts,
        compress=query.compress,
        merge=query.merge,
        effort=Effort(query.samples, query.time_limit, query.noise, query.denoise, query.seed),
        motion=query.motion,
        frames=query.frames,
        seconds=query.duration,
        sheet=query.sheet,
        sweep=tuple(query.sweep),
        wishes=wishes,
    )
