"""How a scene is packed into glTF's buffer: what is merged, and what is compressed."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass, replace
from functools import partial
from math import inf
from typing import Any

import numpy as np

from app.output.gltf_blocks import Block, block_of, block_of_chunk
from app.output.gltf_chunks import Chunk, chunks_of, crowd_of
from app.output.gltf_materials import Depth
from app.output.gltf_numbers import MOST_STEPS, fits, spacing
from app.output.gltf_surfaces import Surfaces
from app.output.gltf_textures import texture_file
from app.output.gltf_views import MESHOPT, Laid, encoded, file, lay
from app.output.media import Compression
from app.scene.scene import Material, Node, Scene, TextureName
from app.solids.mesh import Mesh

QUANTIZATION = "KHR_mesh_quantization"
FEATURES = "EXT_mesh_features"

MANY = 1_000
"""Hyperedges up to which each is a node of its own, unless asked otherwise: a viewer draws so many
in no time, and editors find them by name."""

_UPRIGHT = (0.0, 0.0, 0.0, 1.0)

_THREADS = 2
_AHEAD = 8
"""Blocks that may wait to be encoded: they take memory."""


@dataclass(frozen=True, slots=True)
class Packing:
    """What is asked for: ``merge`` of hyperedges or not, ``None`` if there are more than `MANY`.

    >>> Packing().merges(MANY), Packing().merges(MANY + 1), Packing(merge=True).merges(1)
    (False, True, True)
    """

    compress: Compression = "none"
    merge: bool | None = None

    def merges(self, hyperedges: int) -> bool:
        """Whether so many hyperedges are merged."""
        return hyperedges > MANY if self.merge is None else self.merge


@dataclass(frozen=True, slots=True, eq=False)
class PackedNode:
    """A node of the file. ``parts`` are numbers of primitives, each with that of its material."""

    name: str
    translation: tuple[float, float, float]
    rotation: tuple[float, float, float, float]
    scale: float
    extras: Mapping[str, Any]
    parts: tuple[tuple[int, int], ...]


@dataclass(frozen=True, slots=True, eq=False)
class Packed:
    """Nodes with what they show. ``primitives`` and ``accessors`` are JSON texts.

    ``materials`` are the scene's, then those of chunks, and then those that differ from them by
    what they are on: ``depths`` of what light goes through, by number of the material.
    A primitive's text lacks its braces and its material. ``textures`` are the numbers of the views
    that hold them.
    """

    nodes: list[PackedNode]
    materials: list[Material]
    depths: dict[int, Depth]
    textures: dict[TextureName, int]
    primitives: list[bytes]
    accessors: list[bytes]
    buffer: Laid
    extensions: dict[str, bool]
    """Names of extensions used, and whether a reader must know them."""


def pack(scene: Scene, packing: Packing) -> Packed:
    """The scene's nodes and triangles, merged and compressed as ``packing`` says."""
    plan = _plan(scene, packing)
    blocks = _made(plan.tasks)
    first_view = first_accessor = 0
    accessors: list[bytes] = []
    primitives: list[bytes] = []
    for block in blocks:
        accessors += [
            b'{"bufferView":%d,%b}' % (first_view + accessor.view, accessor.text)
            for accessor in block.accessors
        ]
        names = b",".join(b'"%b":%%d' % name.encode() for name in block.attributes)
        text = b'"attributes":{%b},"indices":%%d' % names
        primitives += [
            text % tuple([first_accessor + number for number in found])
            for found in block.primitives
        ]
        first_view += len(block.views)
        first_accessor += len(block.accessors)
    # The chunks' primitives come last.
    for number, chunk in enumerate(reversed(plan.chunks), start=1):
        primitives[-number] += b',"extensions":{"%b":%b}' % (FEATURES.encode(), _features(chunk))
    extensions = {}
    if plan.chunks:
        extensions[FEATURES] = False
    if blocks and packing.compress != "none":
        extensions[QUANTIZATION] = True
        if packing.compress == "meshopt":
            extensions[MESHOPT] = True
    views = [view for block in blocks for view in block.views]
    textures: dict[TextureName, int] = {}
    for name in _textures(plan):
        textures[name] = len(views)
        views.append(file(texture_file(name)))
    return Packed(
        plan.nodes,
        plan.surfaces.materials,
        plan.surfaces.depths,
        textures,
        primitives,
        accessors,
        lay(views),
        extensions,
    )


@dataclass(frozen=True, slots=True, eq=False)
class _Plan:
    """Nodes, and what makes the blocks of their primitives: one for each of the chunks, last."""

    nodes: list[PackedNode]
    surfaces: Surfaces
    tasks: list[Callable[[], Block]]
    chunks: list[Chunk]


