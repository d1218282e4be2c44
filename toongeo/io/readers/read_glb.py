"""A binary glTF 2.0 file as its JSON and arrays."""

import hashlib
import json
import os
import re
import struct
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from toongeo._brief_repr import brief_repr
from toongeo.io.gltf.glb_builder import COLUMNS, COMPONENTS, NO_CHECKSUM, checksum_entry
from toongeo.reading.check_file import file_bytes
from toongeo.reading.promise import promised

__all__ = ["GlbDocument", "read_glb"]

_PACKED = {
    "EXT_meshopt_compression": "meshoptimizer",
    "KHR_meshopt_compression": "meshoptimizer",
    "KHR_draco_mesh_compression": "Draco",
}
_MOST_BYTES = 1 << 29  # of all accessors together, which a few bytes of a damaged file could announce to be huge


@dataclass(frozen=True, eq=False)
class GlbDocument:
    """What a GLB holds, in glTF's own units and axes.

    Parameters
    ----------
    json
        The JSON chunk.
    accessors
        An array each: (n,) scalars or (n, columns); sparse ones filled in; ``normalized`` ones as stored.
    images
        The bytes of each embedded picture (empty if it is not embedded).
    attachment
        What :func:`encode_glb` was given as such; None if there is none.
    intact
        Whether a file with an attachment is what :func:`encode_glb` made, to the last byte.
    """

    json: dict[str, Any]
    accessors: tuple[NDArray, ...]
    images: tuple[bytes, ...]
    attachment: bytes | None = None
    intact: bool = False

    __repr__ = brief_repr


@promised("a GLB (glTF 2.0)")
def read_glb(path: str | os.PathLike[str]) -> GlbDocument:
    """Read the JSON, every accessor and every embedded picture of a GLB.

    Parameters
    ----------
    path
        File with one binary chunk.

    Returns
    -------
    GlbDocument
        :func:`glb_scene` makes a scene of it, if :func:`write_glb` wrote it.

    Raises
    ------
    OSError
        If the file is missing or cannot be read.
    ValueError
        If it is no GLB of version 2, truncated, its accessors do not fit its buffer, or they are together beyond
        512 MB.
    """
    content = file_bytes(path)
    document, binary = _chunks(content)
    _check_extensions(document, path)
    views = [_view(binary, entry) for entry in document.get("bufferViews", [])]
    _check_size(document.get("accessors", []))
    accessors = tuple(_accessor(views, document, entry) for entry in document.get("accessors", []))
    images = tuple(_image(views, entry) for entry in document.get("images", []))
    attachment, intact = _attachment(content, document, views)
    return GlbDocument(document, accessors, images, attachment, intact)


def _chunks(content: bytes) -> tuple[dict[str, Any], bytes]:
    magic, version, length = struct.unpack_from("<4sII", content)
    if magic != b"glTF" or version != 2:
        raise ValueError(f"it starts with {content[:8]!r}")
    if length != len(content):
        raise ValueError(f"it announces {length} bytes and has {len(content)}")
    chunks: dict[bytes, bytes] = {}
    offset = 12
    while offset < length:
        size, kind = struct.unpack_from("<I4s", content, offset)
        if offset + 8 + size > length:
            raise ValueError("a chunk is cut off")
        chunks.setdefault(kind, content[offset + 8 : offset + 8 + size])
        offset += 8 + size
    document = json.loads(chunks[b"JSON"])
    if not isinstance(document, dict):
        raise ValueError(f"its JSON is {type(document).__name__}")
    return document, chunks.get(b"BIN\0", b"")


def _check_extensions(document: dict[str, Any], path: object) -> None:
    """Refuse what is packed in a way that is not unpacked here, by its name."""
    packed = {name: how for name, how in _PACKED.items() if name in document.get("extensionsRequired", ())}
    if packed:
        (name, how), *_ = packed.items()
        raise ValueError(
            f"path: expected a GLB whose arrays are plain, but those of {path} are packed by {how} ({name}); "
            f"write it again without"
        )


def _view(binary: bytes, entry: dict[str, Any]) -> memoryview:
    start = entry.get("byteOffset", 0)
    stop = start + entry["byteLength"]
    if entry["buffer"] != 0 or start < 0 or stop > len(binary):
        raise ValueError(f"a buffer view ends at byte {stop} of {len(binary)}")
    return memoryview(binary)[start:stop]


def _check_size(entries: list[dict[str, Any]]) -> None:
    size = sum(
        entry["count"] * COLUMNS[entry["type"]] * np.dtype(COMPONENTS[entry["componentType"]]).itemsize
        for entry in entries
    )
    if not 0 <= size <= _MOST_BYTES or any(entry["count"] < 1 for entry in entries):
        raise ValueError(f"the accessors announce {size} bytes")


def _attachment(content: bytes, document: dict[str, Any], views: list[memoryview]) -> tuple[bytes | None, bool]:
    """The attachment, and whether the file has the checksum that stands in it."""
    extras = document.get("extras")
    entry = extras.get("toongeo") if isinstance(extras, dict) else None
    if entry is None:
        return None, False
    checksum = entry["sha256"]
    if not re.fullmatch("[0-9a-f]{64}", checksum):
        return bytes(views[entry["bufferView"]]), False
    original = content.replace(checksum_entry(checksum), checksum_entry(NO_CHECKSUM), 1)
    return bytes(views[entry["bufferView"]]), hashlib.sha256(original).hexdigest() == checksum


def _image(views: list[memoryview], entry: dict[str, Any]) -> bytes:
    return bytes(views[entry["bufferView"]]) if "bufferView" in entry else b""


def _accessor(views: list[memoryview], document: dict[str, Any], entry: dict[str, Any]) -> NDArray:
    dtype = np.dtype(COMPONENTS[entry["componentType"]])
    columns, count = COLUMNS[entry["type"]], entry["count"]
    array = np.zeros((count, columns), dtype)
    if "bufferView" in entry:
        view = entry["bufferView"]
        strides = document["bufferViews"][view].get("byteStride", dtype.itemsize * columns), dtype.itemsize
        array[:] = np.ndarray((count, columns), dtype, views[view], entry.get("byteOffset", 0), strides)
    if "sparse" in entry:
        sparse, size = entry["sparse"], entry["sparse"]["count"]
        index_type = np.dtype(COMPONENTS[sparse["indices"]["componentType"]])
        values = _plain(views, sparse["values"], dtype, size * columns)
        array[_plain(views, sparse["indices"], index_type, size)] = values.reshape(size, columns)
    return array[:, 0] if columns == 1 else array


def _plain(views: list[memoryview], entry: dict[str, Any], dtype: np.dtype, count: int) -> NDArray:
    return np.frombuffer(views[entry["bufferView"]], dtype, count, entry.get("byteOffset", 0))
