"""The command line: serve, or do without a service what it does."""

from __future__ import annotations

import gc
import math
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO

import click

from app import __version__
from app.answers import (
    Answer,
    ConvertOptions,
    LayoutOptions,
    LayoutWishes,
    Options,
    RenderOptions,
)
from app.cli_keys import keys
from app.cli_options import of_gltf, of_layout, of_motion, of_pictures, of_prints
from app.errors import DocumentError, TubeloomError
from app.formats.registry import FORMATS
from app.output.media import SceneFormat
from app.program.collection import collection_paused
from app.settings import Settings

if TYPE_CHECKING:
    from app.jobs.launch import Launched
    from app.layout import Progress
    from app.output.effort import Effort

READABLE = click.Choice(list(FORMATS))
WRITABLE = click.Choice([name for name, found in FORMATS.items() if found.writes])
SCENE = click.Choice([scene.value for scene in SceneFormat])

document = click.argument("document", type=click.File("rb"), metavar="FILE")
source = click.option(
    "--from", "source", type=READABLE, default="tubeloom", show_default=True, help="Format of FILE."
)
to_file = click.option(
    *("-o", "--output"),
    type=click.Path(dir_okay=False, allow_dash=True, path_type=Path),
    default="-",
    help="File to write; left out, standard output.",
)


@click.group()
@click.version_option(__version__, prog_name="tubeloom")
def main() -> None:
    """Lay out hyperedges as smooth tubes in three dimensions.

    FILE is a program as JSON; a dash reads it from standard input.
    """


main.add_command(keys)


@main.command()
@click.option("--host", help="Address to listen on.")
@click.option("--port", type=click.IntRange(0, 65535), help="Port to listen on; 0 takes any.")
@click.option("--workers", type=click.IntRange(1, 256), help="Processes that do the work.")
def serve(host: str | None, port: int | None, workers: int | None) -> None:
    """Serve over HTTP. What is left out comes from TUBELOOM_… in the environment."""
    from app.jobs.launch import launched

    given = {"host": host, "port": port, "workers": workers}
    settings = Settings.model_validate(
        Settings().model_dump()
        | {name: value for name, value in given.items() if value is not None}
    )
    # They import what they need while this process does the same.
    with launched(settings.workers) as processes:
        _serve(settings, processes)


def _serve(settings: Settings, processes: list[Launched]) -> None:
    # What imports leave lives on: to look through it for garbage, now or later, takes its time.
    with collection_paused():
        import socket

        import uvicorn

        from app.api.allocation import return_large_blocks
        from app.api.connections import connections
        from app.api.journal import configure_logging
        from app.main import create_app

        configure_logging(settings.log_format)
        return_large_blocks()
        app = create_app(settings, processes)
    gc.freeze()

    class Server(uvicorn.Server):
        async def shutdown(self, sockets: list[socket.socket] | None = None) -> None:
            for stop in app.state.before_shutdown:
                stop()
            await super().shutdown(sockets)

    config = uvicorn.Config(
        app,
        host=settings.host,
        port=settings.port,
        log_config=None,
        access_log=False,
        server_header=False,
        http=connections(settings),
        ws="none",
        proxy_headers=bool(settings.trusted_proxies),
        forwarded_allow_ips=list(settings.trusted_proxies),
    )
    Server(config).run()


@main.command()
@document
@to_file
@source
@click.option("--format", "format_", type=SCENE, help="Left out, the ending of the output tells.")
@click.option("--width", type=click.IntRange(1, 8192), default=1024, show_default=True)
@click.option("--height", type=click.IntRange(1, 8192), default=768, show_default=True)
@of_layout
@of_pictures
@of_motion
@of_gltf
@of_prints
def render(
    *,
    document: BinaryIO,
    output: Path,
    source: str,
    format_: str | None,
    effort: Effort,
    layout: LayoutWishes,
    **wishes: Any,
) -> None:
    """Show FILE as a glTF scene, a picture or a film, or make a print of it."""
    ending = format_ or output.suffix.removeprefix(".").lower()
    if ending not in SCENE.choices:
        raise click.UsageError(
            f"Say the format by --format, or by an output that ends in one of "
            f"{', '.join(f'.{choice}' for choice in SCENE.choices)}."
        )
    options = RenderOptions(
        SceneFormat(ending), source=source, effort=effort, wishes=layout, **wishes
    )
    if (options.sheet or options.sweep) and options.format is not SceneFormat.PNG:
        raise click.UsageError("Sheets and sweeps are pictures: png.")
    answer = _answer(document, options)
    _write(output, answer)
    if answer.notes:
        said = ", ".join(f"{name.lower()}: {note}" for name, note in answer.notes.items())
        click.echo(said, err=True)


@main.command()
@document
@to_file
@source
@of_layout
@click.option("--patches", is_flag=True, help="Add the paper's patch pairs.")
def layout(
    *, document: BinaryIO, output: Path, source: str, patches: bool, layout: LayoutWishes
) -> None:
    """Write where FILE's items stand and how its hyperedges run, as JSON."""
    _write(output, _answer(document, LayoutOptions(patches, source, layout)))


@main.command()
@document
@to_file
@source
@click.option("--to", "target", type=WRITABLE, default="tubeloom", show_default=True)
def convert(document: BinaryIO, output: Path, source: str, target: str) -> None:
    """Write FILE in another format."""
    _write(output, _answer(document, ConvertOptions(source, target)))


@main.command()
def openapi() -> None:
    """Write the description of the HTTP interface."""
    from app.api.schema import openapi_text
    from app.main import create_app

    click.echo(openapi_text(create_app(Settings())), nl=False)


def _answer(document: BinaryIO, options: Options) -> Answer:
    """The pipeline's answer, in this process. What is wrong is said and ends the program."""
    from app import pipeline

    try:
        with _progress_bar() as progress:
            # Who sits before it is the deadline.
            patient = {"deadline_seconds": math.inf, "layout_share": 1.0, "certificate_share": 1.0}
            settings = Settings().model_copy(update=patient)
            answer = pipeline.answer(document.read(), options, settings, progress=progress)
    except DocumentError as error:
        for fault in error.faults:
            click.echo(f"{document.name}: {fault.pointer or '/'}: {fault.detail}", err=True)
        sys.exit(1)
    except TubeloomError as error:
        raise click.ClickException(str(error)) from error
    assert isinstance(answer, Answer), "nothing is known, so nothing is unchanged"  # noqa: S101
    return answer


def _write(output: Path, answer: Answer) -> None:
    try:
        with click.open_file(str(output), "wb") as file:
            file.write(answer.body)
    except OSError as error:
        raise click.FileError(str(output), error.strerror or str(error)) from error


@contextmanager
def _progress_bar() -> Iterator[Progress]:
    """A bar on standard error, for people only, and only once a second has passed."""
    from tqdm import tqdm

    with tqdm(
        total=1.0,
        delay=1.0,
        disable=None,
        leave=False,
        bar_format="{desc:<24}{bar}{percentage:3.0f}%",
    ) as bar:

        def show(stage: str, share: float) -> None:
            bar.set_description_str(stage, refresh=False)
            bar.update(share - bar.n)

        yield show
