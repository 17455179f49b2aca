"""Reads glTF back, by the specification and not by our writer."""

from __future__ import annotations

import base64
import json
import struct
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

_COMPONENTS = {5121: "u1", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
_WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}


@dataclass(frozen=True)
class Asset:
    """A glTF document and its only buffer."""

    json: dict[str, Any]
    buffer: bytes

    @staticmethod
    def from_glb(data: bytes) -> Asset:
        magic, version, total = struct.unpack_from("<4sII", data)
        assert (magic, version, total) == (b"glTF", 2, len(data))
        chunks, offset = [], 12
        while offset < total:
            length, kind = struct.unpack_from("<I4s", data, offset)
            assert length % 4 == 0
            chunks.append((kind, data[offset + 8 : offset + 8 + length]))
            offset += 8 + length
        assert offset == total
        assert [kind for kind, _ in chunks] in ([b"JSON"], [b"JSON", b"BIN\0"])
        document = json.loads(chunks[0][1])
        (buffer,) = document.get("buffers", [None])
        if buffer is None:
            assert len(chunks) == 1
            return Asset(document, b"")
        assert "uri" not in buffer
        assert 0 <= len(chunks[1][1]) - buffer["byteLength"] < 4
        return Asset(document, chunks[1][1][: buffer["byteLength"]])

    @staticmethod
    def from_gltf(data: bytes) -> Asset:
        document = json.loads(data)
        (buffer,) = document.get("buffers", [None])
        if buffer is None:
            return Asset(document, b"")
        head, _, text = buffer["uri"].partition(",")
        assert head == "data:application/octet-stream;base64"
        content = base64.b64decode(text, validate=True)
        assert len(content) == buffer["byteLength"]
        return Asset(document, content)

    def values(self, accessor: int) -> NDArray[Any]:
        """What an accessor gives access to, (count, width)."""
        entry = self.json["accessors"][accessor]
        view = self.json["bufferViews"][entry["bufferView"]]
        kind, width = np.dtype(_COMPONENTS[entry["componentType"]]), _WIDTHS[entry["type"]]
        start = view.get("byteOffset", 0) + entry.get("byteOffset", 0)
        tight = kind.itemsize * width
        assert view.get("byteStride", tight) == tight
        assert start % kind.itemsize == 0
        end = view.get("byteOffset", 0) + view["byteLength"]
        assert start + entry["count"] * tight <= end
        count = entry["count"] * width
        return np.frombuffer(self.buffer, kind, count, start).reshape(-1, width)

    def node(self, name: str) -> dict[str, Any]:
        """The only node of that name."""
        (found,) = [node for node in self.json["nodes"] if node.get("name") == name]
        return dict(found)

    def primitives(self, name: str) -> list[dict[str, Any]]:
        """The primitives of the node of that name."""
        return list(self.json["meshes"][self.node(name)["mesh"]]["primitives"])
