"""The formats of a scene, each with its media type and file ending."""

from __future__ import annotations

from enum import StrEnum
from typing import Literal, TypeAlias

Parts: TypeAlias = Literal["all", "items", "hyperedges"]
"""What of a scene is printed. Never the ground."""

Compression: TypeAlias = Literal["none", "quantize", "meshopt"]
"""How glTF is made smaller: by whole numbers (KHR_mesh_quantization), by those and encoding them
(EXT_meshopt_compression), or not."""


class SceneFormat(StrEnum):
    """What a scene can be answered as."""

    GLB = "glb"
    GLTF = "gltf"
    PNG = "png"
    STL = "stl"
    THREE_MF = "3mf"

    @property
    def media_type(self) -> str:
        """The media type as registered with IANA."""
        return {
            "glb": "model/gltf-binary",
            "gltf": "model/gltf+json",
            "png": "image/png",
            "stl": "model/stl",
            "3mf": "model/3mf",
        }[self.value]

    @property
    def description(self) -> str:
        """What people call it."""
        return {
            "glb": "glTF 2.0, binary",
            "gltf": "glTF 2.0, JSON with embedded buffers",
            "png": "PNG picture",
            "stl": "STL for printing, binary",
            "3mf": "3MF for printing, with names and colours",
        }[self.value]

    @property
    def is_printed(self) -> bool:
        """Whether it holds closed bodies, for printers."""
        return self in {SceneFormat.STL, SceneFormat.THREE_MF}
