"""A scene as closed shells in millimetres: what printers are sent."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from app.arrays import Faces, Floats, Singles
from app.errors import DocumentTooLarge, Fault, Unprintable, pointer
from app.output.media import Parts
from app.placement.turning import matrices
from app.scene.scene import Material, Node, Scene
from app.solids.mesh import Mesh
from app.solids.welding import part, weld

_SHOWN: Mapping[Parts, tuple[str, ...]] = {
    "all": ("item", "hyperedge"),
    "items": ("item",),
    "hyperedges": ("hyperedge",),
}


@dataclass(frozen=True, slots=True, eq=False)
class Shell:
    """A closed surface in millimetres, z up.

    ``vertices`` (v, 3) float32 are positions, no two alike; ``faces`` (f, 3) uint32 are
    counter-clockwise seen from outside, and none has two corners at one position. ``name`` is the
    id of what it is of.
    """

    name: str
    material: Material
    vertices: Singles
    faces: Faces


def shells(scene: Scene, parts: Parts, scale: float) -> Iterator[Shell]:
    """The shells of ``parts`` of a scene, ``scale`` millimetres to a unit of the document.

    Each hyperedge is one shell; an item is one for its body and one for its label, whose letters
    are closed each by itself. The lowest corner of all is at the origin. Raises `Unprintable`,
    naming it, where a hyperedge is finer than single precision can tell in so large a scene.
    """
    shown = [node for node in scene.nodes if node.shows in _SHOWN[parts]]
    welded: dict[int, tuple[Singles, Faces]] = {}
    lowest = _lowest(shown, welded)
    for node in shown:
        turn, move = matrices(np.array(node.rotation)), np.array(node.translation) - lowest
        for primitive in node.primitives:
            positions, faces = welded[id(primitive.mesh)]
            # Not by a matrix product: it may round equal rows differently, by where they stand.
            placed = np.einsum("xy,vy->vx", turn, positions.astype(np.float64)) + move
            if node.shows == "hyperedge":
                parted = part(scale * placed, faces)
                if parted is None:
                    raise Unprintable([Fault(pointer("hyperedges"), _too_fine(node.name))])
                vertices = parted
            else:
                # Details finer than a printer's are lost here, and never the surface's being
                # closed: a boundary that is nowhere remains nowhere when points become one.
                vertices, faces = weld((scale * placed).astype(np.float32), faces)
            if len(faces):
                yield Shell(node.name, scene.materials[primitive.material], vertices, faces)


def refuse_too_many(triangles: int, most: int) -> None:
    """Raise `DocumentTooLarge` where a print would have more triangles than ``most``."""
    if triangles > most:
        detail = f"A print of {triangles} triangles is more than the limit of {most}."
        raise DocumentTooLarge([Fault("", detail)])


def triangles_of(scene: Scene, parts: Parts) -> int:
    """How many triangles the shells of ``parts`` have at most."""
    return sum(
        len(primitive.mesh.faces)
        for node in scene.nodes
        if node.shows in _SHOWN[parts]
        for primitive in node.primitives
    )


def _lowest(nodes: list[Node], welded: dict[int, tuple[Singles, Faces]]) -> Floats:
    """The lowest corner (3,) of all that the nodes show; fills ``welded`` by meshes."""
    lowest = np.full(3, np.inf)
    for node in nodes:
        turn = matrices(np.array(node.rotation))
        for primitive in node.primitives:
            mesh: Mesh = primitive.mesh
            if id(mesh) not in welded:
                welded[id(mesh)] = weld(mesh.vertices, mesh.faces)
            placed = np.einsum("xy,vy->vx", turn, welded[id(mesh)][0].astype(np.float64))
            lowest = np.minimum(lowest, placed.min(axis=0, initial=np.inf) + node.translation)
    return lowest


def _too_fine(name: str) -> str:
    return (
        f"Hyperedge {name!r} cannot be printed: it is too fine for single precision in so large a "
        "scene."
    )
