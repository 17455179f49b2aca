"""The formats of a scene, each with its media type and file ending."""

from __future__ import annotations

from enum import StrEnum


class SceneFormat(StrEnum):
    """What a scene can be answered as."""

    GLB = "glb"
    GLTF = "gltf"
    PNG = "png"

    @property
    def media_type(self) -> str:
        """The media type as registered with IANA."""
        return {"glb": "model/gltf-binary", "gltf": "model/gltf+json", "png": "image/png"}[
            self.value
        ]

    @property
    def description(self) -> str:
        """What people call it."""
        return {
            "glb": "glTF 2.0, binary",
            "gltf": "glTF 2.0, JSON with embedded buffers",
            "png": "PNG picture",
        }[self.value]
