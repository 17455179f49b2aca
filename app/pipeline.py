"""From a posted document to an answer: the rooms put one after another. Read this first."""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from functools import partial

from app import __version__
from app.answers import (
    Answer,
    ConvertOptions,
    LayoutOptions,
    Options,
    RenderOptions,
    Unchanged,
    is_known,
)
from app.arrays import Floats
from app.errors import PictureTooLarge
from app.formats import registry
from app.hyperedges.routing import Routing
from app.layout import Progress, judge, lay_out, silent
from app.notations.loader import load_notation
from app.output.draft import draw_draft
from app.output.gltf import write_glb, write_gltf
from app.output.gltf_packing import Packing
from app.output.media import SceneFormat
from app.output.numbers import layout_numbers
from app.output.shells import refuse_too_many, triangles_of
from app.output.stl import write_stl
from app.output.threemf import write_3mf
from app.placement.placement import Placement
from app.program.collection import collection_paused
from app.program.digest import canonical
from app.program.model import Program
from app.scene.assemble import assemble
from app.scene.detail import tolerances
from app.scene.scene import Scene
from app.settings import Settings
from app.tubes.patches import patch_pairs, patch_tubes
from app.tubes.sweep import sweep
from app.tubes.tubes import Tubes
from app.tubes.unions import plan_unions, unite
from app.tubes.unswept import UnsweptTubes

TUBE_TOLERANCE = 0.02
"""How far a mesh may be from its tube, as a share of the thinnest radius: some 16 sides. Further
where no picture of the size asked for could show it; see `app.scene.detail`."""


Sweeping = Callable[[Program, Routing, float | Floats], Tubes | UnsweptTubes]
"""Makes tubes that are off by no more than a tolerance: one for all, or one for each (h,)."""


def answer(
    data: bytes,
    options: Options,
    settings: Settings,
    known: frozenset[str] = frozenset(),
    progress: Progress = silent,
) -> Answer | Unchanged:
    """Whatever ``options`` ask of the document ``data``.

    ``known`` are validators of answers that the asker has. Raises what `app.errors` lists.
    """
    match options:
        case RenderOptions():
            return render(data, options, settings, known, progress)
        case LayoutOptions():
            return layout(data, options, settings, known, progress)
        case ConvertOptions():
            return convert(data, options, settings, known, progress)


def render(
    data: bytes,
    options: RenderOptions,
    settings: Settings,
    known: frozenset[str] = frozenset(),
    progress: Progress = silent,
) -> Answer | Unchanged:
    """The scene of the document, in ``options.format``."""
    with collection_paused():
        return _render(data, options, settings, known, progress)


def _render(
    data: bytes,
    options: RenderOptions,
    settings: Settings,
    known: frozenset[str],
    progress: Progress,
) -> Answer | Unchanged:
    if options.width * options.height > settings.max_pixels:
        raise PictureTooLarge(
            f"{options.width} by {options.height} pixels are more than the "
            f"{settings.max_pixels} that this service draws."
        )
    progress("reading", 0.0)
    program = registry.read(options.source, data, settings)
    etag = validator(program, options)
    if is_known(etag, known):
        return Unchanged(etag)
    aspect = options.width / options.height
    if options.format.is_printed and options.parts != "items":
        bodies = partial(make_bodies, most=settings.max_print_triangles, progress=progress)
        scene = make_scene(program, aspect, progress, bodies)
    else:
        sweeping = make_crowd if _is_crowd(program, options) else make_tubes
        scene = make_scene(program, aspect, progress, sweeping=sweeping, height=options.height)
    if options.format.is_printed:
        refuse_too_many(triangles_of(scene, options.parts), settings.max_print_triangles)
    progress("writing", 0.6)
    body = _write(scene, options)
    progress("done", 1.0)
    return Answer(body, options.format.media_type, etag, program.name)


def layout(
    data: bytes,
    options: LayoutOptions,
    settings: Settings,
    known: frozenset[str] = frozenset(),
    progress: Progress = silent,
) -> Answer | Unchanged:
    """The numbers of the document's layout, as JSON."""
    progress("reading", 0.0)
    program = registry.read(options.source, data, settings)
    etag = validator(program, options)
    if is_known(etag, known):
        return Unchanged(etag)
    laid = lay_out(program, progress=progress)
    progress("proving clearance", 0.5)
    verdict = judge(laid)
    progress("writing", 0.6)
    patches = patch_pairs(laid.routing, program.layout.patch_rule) if options.patches else None
    body = layout_numbers(program, laid.placement, laid.routing, patches, verdict)
    progress("done", 1.0)
    return Answer(body, "application/json", etag, program.name)


