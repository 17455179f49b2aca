"""Options of the command line that tell how a scene is shown, in groups."""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any, get_args

import click

from app.output.effort import Effort
from app.output.media import Compression, Motion, Parts, Quality
from app.program.model import Bundles, PlacementMode, Routing

Command = Callable[..., None]
Decorator = Callable[[Command], Command]


def _group(*options: Decorator) -> Decorator:
    return lambda command: functools.reduce(
        lambda decorated, option: option(decorated), reversed(options), command
    )


def _with_layout_wishes(command: Command) -> Command:
    """Hands over what is asked of the layout in one piece."""

    @functools.wraps(command)
    def run(
        *,
        routing: str | None,
        placement: str | None,
        bundles: str | None,
        clearance: float | None,
        **others: Any,
    ) -> None:
        asked = (
            ("routing", routing),
            ("placement", placement),
            ("bundles", bundles),
            ("clearance", clearance),
        )
        command(layout=tuple(each for each in asked if each[1] is not None), **others)

    return run


def _with_effort(command: Command) -> Command:
    """Hands over what a final picture may cost in one piece."""

    @functools.wraps(command)
    def run(
        *,
        samples: int | None,
        time_limit: float | None,
        noise: float | None,
        denoise: bool,
        seed: int,
        **others: Any,
    ) -> None:
        command(effort=Effort(samples, time_limit, noise, denoise, seed), **others)

    return run


_SECONDS = click.FloatRange(0.05, 3600)

of_pictures = _group(
    click.option(
        "--quality",
        type=click.Choice(get_args(Quality)),
        default="draft",
        show_default=True,
        help="Of pictures: drawn at once, or path traced in seconds.",
    ),
    click.option(
        "--samples", type=click.IntRange(1, 65536), help="Of a final picture, for each pixel."
    ),
    click.option("--time-limit", type=_SECONDS, help="Of final pictures, in seconds."),
    click.option(
        "--noise",
        type=click.FloatRange(0, 1, min_open=True),
        help="Of a final picture: the standard error that is good enough, white being 1.",
    ),
    click.option(
        "--denoise/--no-denoise", default=True, help="Of a final picture: smooth its noise."
    ),
    click.option("--seed", type=click.IntRange(0, 2**31 - 1), default=0, help="Of that noise."),
    click.option("--sheet", is_flag=True, help="As PNG: the scene from several sides."),
    click.option(
        "--sweep",
        multiple=True,
        metavar="POINTER=VALUES",
        help="As PNG: variations beside each other, such as /style/halo=0,0.3; once or twice.",
    ),
    _with_effort,
)

of_layout = _group(
    click.option(
        "--bundles",
        type=click.Choice(get_args(Bundles)),
        help="Whether the bits of a bus are one tube, whatever FILE says.",
    ),
    click.option(
        "--routing",
        type=click.Choice(get_args(Routing)),
        help="How hyperedges keep clear of each other, whatever FILE says.",
    ),
    click.option(
        "--placement",
        type=click.Choice(get_args(PlacementMode)),
        help="Where items without positions go, whatever FILE says.",
    ),
    click.option(
        "--clearance",
        type=click.FloatRange(0, 1e5),
        help="Wanted between tubes and from items, whatever FILE says.",
    ),
    _with_layout_wishes,
)

of_motion = _group(
    click.option(
        "--motion",
        type=click.Choice(get_args(Motion)),
        help="How WebP and MP4 move (left out: turntable), and glTF, if it does.",
    ),
    click.option(
        "--frames",
        type=click.IntRange(2, 1000),
        default=36,
        show_default=True,
        help="Of WebP and MP4.",
    ),
    click.option(
        "--duration",
        "seconds",
        type=_SECONDS,
        default=3.0,
        show_default=True,
        help="Of what moves, in seconds.",
    ),
)

of_gltf = _group(
    click.option(
        "--compress",
        type=click.Choice(get_args(Compression)),
        default="none",
        show_default=True,
        help="Of glTF: by whole numbers, or by those and meshoptimizer's codecs.",
    ),
    click.option(
        "--merge/--no-merge",
        default=None,
        help="Of glTF: draw many hyperedges at once; left out, above 1,000 of them.",
    ),
)

of_prints = _group(
    click.option(
        "--scale",
        type=click.FloatRange(0.001, 1000),
        default=10.0,
        show_default=True,
        help="Of a print: millimetres to a unit.",
    ),
    click.option(
        "--parts",
        type=click.Choice(get_args(Parts)),
        default="all",
        show_default=True,
        help="Of a print: what of the scene it holds.",
    ),
)