def _plan(scene: Scene, packing: Packing) -> _Plan:
    drawn = [node for node in scene.nodes if node.shows == "hyperedge" and _is_simple(node)]
    thinnest = min([node.radius for node in drawn if node.radius is not None], default=inf)
    kept, crowd = scene.nodes, scene.crowd
    bare = [node for node in drawn if _is_bare(node)]
    if crowd is None and bare and packing.merges(len(drawn)):
        crowd = crowd_of(bare, scene.materials)
        merged = set(map(id, bare))
        kept = tuple([node for node in kept if id(node) not in merged])
    if crowd is not None:
        thinnest = min(thinnest, float(np.nanmin(crowd.radii, initial=inf)))
    finest = spacing(thinnest)
    meshes = _meshes(kept)
    steps = {} if packing.compress == "none" else _steps(kept)
    alike: dict[tuple[bool, bool], list[int]] = {}
    for key, mesh in meshes.items():
        alike.setdefault((mesh.coordinates is not None, key in steps), []).append(key)
    tasks: list[Callable[[], Block]] = []
    places: dict[int, int] = {}
    for (_, is_gridded), keys in sorted(alike.items()):
        found = [meshes[key] for key in keys]
        widths = np.array([steps[key] for key in keys]) if is_gridded else None
        tasks.append(partial(block_of, found, packing.compress, finest, widths))
        places |= {key: len(places) + place for place, key in enumerate(keys)}
    surfaces = Surfaces.of(scene.materials)
    nodes = [_kept(node, places, steps, surfaces) for node in kept]
    chunks: list[Chunk] = []
    if crowd is not None:
        chunks = chunks_of(crowd)
        first = surfaces.add(crowd.materials)
        tasks += [partial(block_of_chunk, chunk, packing.compress, finest) for chunk in chunks]
        for number, chunk in enumerate(chunks):
            part = len(places) + number, first + chunk.surface
            nodes.append(_merged(chunk, number, part, is_gridded=packing.compress != "none"))
    return _Plan(nodes, surfaces, tasks, chunks)


def _textures(plan: _Plan) -> list[TextureName]:
    """Those that are shown, each once."""
    materials = plan.surfaces.materials
    if all(material.texture is None for material in materials):
        return []
    shown = (materials[number].texture for node in plan.nodes for _, number in node.parts)
    return [name for name in dict.fromkeys(shown) if name is not None]


def _is_simple(node: Node) -> bool:
    return len(node.primitives) == 1 and len(node.primitives[0].mesh.faces) > 0


def _is_bare(node: Node) -> bool:
    return node.primitives[0].mesh.coordinates is None


def _meshes(nodes: Sequence[Node]) -> dict[int, Mesh]:
    """All meshes that have triangles, each once, by identity: the scene keeps them alive."""
    return {
        id(part.mesh): part.mesh
        for node in nodes
        for part in node.primitives
        if len(part.mesh.faces)
    }


def _steps(nodes: Sequence[Node]) -> dict[int, float]:
    """By mesh: the grids of tubes that fit on it, where one node alone shows them."""
    found: dict[int, float | None] = {}
    for node in nodes:
        step = None if node.radius is None or not _is_simple(node) else spacing(node.radius)
        for part in node.primitives:
            known = id(part.mesh) in found
            suits = (
                step is not None
                and not known
                and len(part.mesh.faces) > 0
                and fits(float(np.abs(part.mesh.vertices).max()), step)
            )
            found[id(part.mesh)] = step if suits else None
    return {key: step for key, step in found.items() if step is not None}


def _made(tasks: Sequence[Callable[[], Block]]) -> list[Block]:
    """All blocks, encoded: other threads do that, which needs no Python, while more are made."""
    blocks: list[Block] = []
    waiting: deque[Future[Block]] = deque()
    with ThreadPoolExecutor(_THREADS) as pool:
        for task in tasks:
            waiting.append(pool.submit(_encoded, task()))
            if len(waiting) > _AHEAD:
                blocks.append(waiting.popleft().result())
        blocks += [future.result() for future in waiting]
    return blocks


def _encoded(block: Block) -> Block:
    return replace(block, views=[encoded(view) for view in block.views])


def _kept(
    node: Node, places: Mapping[int, int], steps: Mapping[int, float], surfaces: Surfaces
) -> PackedNode:
    parts = [part for part in node.primitives if len(part.mesh.faces)]
    scale = MOST_STEPS * steps[id(parts[0].mesh)] if parts and id(parts[0].mesh) in steps else 1.0
    return PackedNode(
        node.name,
        node.translation,
        node.rotation,
        scale,
        node.extras,
        tuple(
            [
                (places[id(part.mesh)], surfaces.number(part.material, part.mesh, scale))
                for part in parts
            ]
        ),
    )


def _merged(chunk: Chunk, number: int, part: tuple[int, int], *, is_gridded: bool) -> PackedNode:
    """A node of many hyperedges, with what their own nodes would say of them."""
    x, y, z = chunk.center.tolist()
    said = [chunk.crowd.extras(member) for member in chunk.members.tolist()]
    return PackedNode(
        f"hyperedges {number}",
        (x, y, z),
        _UPRIGHT,
        MOST_STEPS * chunk.step if is_gridded and chunk.step is not None else 1.0,
        {"shows": "hyperedges", "hyperedges": said},
        (part,),
    )


def _features(chunk: Chunk) -> bytes:
    return b'{"featureIds":[{"featureCount":%d,"attribute":0,"label":"hyperedge"}]}' % len(
        chunk.members
    )
