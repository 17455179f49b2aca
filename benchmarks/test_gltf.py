"""Writing GLB, beside trimesh's exporter on the same meshes in the same run."""

from __future__ import annotations

import struct
from typing import Any

import numpy as np
import pytest

from app.notations.loader import load_notation
from app.output.gltf import write_glb
from app.output.gltf_packing import Packing
from app.placement.placement import Placement
from app.program.model import Attachment, Hyperedge, Item, Program
from app.scene.assemble import assemble
from app.scene.scene import Scene
from app.solids.solid import Box
from app.tubes.tubes import Tubes

RINGS, SIDES, SEGMENTS = 12, 8, 3


def scene_of(segments: int) -> Scene:
    """Hyperedges of three tubes each, 12 rings of 8 vertices a tube, at random places."""
    hyperedges = segments // SEGMENTS
    program = Program(
        items=(Item(id="x"), Item(id="y")),
        hyperedges=tuple(
            Hyperedge(id=f"e{number}", attachments=(Attachment(item="x"), Attachment(item="y")))
            for number in range(hyperedges)
        ),
    )
    box = Box((1.0, 1.0, 1.0), 0.05)
    placement = Placement(
        centers=np.array([[0.0, 0, 0], [2.0, 0, 0]]),
        rotations=np.tile([0.0, 0, 0, 1], (2, 1)),
        sizes=np.ones((2, 3)),
        solids=(box, box),
        labels=(None, None),
        attachment_positions=np.zeros((2 * hyperedges, 3)),
        attachment_directions=np.tile([0.0, 0, 1], (2 * hyperedges, 1)),
        attachment_starts=2 * np.arange(hyperedges + 1),
        attachment_items=np.tile([0, 1], hyperedges),
        radii=np.full(hyperedges, 0.08),
    )
    return assemble(program, load_notation("plain"), placement, straight_tubes(hyperedges), 4 / 3)


def straight_tubes(hyperedges: int) -> Tubes:
    """Cylinders along x, each at its own place and turned by its own angle."""
    count = hyperedges * SEGMENTS
    chance = np.random.default_rng(1)
    turn = np.arange(SIDES) * (2 * np.pi / SIDES) + chance.uniform(0, 1, (count, 1, 1))
    circle = np.stack([np.zeros_like(turn), np.cos(turn), np.sin(turn)], axis=-1)
    normals = np.broadcast_to(circle, (count, RINGS, SIDES, 3)).astype(np.float32)
    along = np.linspace(0, 3, RINGS)[:, None, None] * [1.0, 0, 0]
    vertices = 0.08 * normals + along + chance.uniform(0, 100, (count, 1, 1, 3))
    ring, side = np.meshgrid(np.arange(RINGS - 1), np.arange(SIDES), indexing="ij")
    low, next_low = ring * SIDES + side, ring * SIDES + (side + 1) % SIDES
    quads = np.stack([low, next_low, low + SIDES, low + SIDES, next_low, next_low + SIDES], axis=-1)
    tube = quads.reshape(-1, 3)
    one = np.concatenate([tube + number * RINGS * SIDES for number in range(SEGMENTS)])
    return Tubes(
        vertices=vertices.reshape(-1, 3).astype(np.float32),
        normals=normals.reshape(-1, 3),
        faces=np.tile(one.astype(np.uint32), (hyperedges, 1)),
        vertex_starts=np.arange(hyperedges + 1) * SEGMENTS * RINGS * SIDES,
        face_starts=np.arange(hyperedges + 1) * len(one),
    )


def trimesh_scene(scene: Scene) -> Any:
    """The same nodes with the same meshes, names and extras for trimesh."""
    import trimesh

    found = trimesh.Scene()
    for node in scene.nodes:
        place = np.eye(4)
        place[:3, 3] = node.translation
        for primitive in node.primitives:
            mesh = trimesh.Trimesh(
                primitive.mesh.vertices,
                primitive.mesh.faces,
                vertex_normals=primitive.mesh.normals,
                process=False,
            )
            found.add_geometry(
                mesh, node_name=node.name, transform=place, metadata=dict(node.extras)
            )
    return found


SIZES = [(999, 5), (99_999, 2)]


@pytest.fixture(scope="module", params=SIZES, ids=lambda param: f"{param[0]} segments")
def scene_and_rounds(request: pytest.FixtureRequest) -> tuple[Scene, int]:
    """A scene of so many segments, and how often to write it."""
    segments, rounds = request.param
    return scene_of(segments), rounds


def test_glb_tubeloom(benchmark: Any, scene_and_rounds: tuple[Scene, int]) -> None:
    """Ours."""
    scene, rounds = scene_and_rounds
    benchmark.group = f"GLB of {3 * len(scene.nodes) - 9:,} segments"
    data = benchmark.pedantic(
        write_glb, (scene, Packing(merge=False)), rounds=rounds, warmup_rounds=1
    )
    assert struct.unpack("<I", data[8:12])[0] == len(data)


def test_glb_trimesh(benchmark: Any, scene_and_rounds: tuple[Scene, int]) -> None:
    """The exporter that Python users would pick."""
    scene, rounds = scene_and_rounds
    benchmark.group = f"GLB of {3 * len(scene.nodes) - 9:,} segments"
    theirs = trimesh_scene(scene)
    data = benchmark.pedantic(
        theirs.export,
        kwargs={"file_type": "glb", "include_normals": True},
        rounds=(rounds + 1) // 2,
    )
    assert data[:4] == b"glTF"
