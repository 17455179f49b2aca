"""Scenes as glTF 2.0: binary, or JSON with the buffer embedded."""

from __future__ import annotations

import struct
from binascii import b2a_base64

from app.errors import DocumentTooLarge, Fault
from app.output.gltf_document import Document, describe
from app.output.gltf_motion import Animation, describe_moving
from app.output.gltf_packing import Packing
from app.scene.scene import Scene

MOST_BYTES = 0xFFFFFFFF
"""Of a GLB file: it says its length in 32 bits."""

JSON_CHUNK, BINARY_CHUNK = 0x4E4F534A, 0x004E4942


PLAIN = Packing()


def write_glb(scene: Scene, packing: Packing = PLAIN, animation: Animation | None = None) -> bytes:
    """The scene as binary glTF (media type ``model/gltf-binary``), moving if there is an animation.

    Equal meshes are written once. Colours are linear and lengths in document units; one root
    node turns z up to y up. Every node of the scene keeps its name and its extras.
    """
    document = _described(scene, packing, animation)
    text = document.text()
    text += b" " * (-len(text) % 4)
    length = document.packed.buffer.length
    padding = -length % 4
    total = 20 + len(text) + (8 + length + padding if length else 0)
    if total > MOST_BYTES:
        advice = "" if packing.compress == "meshopt" else "; meshopt makes them a tenth"
        raise DocumentTooLarge([Fault("", f"{total} bytes are more than GLB can hold{advice}.")])
    chunks = [struct.pack("<II", len(text), JSON_CHUNK), text]
    if length:
        chunks.append(struct.pack("<II", length + padding, BINARY_CHUNK))
        chunks += [*document.packed.buffer.pieces, bytes(padding)]
    return b"".join([struct.pack("<4sII", b"glTF", 2, total), *chunks])


def write_gltf(scene: Scene, packing: Packing = PLAIN, animation: Animation | None = None) -> bytes:
    """The scene as one JSON document (media type ``model/gltf+json``).

    All else is as in `write_glb`.
    """
    document = _described(scene, packing, animation)
    buffer = b2a_base64(b"".join(document.packed.buffer.pieces), newline=False)
    return document.text(b',"uri":"data:application/octet-stream;base64,%b"' % buffer)


def _described(scene: Scene, packing: Packing, animation: Animation | None) -> Document:
    if animation is None:
        return describe(scene, packing)
    return describe_moving(scene, packing, animation)
