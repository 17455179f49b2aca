"""Scenes as glTF 2.0: binary, or JSON with the buffer embedded."""

from __future__ import annotations

import struct
from binascii import b2a_base64

from app.output.gltf_document import describe
from app.scene.scene import Scene

JSON_CHUNK, BINARY_CHUNK = 0x4E4F534A, 0x004E4942


def write_glb(scene: Scene) -> bytes:
    """The scene as binary glTF (media type ``model/gltf-binary``).

    Equal meshes are written once. Colours are linear and lengths in document units; one root
    node turns z up to y up. Every node of the scene keeps its name and its extras.
    """
    document = describe(scene)
    text = document.text()
    text += b" " * (-len(text) % 4)
    chunks = [struct.pack("<II", len(text), JSON_CHUNK), text]
    length = document.packed.length
    padding = -length % 4
    if length:
        chunks.append(struct.pack("<II", length + padding, BINARY_CHUNK))
        chunks += [*document.packed.pieces, bytes(padding)]
    total = 20 + len(text) + (8 + length + padding if length else 0)
    return b"".join([struct.pack("<4sII", b"glTF", 2, total), *chunks])


def write_gltf(scene: Scene) -> bytes:
    """The scene as one JSON document (media type ``model/gltf+json``).

    All else is as in `write_glb`.
    """
    document = describe(scene)
    buffer = b2a_base64(b"".join(document.packed.pieces), newline=False)
    return document.text(b',"uri":"data:application/octet-stream;base64,%b"' % buffer)
