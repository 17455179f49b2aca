"""Pictures made of many: films, contact sheets of views, sweeps over parameters."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING

from app.answers import RenderOptions
from app.layout import Progress, silent
from app.output.animation import write_mp4, write_webp
from app.output.frames import pack_frames, unpack_frames
from app.output.media import SceneFormat
from app.output.sheet import Sheet
from app.pictures import Artist, size_of_one_eye
from app.program.model import Program
from app.program.sweep import parse_axis, vary
from app.scene.motion import cameras_of
from app.scene.viewpoints import viewpoints
from app.settings import Settings
from app.staging import make_scene

if TYPE_CHECKING:
    from PIL.Image import Image


def film(program: Program, artist: Artist) -> bytes:
    """The scene moving, as the options wish; or, of a stretch of it, the frames."""
    frames = _frames(program, artist)
    options = artist.options
    return _written(frames, options) if options.stretch is None else pack_frames(frames)


def joined(frames: bytes, options: RenderOptions, progress: Progress = silent) -> bytes:
    """The film whose stretches are these, one after the other."""
    return _written(unpack_frames(frames), options, progress)


def _written(frames: Iterable[Image], options: RenderOptions, progress: Progress = silent) -> bytes:
    write = write_mp4 if options.format is SceneFormat.MP4 else write_webp
    return write(frames, options.frames, options.seconds, progress)


def _frames(program: Program, artist: Artist) -> Iterator[Image]:
    options, view = artist.options, program.view
    width, height = size_of_one_eye(view, options.width, options.height)
    scene = make_scene(
        program, width / height, artist.progress, height=height, layout=artist.layout
    )
    cameras = cameras_of(scene, options.motion or "turntable", options.frames)
    if options.stretch is not None:
        cameras = cameras[options.stretch.first : options.stretch.end]
    artist.count = len(cameras) * (1 if view.stereo is None else 2)
    return artist.views(scene, view, cameras, options.width, options.height)


def contact_sheet(program: Program, artist: Artist) -> Image:
    """The scene from several sides, beside each other."""
    options = artist.options
    page = Sheet(options.width, options.height, 2, 3, _background(program))
    width, height = size_of_one_eye(program.view, *page.cell)
    scene = make_scene(
        program, width / height, artist.progress, height=height, layout=artist.layout
    )
    views = viewpoints(scene)
    artist.count = len(views) * (1 if program.view.stereo is None else 2)
    cameras = [camera for _, camera in views]
    pictures = list(artist.views(scene, program.view, cameras, *page.cell))
    return page.of(pictures, [name for name, _ in views])


def variations(program: Program, artist: Artist, settings: Settings) -> Image:
    """Variations of the program over one or two of its parameters, beside each other."""
    options = artist.options
    axes = [parse_axis(text) for text in options.sweep]
    rows = vary(program, axes, settings)
    page = Sheet(
        options.width,
        options.height,
        len(rows),
        len(rows[0]),
        _background(program),
        names_rows=len(axes) > 1,
    )
    artist.count = len(rows) * len(rows[0])
    pictures = []
    for cell in (cell for row in rows for cell in row):
        width, height = size_of_one_eye(cell.view, *page.cell)
        scene = make_scene(cell, width / height, height=height, layout=artist.laid(cell))
        pictures.append(artist.picture(scene, cell.view, *page.cell))
    captions = axes[0].captions * len(rows)
    return page.of(pictures, captions, axes[1].captions if len(axes) > 1 else ())


def _background(program: Program) -> str:
    given = program.style.background
    return "#ffffff" if given == "transparent" else given
