"""glTF that moves, judged by Khronos' validator and by three.js."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from app.output.gltf import write_glb, write_gltf
from app.output.gltf_motion import Animation
from app.output.gltf_packing import Packing
from app.output.media import Motion
from app.scene.motion import axis_of, cameras_of
from app.scene.scene import Scene
from tests.output.gltf_reader import Asset
from tests.output.node_tools import run_module, validate
from tests.scene.hand_built import node_named, program_of, scene_of, three_items

MOTIONS: tuple[Motion, ...] = ("turntable", "flight")
PACKINGS = (Packing(), Packing("quantize", None), Packing("meshopt", True))

PLAY = """
import { readFile } from 'node:fs/promises';
import { AnimationMixer, Vector3 } from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
globalThis.ProgressEvent ??= class extends Event {};
const found = [];
for (const path of process.argv.slice(2)) {
  const data = await readFile(path);
  const gltf = await new GLTFLoader().parseAsync(data.buffer.slice(
    data.byteOffset, data.byteOffset + data.byteLength), '');
  const mixer = new AnimationMixer(gltf.scene);
  mixer.clipAction(gltf.animations[0]).play();
  const times = [];
  for (const share of [0, 0.125, 0.25, 0.5, 0.8]) {
    mixer.setTime(share * gltf.animations[0].duration);
    gltf.scene.updateMatrixWorld(true);
    const camera = gltf.cameras[0];
    times.push({
      item: gltf.scene.getObjectByName('z').getWorldPosition(new Vector3()).toArray(),
      ground: gltf.scene.getObjectByName('ground').getWorldPosition(new Vector3()).toArray(),
      camera: camera.getWorldPosition(new Vector3()).toArray(),
      toward: camera.getWorldDirection(new Vector3()).toArray(),
    });
  }
  found.push({ duration: gltf.animations[0].duration, times });
}
process.stdout.write(JSON.stringify(found));
"""
SHARES = (0, 0.125, 0.25, 0.5, 0.8)


def played(scene: Scene, motion: Motion, folder: Path) -> list[dict[str, NDArray[np.float64]]]:
    """What three.js shows at each of `SHARES`, with z up again."""
    file = folder / "scene.glb"
    file.write_bytes(write_glb(scene, animation=Animation(motion, 4.0)))
    (found,) = run_module(PLAY, [file])
    assert found["duration"] == pytest.approx(4.0)
    up = np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]])
    return [
        {name: up @ np.array(value) for name, value in shown.items()} for shown in found["times"]
    ]


@pytest.mark.parametrize("projection", ["perspective", "orthographic"])
def test_the_validator_finds_nothing(projection: str, tmp_path: Path) -> None:
    view = {"projection": projection}
    scenes = [
        scene_of(three_items(view=view)),
        scene_of(three_items(view={**view, "from": [0, 0, 1]}, style={"ground": False})),
        scene_of(program_of(items=[], view=view)),
    ]
    files = []
    for number, scene in enumerate(scenes):
        for motion in MOTIONS:
            for way, packing in enumerate(PACKINGS):
                files.append(tmp_path / f"{number}-{motion}-{way}.glb")
                files[-1].write_bytes(write_glb(scene, packing, Animation(motion, 3.0)))
            files.append(tmp_path / f"{number}-{motion}.gltf")
            files[-1].write_bytes(write_gltf(scene, animation=Animation(motion, 3.0)))
    for file, report in zip(files, validate(files), strict=True):
        ignored = {"NODE_EMPTY", "UNSUPPORTED_EXTENSION"}
        messages = [one for one in report["issues"]["messages"] if one["code"] not in ignored]
        assert messages == [], file.name
        empty = file.name.startswith("2-turntable")
        assert report["info"]["animationCount"] == (0 if empty else 1)


def test_on_a_turntable_items_go_round_and_the_rest_stays(tmp_path: Path) -> None:
    scene = scene_of(three_items())
    axis = axis_of(scene)
    start = np.array(node_named(scene, "z").translation) - axis
    times = played(scene, "turntable", tmp_path)
    for share, shown in zip(SHARES, times, strict=True):
        angle = -2 * np.pi * share
        turned = [
            start[0] * np.cos(angle) - start[1] * np.sin(angle),
            start[0] * np.sin(angle) + start[1] * np.cos(angle),
            start[2],
        ]
        assert shown["item"] - axis == pytest.approx(turned, abs=1e-5)
        for name in ("camera", "toward", "ground"):
            assert shown[name] == pytest.approx(times[0][name])
    (first,) = cameras_of(scene, "turntable", 1)
    assert times[0]["camera"] == pytest.approx(first.position, abs=1e-5)


def test_in_flight_the_camera_is_where_the_films_is(tmp_path: Path) -> None:
    scene = scene_of(three_items())
    cameras = cameras_of(scene, "flight", 720)
    times = played(scene, "flight", tmp_path)
    away = np.linalg.norm(np.subtract(scene.camera.position, scene.camera.target))
    for share, shown in zip(SHARES, times, strict=True):
        camera = cameras[round(share * 720)]
        assert np.linalg.norm(shown["camera"] - camera.position) < 0.01 * away
        toward = np.subtract(camera.target, camera.position)
        assert shown["toward"] @ toward / np.linalg.norm(toward) > 0.9999
        assert shown["item"] == pytest.approx(times[0]["item"])


@pytest.mark.parametrize("motion", MOTIONS)
def test_an_animation_ends_as_it_begins(motion: Motion) -> None:
    glb = write_glb(scene_of(three_items()), animation=Animation(motion, 2.5))
    asset = Asset.from_glb(glb)
    (animation,) = asset.json["animations"]
    for sampler in animation["samplers"]:
        times, values = (asset.values(sampler[key]) for key in ("input", "output"))
        assert times[0] == 0
        assert times[-1] == pytest.approx(2.5)
        first, last = values[0], values[-1]
        same = first if np.dot(first, last) > 0 else -first
        assert last == pytest.approx(same, abs=1e-6)
        if values.shape[1] == 4:
            steps = (values[1:] * values[:-1]).sum(axis=1)
            assert steps.min() > 0.7, "no step goes the long way round"


def test_without_an_animation_nothing_is_different() -> None:
    scene = scene_of(three_items())
    assert write_glb(scene) == write_glb(scene, animation=None)
    document: dict[str, Any] = json.loads(write_gltf(scene))
    assert "animations" not in document
