"""From scenes to pixels: by the renderer asked for, from one camera or many, for one eye or two."""

from __future__ import annotations

import itertools
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from app.answers import RenderOptions
from app.hyperedges.stopping import Spent, nothing_spent
from app.layout import Layout, Preview, Progress, lay_out
from app.output.draft import draw_views
from app.output.png import encode_png
from app.output.stereo import anaglyph, side_by_side
from app.program.model import Program, View
from app.scene.eyes import eyes
from app.scene.scene import Camera, Scene

if TYPE_CHECKING:
    from PIL.Image import Image

    from app.output.final import Final

BEGUN = 0.6
"""Share of the whole work that is done when drawing begins."""


def size_of_one_eye(view: View, width: int, height: int) -> tuple[int, int]:
    """What one camera draws of a picture of ``width`` by ``height`` pixels.

    >>> size_of_one_eye(View(stereo="side-by-side"), 1024, 768)
    (512, 768)
    """
    return (max(width // 2, 1) if view.stereo == "side-by-side" else width), height


@dataclass(slots=True)
class Artist:
    """Draws what ``options`` ask for, in time, and notes what the pictures cost.

    ``layout`` is the program's, where it is known. ``count`` is how many pictures there will be,
    each eye's counted; when the clock (`time.monotonic`) shows ``deadline`` all final ones should
    be there, in as good a quality as there was time for.
    Layouts that are made for pictures end when the time for them is ``spent``.
    """

    options: RenderOptions
    deadline: float
    progress: Progress
    preview: Preview | None = None
    layout: Layout | None = None
    spent: Spent = nothing_spent
    count: int = 1
    _finals: list[Final] = field(default_factory=list)
    _drawn: int = 0
    complete: bool = True
    """Whether there was time enough for all layouts."""

    def __post_init__(self) -> None:
        if self.layout is not None:
            self.complete = self.layout.complete

    def laid(self, program: Program) -> Layout:
        """The layout of a variation of the program."""
        found = lay_out(program, spent=self.spent)
        self.complete &= found.complete
        return found

    def picture(self, scene: Scene, view: View, width: int, height: int) -> Image:
        """The scene from its own camera, for both eyes where the view wishes for that."""
        return next(self.views(scene, view, [scene.camera], width, height))

    def views(
        self, scene: Scene, view: View, cameras: Sequence[Camera], width: int, height: int
    ) -> Iterator[Image]:
        """The scene from each of ``cameras``, in turn."""
        if view.stereo is None:
            yield from self._draw(scene, cameras, width, height)
            return
        pairs = [eyes(camera, scene.bounds, view.eye_distance) for camera in cameras]
        size = size_of_one_eye(view, width, height)
        drawn = self._draw(scene, list(itertools.chain(*pairs)), *size)
        join = side_by_side if view.stereo == "side-by-side" else anaglyph
        for left, right in zip(drawn, drawn, strict=True):
            yield join(left, right)

    @property
    def notes(self) -> dict[str, str]:
        """How final pictures came about: samples, remaining noise, and why they were enough."""
        if not self._finals:
            return {}
        stopped = {final.stopped_by for final in self._finals}
        return {
            "Samples": str(min(final.samples for final in self._finals)),
            "Noise": f"{max(final.noise for final in self._finals):.4f}",
            "Stopped-By": "time limit" if "time limit" in stopped else self._finals[0].stopped_by,
        }

    @property
    def ran_out_of_time(self) -> bool:
        """Whether another attempt might look better."""
        return any(final.stopped_by == "time limit" for final in self._finals)

    def _draw(
        self, scene: Scene, cameras: Sequence[Camera], width: int, height: int
    ) -> Iterator[Image]:
        if self.options.quality == "draft":
            for picture in draw_views(scene, cameras, width, height):
                self._drawn += 1
                self._tell(0.0)
                yield picture
            return
        from app.output.final import draw_final

        for camera in cameras:
            final = draw_final(
                replace(scene, camera=camera),
                width,
                height,
                self.options.effort,
                lambda _stage, share: self._tell(share),
                self._show if self.preview is not None and self.count == 1 else None,
                self._seconds_for_one(),
            )
            self._finals.append(final)
            self._drawn += 1
            self._tell(0.0)
            yield final.picture

    def _seconds_for_one(self) -> float:
        left = max(self.count - self._drawn, 1)
        return max(self.deadline - time.monotonic(), 0.0) / left

    def _tell(self, share: float) -> None:
        """The share is of the picture that is being drawn."""
        done = min((self._drawn + share) / self.count, 1.0)
        self.progress("drawing", BEGUN + (0.98 - BEGUN) * done)

    def _show(self, picture: Image) -> None:
        if self.preview is not None:
            self.preview(encode_png(picture))
