"""From a posted document to an answer: the rooms put one after another. Read this first."""

from __future__ import annotations

import hashlib
import math
import time
from dataclasses import replace
from functools import partial

from app import __version__
from app.answers import (
    Answer,
    ConvertOptions,
    JoinOptions,
    LayoutOptions,
    Options,
    RenderOptions,
    Revised,
    ReviseOptions,
    Unchanged,
    is_known,
)
from app.compositions import contact_sheet, film, joined, variations
from app.formats import registry
from app.hyperedges.clearance.overlaps import find_overlaps
from app.hyperedges.stopping import Spent, nothing_spent
from app.layout import Preview, Progress, judge, lay_out, silent
from app.layout_record import read_layout
from app.output.draft import draw_draft
from app.output.gltf import write_glb, write_gltf
from app.output.gltf_motion import Animation
from app.output.gltf_packing import Packing
from app.output.media import SceneFormat
from app.output.numbers import layout_numbers
from app.output.png import encode_png
from app.output.shells import refuse_too_many, triangles_of
from app.output.stl import write_stl
from app.output.svg import write_svg
from app.output.threemf import write_3mf
from app.picture_limits import refuse_too_large
from app.pictures import BEGUN, Artist, size_of_one_eye
from app.program.collection import collection_paused
from app.program.digest import canonical
from app.program.model import Program
from app.recent_layouts import recent_layouts
from app.revising import revise
from app.scene.scene import Scene
from app.settings import Settings
from app.shared_layout import SharedLayout
from app.staging import (
    Staged,
    Sweeping,
    bodies_for_print,
    make_crowd,
    make_scene,
    make_tubes,
    stage,
    stage_changes,
)
from app.tubes.patches import patch_pairs

TIME_FOR_PICTURES = 0.75
"""Share of the deadline after which final pictures are as good as they can be."""

STOPPED = {"Stopped-By": "deadline"}
"""Note of an answer whose layout, or what is proven of it, there was not time enough for."""


def share_spent(spent: Spent, share: float) -> float:
    """How much of a ``share`` of the time is over, where so much of the whole is ``spent``."""
    return spent() / share if share > 0.0 else math.inf


def answer(
    data: bytes,
    options: Options,
    settings: Settings,
    known: frozenset[str] = frozenset(),
    progress: Progress = silent,
    preview: Preview | None = None,
    layout: bytes | None = None,
    shared: SharedLayout | None = None,
    spent: Spent = nothing_spent,
) -> Answer | Unchanged | Revised:
    """Whatever ``options`` ask of the document ``data``.

    ``known`` are validators of answers that the asker has. The ``layout`` of a stored program is
    what `app.layout_record` wrote; it is shown, rather than a new one. A posted document's layout
    may be ``shared`` with other answers. By the share of the time for the work that is ``spent`` a
    layout ends with the best so far. Raises what `app.errors` lists.
    """
    match options:
        case RenderOptions():
            return render(data, options, settings, known, progress, preview, layout, shared, spent)
        case LayoutOptions():
            return layout_of(data, options, settings, known, progress, layout, shared, spent)
        case ConvertOptions():
            return convert(data, options, settings, known, progress)
        case JoinOptions(film=wanted):
            body = joined(data, wanted, progress)
            return Answer(body, wanted.format.media_type, None)
        case ReviseOptions():
            with collection_paused():
                until = partial(share_spent, spent, settings.layout_share)
                return revise(data, layout, options.change, settings, progress, until)


def render(
    data: bytes,
    options: RenderOptions,
    settings: Settings,
    known: frozenset[str] = frozenset(),
    progress: Progress = silent,
    preview: Preview | None = None,
    layout: bytes | None = None,
    shared: SharedLayout | None = None,
    spent: Spent = nothing_spent,
) -> Answer | Unchanged:
    """The scene of the document, in ``options.format``.

    Where someone wants to see a final picture come, ``preview`` is shown it again and again.
    """
    began = time.monotonic()
    refuse_too_large(options, settings)
    with collection_paused():
        progress("reading", 0.0)
        recent = recent_layouts.get(data, layout)
        program = (
            recent.program
            if recent
            else registry.read(options.source, data, settings, options.wishes)
        )
        etag = validator(_form(program, data, layout), replace(options, stretch=None), layout)
        if is_known(etag, known):
            return Unchanged(etag)
        laid = recent or (None if layout is None else read_layout(program, layout))
        is_stored = laid is not None and not options.sweep
        laying: Spent = partial(share_spent, spent, settings.layout_share)
        if options.stretch is not None:  # others draw theirs of the same layout, which is whole
            laying = nothing_spent
        if laid is None and not options.sweep:
            laid = (shared or SharedLayout()).of(program, progress, laying)
        seconds = TIME_FOR_PICTURES * settings.deadline_seconds
        seconds = min(options.effort.time_limit or seconds, seconds)
        share = 1.0 if options.stretch is None else options.stretch.share
        deadline = began + share * seconds
        artist = Artist(options, deadline, progress, preview, laid, laying)
        body = _body(program, options, settings, artist, progress)
        progress("done", 1.0)
        # What is stored stays as it is, be it the best that there was time for.
        stopped = not artist.complete
        return Answer(
            body,
            options.format.media_type,
            None if artist.ran_out_of_time or (stopped and not is_stored) else etag,
            program.name,
            artist.notes | (STOPPED if stopped else {}),
        )


