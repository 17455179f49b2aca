"""Scenes of real tubes, to pack."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from app.arrays import Floats
from app.program.model import Program
from app.scene.scene import Node, Scene
from app.staging import make_scene
from tests.output.gltf_reader import Asset

RADIUS = 0.08


def program_in_a_grid(hyperedges: int, items: int = 25, **parts: Any) -> Program:
    """Hyperedges of two to four ends each at random, among items on a grid; some have no kind."""
    chance = np.random.default_rng(hyperedges)
    side = int(np.ceil(np.sqrt(items)))
    places = [[2.0 * (number % side), 2.0 * (number // side), 0.5] for number in range(items)]
    materials = ["plastic", "metal", None]
    return Program.model_validate(
        {
            "items": [
                {"id": f"i{number}", "label": "A", "position": place}
                for number, place in enumerate(places)
            ],
            "hyperedges": [
                {
                    "id": f"e{number}",
                    "radius": RADIUS * (1 + number % 2),
                    "material": materials[number % 3],
                    "attachments": [
                        {"item": f"i{end}"}
                        for end in chance.choice(items, 2 + number % 3, replace=False)
                    ],
                }
                for number in range(hyperedges)
            ],
            "layout": {"clearance": None, "curves": "prose"},
        }
        | parts
    )


def grid_scene(hyperedges: int = 12, **parts: Any) -> Scene:
    """The scene of `program_in_a_grid`."""
    return make_scene(program_in_a_grid(hyperedges, **parts), aspect=4 / 3)


def hyperedges_of(scene: Scene) -> dict[str, Node]:
    """The nodes of hyperedges, by name."""
    return {node.name: node for node in scene.nodes if node.shows == "hyperedge"}


def in_world(node: Node) -> Floats:
    """The vertices of a node that is not turned, (v, 3)."""
    (part,) = node.primitives
    return part.mesh.vertices.astype(np.float64) + node.translation


def tubes_read_back(asset: Asset) -> dict[str, tuple[Floats, Floats, Floats]]:
    """Corners of all triangles of each hyperedge (f, 3, 3), their normals, and colours (f, 3, 4).

    Corners are in the world, z up, whether the hyperedges were merged or not.
    """
    found: dict[str, tuple[Floats, Floats, Floats]] = {}
    for node in asset.json["nodes"]:
        shows = node.get("extras", {}).get("shows")
        if shows not in {"hyperedge", "hyperedges"}:
            continue
        (primitive,) = asset.json["meshes"][node["mesh"]]["primitives"]
        attributes = primitive["attributes"]
        scale = np.array(node.get("scale", [1, 1, 1])).astype(np.float32)
        positions = asset.numbers(attributes["POSITION"]) * scale + node.get("translation", 0.0)
        normals = asset.numbers(attributes["NORMAL"])
        material = asset.json["materials"][primitive["material"]]
        base = np.array(material["pbrMetallicRoughness"]["baseColorFactor"])
        faces = asset.values(primitive["indices"]).reshape(-1, 3)
        colors = np.tile(base, (len(positions), 1))
        names, members = [node["name"]], np.zeros(len(positions), dtype=np.int64)
        if shows == "hyperedges":
            colors = base * asset.numbers(attributes["COLOR_0"])
            names = [each["id"] for each in node["extras"]["hyperedges"]]
            members = asset.values(attributes["_FEATURE_ID_0"])[:, 0].astype(np.int64)
        for number, name in enumerate(names):
            own = faces[members[faces[:, 0]] == number]
            assert (members[own] == number).all(), "triangles are of one hyperedge"
            assert name not in found
            found[name] = positions[own], normals[own], colors[own]
    return found


def corners_of(node: Node) -> Floats:
    """Corners of a node's triangles in the world, (f, 3, 3)."""
    return in_world(node)[node.primitives[0].mesh.faces]


def scaled(scene: Scene, factor: float) -> Scene:
    """The scene with hyperedges so many times as large, but no thicker, as if far apart."""

    def larger(node: Node) -> Node:
        if node.shows != "hyperedge":
            return node
        (part,) = node.primitives
        mesh = replace(part.mesh, vertices=part.mesh.vertices * np.float32(factor))
        x, y, z = node.translation
        place = (factor * x, factor * y, factor * z)
        return replace(node, primitives=(replace(part, mesh=mesh),), translation=place)

    return replace(scene, nodes=tuple(map(larger, scene.nodes)))
