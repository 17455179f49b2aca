"""The formats of a scene, each with its media type and file ending."""

from __future__ import annotations

from enum import StrEnum
from typing import Literal, TypeAlias

Parts: TypeAlias = Literal["all", "items", "hyperedges"]
"""What of a scene is printed. Never the ground."""

Compression: TypeAlias = Literal["none", "quantize", "meshopt"]
"""How glTF is made smaller: by whole numbers (KHR_mesh_quantization), by those and encoding them
(EXT_meshopt_compression), or not."""


Quality: TypeAlias = Literal["draft", "final"]
"""By z-buffer, within a fraction of a second; or path traced, within seconds."""

Motion: TypeAlias = Literal["turntable", "flight"]
"""Once around the scene; or from far above along the tubes to the usual view."""


class SceneFormat(StrEnum):
    """What a scene can be answered as."""

    GLB = "glb"
    GLTF = "gltf"
    PNG = "png"
    SVG = "svg"
    WEBP = "webp"
    MP4 = "mp4"
    STL = "stl"
    THREE_MF = "3mf"

    @property
    def media_type(self) -> str:
        """The media type as registered with IANA."""
        return {
            "glb": "model/gltf-binary",
            "gltf": "model/gltf+json",
            "png": "image/png",
            "svg": "image/svg+xml",
            "webp": "image/webp",
            "mp4": "video/mp4",
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
            "svg": "SVG line drawing",
            "webp": "WebP, animated",
            "mp4": "MP4 film",
            "stl": "STL for printing, binary",
            "3mf": "3MF for printing, with names and colours",
        }[self.value]

    @property
    def is_printed(self) -> bool:
        """Whether it holds closed bodies, for printers."""
        return self in {SceneFormat.STL, SceneFormat.THREE_MF}

    @property
    def is_gltf(self) -> bool:
        """Whether it holds the scene itself, for viewers."""
        return self in {SceneFormat.GLB, SceneFormat.GLTF}

    @property
    def is_animated(self) -> bool:
        """Whether it is a picture that moves."""
        return self in {SceneFormat.WEBP, SceneFormat.MP4}
