"""Materials on what they are on: as deep as light goes there, with a texture where that fits."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from app.output.gltf_materials import Depth, chord_of
from app.scene.scene import Material
from app.solids.mesh import Mesh


@dataclass(frozen=True, slots=True, eq=False)
class Surfaces:
    """The scene's ``materials``, and after them those that differ by what they are on.

    ``depths`` are of those that light goes through, by number.
    """

    materials: list[Material]
    depths: dict[int, Depth]
    _known: dict[tuple[int, bool, Depth | None], int]
    _chords: dict[int, float]

    @staticmethod
    def of(materials: Sequence[Material]) -> Surfaces:
        """A scene's materials, on nothing yet."""
        return Surfaces(list(materials), {}, {}, {})

    def number(self, number: int, mesh: Mesh, scale: float) -> int:
        """Of a material on ``mesh`` in a node of that ``scale``; the scene keeps the mesh alive.

        It has no texture where the mesh has no coordinates.
        """
        material = self.materials[number]
        is_bare = material.texture is not None and mesh.coordinates is None
        if not is_bare and not material.transmission:
            return number
        depth = self._depth(mesh, scale) if material.transmission else None
        place = self._known.setdefault((number, is_bare, depth), len(self.materials))
        if place == len(self.materials):
            self.materials.append(replace(material, texture=None) if is_bare else material)
            if depth is not None:
                self.depths[place] = depth
        return place

    def add(self, materials: Sequence[Material]) -> int:
        """Add those of a crowd, which has no coordinates; the number of the first of them."""
        first = len(self.materials)
        self.materials.extend(replace(material, texture=None) for material in materials)
        return first

    def _depth(self, mesh: Mesh, scale: float) -> Depth | None:
        chord = self._chords.get(id(mesh))
        if chord is None:
            chord = self._chords[id(mesh)] = chord_of(mesh)
        return Depth(chord, scale) if chord else None
