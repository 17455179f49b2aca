"""Reads glTF back, by the specification and not by our writer."""

from __future__ import annotations

import base64
import json
import struct
from dataclasses import dataclass
from typing import Any

import numpy as np
from meshopt import decode_gltf_buffer
from numpy.typing import NDArray

_COMPONENTS = {5120: "i1", 5121: "u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
_WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}


@dataclass(frozen=True)
class Asset:
    """A glTF document and the only buffer that is stored."""

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
        buffer = _stored(document)
        if buffer is None:
            assert len(chunks) == 1
            return Asset(document, b"")
        assert "uri" not in buffer
        assert 0 <= len(chunks[1][1]) - buffer["byteLength"] < 4
        return Asset(document, chunks[1][1][: buffer["byteLength"]])

    @staticmethod
    def from_gltf(data: bytes) -> Asset:
        document = json.loads(data)
        buffer = _stored(document)
        if buffer is None:
            return Asset(document, b"")
        head, _, text = buffer["uri"].partition(",")
        assert head == "data:application/octet-stream;base64"
        content = base64.b64decode(text, validate=True)
        assert len(content) == buffer["byteLength"]
        return Asset(document, content)

    def values(self, accessor: int) -> NDArray[Any]:
        """What an accessor gives access to, (count, width), as it is stored."""
        entry = self.json["accessors"][accessor]
        view = self.json["bufferViews"][entry["bufferView"]]
        kind, width = np.dtype(_COMPONENTS[entry["componentType"]]), _WIDTHS[entry["type"]]
        tight = kind.itemsize * width
        stride = view.get("byteStride", tight)
        assert stride >= tight
        offset = entry.get("byteOffset", 0)
        assert offset % kind.itemsize == 0
        assert offset % 4 == 0 or "byteStride" not in view
        assert offset + (entry["count"] - 1) * stride + tight <= view["byteLength"]
        rows = self._rows(entry["bufferView"])[offset : offset + entry["count"] * stride]
        found = rows.reshape(-1, stride)[:, :tight].copy().view(kind)
        for bound, of in (("min", np.min), ("max", np.max)):
            if bound in entry:
                assert np.array_equal(of(found, axis=0), np.array(entry[bound], dtype=kind))
        return found

    def numbers(self, accessor: int) -> NDArray[np.float64]:
        """What an accessor means: whole numbers that are normalized reach from -1 or 0 to 1."""
        found = self.values(accessor)
        if not self.json["accessors"][accessor].get("normalized"):
            return found.astype(np.float64)
        return np.maximum(found / np.iinfo(found.dtype).max, -1.0)

    def _rows(self, number: int) -> NDArray[np.uint8]:
        """The bytes of a view, decoded as EXT_meshopt_compression says."""
        view = self.json["bufferViews"][number]
        coded = view.get("extensions", {}).get("EXT_meshopt_compression")
        if coded is None:
            assert view["buffer"] == 0
            start = view.get("byteOffset", 0)
            data = self.buffer[start : start + view["byteLength"]]
            assert len(data) == view["byteLength"]
            return np.frombuffer(data, dtype=np.uint8)
        fallback = self.json["buffers"][view["buffer"]]
        assert fallback["extensions"]["EXT_meshopt_compression"] == {"fallback": True}
        assert view["byteOffset"] + view["byteLength"] <= fallback["byteLength"]
        assert view["byteLength"] == coded["count"] * coded["byteStride"]
        start = coded.get("byteOffset", 0)
        data = self.buffer[start : start + coded["byteLength"]]
        # Specified are the first version of the codec for vertices, the second for triangles.
        assert data[0] == (0xA0 if coded["mode"] == "ATTRIBUTES" else 0xE1)
        decoded = decode_gltf_buffer(
            data, coded["count"], coded["byteStride"], coded["mode"], coded.get("filter")
        )
        return np.ascontiguousarray(decoded).view(np.uint8).reshape(-1)

    def node(self, name: str) -> dict[str, Any]:
        """The only node of that name."""
        (found,) = [node for node in self.json["nodes"] if node.get("name") == name]
        return dict(found)

    def primitives(self, name: str) -> list[dict[str, Any]]:
        """The primitives of the node of that name."""
        return list(self.json["meshes"][self.node(name)["mesh"]]["primitives"])


def _stored(document: dict[str, Any]) -> dict[str, Any] | None:
    """The only buffer with contents; a second one may stand in for what is encoded."""
    buffers = document.get("buffers", [None])
    assert len(buffers) == 1 or "uri" not in buffers[1]
    found: dict[str, Any] | None = buffers[0]
    return found