def _body(
    program: Program,
    options: RenderOptions,
    settings: Settings,
    artist: Artist,
    progress: Progress,
) -> bytes:
    if options.sweep:
        return encode_png(variations(program, artist, settings))
    if options.sheet:
        return encode_png(contact_sheet(program, artist))
    if options.format.is_animated:
        return film(program, artist)
    if options.format is SceneFormat.PNG:
        return _picture(program, artist)
    if options.delta is not None:
        aspect = options.width / options.height
        laid = artist.layout or lay_out(program, progress=progress)
        return _write_scene(stage_changes(laid, options.delta, aspect, options.height), options)
    sweeping = _sweeping(program, options, settings, progress)
    height = None if options.format.is_printed else options.height
    staged = stage(
        program, options.width / options.height, progress, sweeping, height, artist.layout
    )
    if options.format.is_printed:
        refuse_too_many(triangles_of(staged.scene, options.parts), settings.max_print_triangles)
    progress("writing", 0.6)
    return _write(staged, options)


def _picture(program: Program, artist: Artist) -> bytes:
    options, view = artist.options, program.view
    width, height = size_of_one_eye(view, options.width, options.height)
    scene = make_scene(
        program, width / height, artist.progress, height=height, layout=artist.layout
    )
    artist.count = 1 if view.stereo is None else 2
    if options.quality == "draft" and view.stereo is None:
        artist.progress("drawing", BEGUN)
        return draw_draft(scene, width, height)
    return encode_png(artist.picture(scene, view, options.width, options.height))


def _sweeping(
    program: Program, options: RenderOptions, settings: Settings, progress: Progress
) -> Sweeping:
    """How tubes are made for a format that holds them as triangles."""
    if options.format.is_printed and options.parts != "items":
        return bodies_for_print(settings.max_print_triangles, progress)
    return make_crowd if _is_crowd(program, options) else make_tubes


def _write(staged: Staged, options: RenderOptions) -> bytes:
    if options.format is not SceneFormat.SVG:
        return _write_scene(staged.scene, options)
    laid = staged.layout
    return write_svg(
        laid.program, laid.placement, laid.routing, staged.scene, options.width, options.height
    )


def _write_scene(scene: Scene, options: RenderOptions) -> bytes:
    packing = Packing(options.compress, options.merge)
    animation = None if options.motion is None else Animation(options.motion, options.seconds)
    match options.format:
        case SceneFormat.GLB:
            return write_glb(scene, packing, animation)
        case SceneFormat.GLTF:
            return write_gltf(scene, packing, animation)
        case SceneFormat.STL:
            return write_stl(scene, options.parts, options.scale)
        case SceneFormat.THREE_MF:
            return write_3mf(scene, options.parts, options.scale)
        case other:
            raise ValueError(f"{other} is a picture.")


def layout_of(
    data: bytes,
    options: LayoutOptions,
    settings: Settings,
    known: frozenset[str] = frozenset(),
    progress: Progress = silent,
    layout: bytes | None = None,
    shared: SharedLayout | None = None,
    spent: Spent = nothing_spent,
) -> Answer | Unchanged:
    """The numbers of the document's layout, as JSON."""
    progress("reading", 0.0)
    program = registry.read(options.source, data, settings, options.wishes)
    etag = validator(_form(program, data, layout), options, layout)
    if is_known(etag, known):
        return Unchanged(etag)
    laid = None if layout is None else read_layout(program, layout)
    is_stored = laid is not None
    laying = partial(share_spent, spent, settings.layout_share)
    laid = laid or (shared or SharedLayout()).of(program, progress, laying)
    progress("proving clearance", 0.5)
    verdict = judge(laid, partial(share_spent, spent, settings.certificate_share))
    progress("writing", 0.6)
    patches = patch_pairs(laid.routing, program.layout.patch_rule) if options.patches else None
    overlaps = find_overlaps(laid.placement)
    body = layout_numbers(
        program, laid.placement, laid.routing, patches, verdict, overlaps, laid.hues, laid.complete
    )
    progress("done", 1.0)
    is_proven = verdict is None or verdict.certificate.complete
    return Answer(
        body,
        "application/json",
        etag if is_proven and (laid.complete or is_stored) else None,
        program.name,
        {} if is_proven and laid.complete else STOPPED,
    )


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
    etag = validator(canonical(program), options)
    if is_known(etag, known):
        return Unchanged(etag)
    progress("writing", 0.6)
    body = registry.write(options.target, program)
    progress("done", 1.0)
    return Answer(body, registry.FORMATS[options.target].media_type, etag, program.name)


def _form(program: Program, data: bytes, layout: bytes | None) -> bytes:
    """The program's canonical form; what is stored with a layout is stored in it."""
    return canonical(program) if layout is None else data


def validator(document: bytes, options: object, layout: bytes | None = None) -> str:
    """A strong validator: digest of the canonical document, of what was asked, and of our version.

    A ``layout`` that is given counts too: the same document may be laid out in another way.
    """
    asked = f"{__version__}\n{options!r}\n".encode()
    return hashlib.sha256(asked + document + (layout or b"")).hexdigest()[:32]


def _is_crowd(program: Program, options: RenderOptions) -> bool:
    """Whether nobody needs a node for each hyperedge."""
    return (
        options.format.is_gltf
        and program.layout.tube == "swept"
        and len(program.hyperedges) > 0
        and Packing(options.compress, options.merge).merges(len(program.hyperedges))
    )