def convert(
    data: bytes,
    options: ConvertOptions,
    settings: Settings,
    known: frozenset[str] = frozenset(),
    progress: Progress = silent,
) -> Answer | Unchanged:
    """The document in another format."""
    progress("reading", 0.0)
    program = registry.read(options.source, data, settings)
    etag = validator(program, options)
    if is_known(etag, known):
        return Unchanged(etag)
    progress("writing", 0.6)
    body = registry.write(options.target, program)
    progress("done", 1.0)
    return Answer(body, registry.FORMATS[options.target].media_type, etag, program.name)


def make_scene(
    program: Program,
    aspect: float,
    progress: Progress = silent,
    tubes_of: Callable[[Program, Routing], Tubes] | None = None,
    sweeping: Sweeping | None = None,
    height: int | None = None,
) -> Scene:
    """Place, route, make tubes, assemble: everything between reading and writing.

    Tubes are what ``tubes_of`` makes, or else ``sweeping`` (`make_tubes`); these are no finer than
    shows in a picture ``height`` pixels high, where there is one.
    """
    notation = load_notation(program.notation)
    laid = lay_out(program, progress=progress)
    placement, routing = laid.placement, laid.routing
    progress("making tubes", 0.4)
    tubes: Tubes | UnsweptTubes
    if tubes_of is not None:
        tubes = tubes_of(program, routing)
    else:
        tolerance = _tolerance(program, placement, routing, aspect, height)
        tubes = (sweeping or make_tubes)(program, routing, tolerance)
    progress("assembling the scene", 0.5)
    return assemble(program, notation, placement, tubes, aspect)


def make_tubes(program: Program, routing: Routing, tolerance: float | Floats) -> Tubes:
    """Tubes around the curves, as the document's ``layout`` wishes."""
    if not program.hyperedges:
        return Tubes.none()
    if program.layout.tube == "patches":
        return patch_tubes(routing, program.layout.patch_rule, tolerance)
    return sweep(routing, tolerance)


def make_crowd(_program: Program, routing: Routing, tolerance: float | Floats) -> UnsweptTubes:
    """Tubes of very many hyperedges, which are made when they are written."""
    return UnsweptTubes.of(routing, tolerance)


def make_bodies(program: Program, routing: Routing, *, most: int, progress: Progress) -> Tubes:
    """Tubes for printing: each hyperedge one closed body, of ``most`` triangles together."""
    if not program.hyperedges:
        return Tubes.none()
    plan = plan_unions(routing, TUBE_TOLERANCE * routing.radii)
    refuse_too_many(plan.triangles, most)
    names = [hyperedge.id for hyperedge in program.hyperedges]
    return unite(plan, names, lambda share: progress("making tubes", 0.4 + 0.1 * share))


def _is_crowd(program: Program, options: RenderOptions) -> bool:
    """Whether nobody needs a node for each hyperedge."""
    return (
        options.format in {SceneFormat.GLB, SceneFormat.GLTF}
        and program.layout.tube == "swept"
        and len(program.hyperedges) > 0
        and Packing(options.compress, options.merge).merges(len(program.hyperedges))
    )


def _tolerance(
    program: Program, placement: Placement, routing: Routing, aspect: float, height: int | None
) -> float | Floats:
    """How far meshes may be from their tubes: one for all, or one for each hyperedge, (h,)."""
    finest = TUBE_TOLERANCE * float(routing.radii.min(initial=1.0))
    if height is None or not program.hyperedges:
        return finest
    return tolerances(placement, routing, program.view, aspect, height, finest)


def validator(program: Program, options: object) -> str:
    """A strong validator: digest of the document, of what was asked, and of our version."""
    asked = f"{__version__}\n{options!r}\n".encode()
    return hashlib.sha256(asked + canonical(program)).hexdigest()[:32]


def _write(scene: Scene, options: RenderOptions) -> bytes:
    match options.format:
        case SceneFormat.GLB:
            return write_glb(scene, Packing(options.compress, options.merge))
        case SceneFormat.GLTF:
            return write_gltf(scene, Packing(options.compress, options.merge))
        case SceneFormat.PNG:
            return draw_draft(scene, options.width, options.height)
        case SceneFormat.STL:
            return write_stl(scene, options.parts, options.scale)
        case SceneFormat.THREE_MF:
            return write_3mf(scene, options.parts, options.scale)
