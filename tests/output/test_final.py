"""Path traced pictures, by Mitsuba itself."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from app.arrays import Floats
from app.output.draft import draw
from app.output.effort import Effort
from app.output.final import draw_final
from app.output.final_passes import passes_of
from app.output.final_variant import final_problem, llvm_libraries, llvm_version
from app.program.reading import read_program
from app.scene.scene import Scene
from app.settings import Settings
from app.staging import make_scene

EXAMPLES = Path(__file__).parents[2] / "examples"
SIZE = 96, 72
RED: dict[str, Any] = {
    "items": [{"id": "a", "shape": {"type": "sphere"}, "color": "#d02020", "position": [0, 0, 0.5]}]
}


def scene_of(document: dict[str, Any]) -> Scene:
    program = read_program(json.dumps(document).encode(), Settings())
    return make_scene(program, SIZE[0] / SIZE[1], height=SIZE[1])


def silent(_stage: str, _share: float) -> None:
    """Nobody watches."""


def pixels(scene: Scene, effort: Effort) -> Floats:
    final = draw_final(scene, *SIZE, effort, silent)
    return np.asarray(final.picture.convert("RGB"), dtype=np.float64)


def test_mitsuba_is_there() -> None:
    assert final_problem() is None


def test_old_llvm_is_never_tried() -> None:
    assert all(llvm_version(path) >= 17 for path in llvm_libraries())


def test_the_same_seed_gives_the_same_picture_and_another_does_not() -> None:
    scene = scene_of(RED)
    one, again, other = (pixels(scene, Effort(samples=4, seed=seed)) for seed in (1, 1, 2))
    assert (one == again).all()
    assert (one != other).any()


@pytest.mark.parametrize("projection", ["perspective", "orthographic"])
def test_it_shows_what_the_draft_shows_at_the_same_place(projection: str) -> None:
    scene = scene_of({**RED, "view": {"projection": projection}, "style": {"ground": False}})
    found = pixels(scene, Effort(samples=16))
    expected = np.asarray(draw(scene, *SIZE, 4).convert("RGB"), dtype=np.float64)
    both = [picture[..., 0] - picture[..., 1] > 60 for picture in (found, expected)]
    assert both[1].sum() > 300
    assert (both[0] ^ both[1]).sum() < 0.06 * both[1].sum()


def test_the_ground_melts_into_the_background() -> None:
    for background, level in (("#ffffff", 255), ("#808080", 128)):
        found = pixels(scene_of({**RED, "style": {"background": background}}), Effort(samples=16))
        assert np.abs(found[:3].mean() - level) < 4
        assert found.min() < level - 20


def test_colours_stay_what_they_are() -> None:
    found = pixels(scene_of(RED), Effort(samples=16))
    red, green, blue = found[SIZE[1] // 2, SIZE[0] // 2]
    assert red > 120
    assert green < 0.5 * red
    assert blue < 0.5 * red


def test_noise_falls_with_samples_and_ends_the_work_where_it_may() -> None:
    scene = scene_of(RED)
    few = draw_final(scene, *SIZE, Effort(samples=8, denoise=False), silent)
    many = draw_final(scene, *SIZE, Effort(samples=32, denoise=False), silent)
    assert many.noise < few.noise
    good = draw_final(scene, *SIZE, Effort(samples=4096, noise=few.noise), silent)
    assert good.stopped_by == "noise"
    assert good.samples < 64


def test_previews_come_and_progress_rises() -> None:
    shares: list[float] = []
    shown: list[Image.Image] = []
    final = draw_final(
        scene_of(RED),
        *SIZE,
        Effort(samples=32),
        lambda _, share: shares.append(share),
        shown.append,
    )
    assert shares == sorted(shares)
    assert len(shown) >= 2
    assert all(picture.size == SIZE for picture in shown)
    assert final.samples == 32


def test_who_ends_the_work_can_begin_anew() -> None:
    class EnoughError(Exception):
        pass

    def stop(_stage: str, share: float) -> None:
        if share > 0:
            raise EnoughError

    scene = scene_of(RED)
    with pytest.raises(EnoughError):
        draw_final(scene, *SIZE, Effort(samples=16), stop)
    assert draw_final(scene, *SIZE, Effort(samples=1), silent).samples == 1


def test_eyes_that_look_past_see_the_picture_moved() -> None:
    scene = scene_of({**RED, "style": {"ground": False}})
    moved = replace(scene, camera=replace(scene.camera, shift=(0.25, 0.0)))
    columns = [
        np.argwhere(pixels(seen, Effort(samples=4))[..., 1] < 200)[:, 1].mean()
        for seen in (scene, moved)
    ]
    assert columns[0] - columns[1] == pytest.approx(0.25 * SIZE[0] / 2, abs=1.5)
    drafts = [
        np.argwhere(np.asarray(draw(seen, *SIZE, 4).convert("RGB"))[..., 1] < 200)[:, 1]
        for seen in (scene, moved)
    ]
    assert columns == pytest.approx([found.mean() for found in drafts], abs=1.5)


def test_passes_take_all_samples() -> None:
    for samples in (1, 2, 5, 16, 100):
        assert sum(passes_of(samples, 640 * 480)) == samples


def test_every_material_is_drawn() -> None:
    materials = ("plastic", "metal", "glass", "wood", "stone", "matte", "plain")
    document = {
        "items": [
            {"id": name, "material": name, "translucency": 0.3 if name == "matte" else None}
            for name in materials
        ],
        "hyperedges": [
            {
                "id": f"e{name}",
                "material": name,
                "attachments": [{"item": name}, {"item": "plastic"}],
            }
            for name in materials[1:]
        ],
    }
    found = pixels(scene_of(document), Effort(samples=2))
    assert np.isfinite(found).all()
    assert np.ptp(found) > 150
