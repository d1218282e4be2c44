"""The two chunks of a GLB file: JSON, and the buffer its accessors look into (glTF 2.0, 3.6 and 4)."""

import hashlib
import json
import struct
from typing import Any

import numpy as np
from numpy.typing import NDArray

__all__ = ["COLUMNS", "COMPONENTS", "GlbBuilder", "INDICES", "NO_CHECKSUM", "VERTICES", "checksum_entry"]

# glTF's component types by numpy type, and its element types by number of columns.
COMPONENTS = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
COLUMNS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT2": 4, "MAT3": 9, "MAT4": 16}
VERTICES, INDICES = 34962, 34963  # targets of buffer views
NO_CHECKSUM = "0" * 64  # stands in the file while its checksum is taken
_CODES = {np.dtype(name): code for code, name in COMPONENTS.items()}
_TYPES = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4", 16: "MAT4"}


class GlbBuilder:
    """Collects the parts of a GLB; each method that adds something returns its index."""

    def __init__(self) -> None:
        self.json: dict[str, Any] = {"asset": {"version": "2.0", "generator": "toongeo"}}
        self._binary = bytearray()

    @classmethod
    def extending(cls, document: dict[str, Any], content: bytes) -> "GlbBuilder":
        """A builder that goes on where a file ends: its JSON, and the bytes of the file itself."""
        builder = cls()
        builder.json = document
        start = 20 + struct.unpack_from("<I", content, 12)[0]
        if start < len(content):
            builder._binary += content[start + 8 : start + 8 + struct.unpack_from("<I", content, start)[0]]
        return builder

    def add(self, kind: str, **entry: Any) -> int:
        """Append to one of the document's lists; properties that are None are left out."""
        entries = self.json.setdefault(kind, [])
        entries.append({key: value for key, value in entry.items() if value is not None})
        return len(entries) - 1

    def use(self, extension: str, *, required: bool = False) -> None:
        """Announce an extension of the format."""
        for key in ("extensionsUsed", "extensionsRequired")[: 1 + required]:
            names = self.json.setdefault(key, [])
            if extension not in names:
                names.append(extension)

    def view(self, content: bytes, target: int | None = None, stride: int | None = None) -> int:
        offset = len(self._binary)
        self._binary += content + bytes(-len(content) % 4)  # every view starts at a multiple of 4
        return self.add(
            "bufferViews", buffer=0, byteOffset=offset, byteLength=len(content), byteStride=stride, target=target
        )

    def accessor(
        self, array: NDArray, target: int | None = None, *, bounds: bool = False, normalized: bool = False
    ) -> int:
        """``array`` is (n,) or (n, columns) of the type it shall have in the file; integers of vertices are padded."""
        row = array.itemsize * (1 if array.ndim == 1 else array.shape[1])
        content, stride = array.tobytes(), None
        if target == VERTICES and row % 4:  # every vertex starts at a multiple of 4 (3.6.2.4)
            stride = row + -row % 4
            rows = np.frombuffer(content, np.uint8).reshape(len(array), row)
            content = np.pad(rows, ((0, 0), (0, stride - row))).tobytes()
        view = self.view(content, target, stride)
        return self.add("accessors", bufferView=view, **self.described(array, bounds, normalized))

    def encode(self, attachment: bytes | None = None) -> bytes:
        """The file; an attachment lies in its buffer where other programs do not look, beside the file's checksum."""
        if attachment is not None:
            self.json["extras"] = {"toongeo": {"bufferView": self.view(attachment), "sha256": NO_CHECKSUM}}
        self.json["buffers"] = [{"byteLength": len(self._binary)}]
        text = json.dumps(self.json, separators=(",", ":"), allow_nan=False).encode()
        text += b" " * (-len(text) % 4)
        binary = bytes(self._binary)
        document = struct.pack("<I4s", len(text), b"JSON") + text
        buffer = struct.pack("<I4s", len(binary), b"BIN\0") + binary
        content = struct.pack("<4sII", b"glTF", 2, 12 + len(document) + len(buffer)) + document + buffer
        if attachment is None:
            return content
        return content.replace(checksum_entry(NO_CHECKSUM), checksum_entry(hashlib.sha256(content).hexdigest()), 1)

    @staticmethod
    def described(array: NDArray, bounds: bool = False, normalized: bool = False) -> dict[str, Any]:
        """An accessor's entry for an array, without the view it looks into."""
        columns = 1 if array.ndim == 1 else array.shape[1]
        entry = {"componentType": _CODES[array.dtype], "count": len(array), "type": _TYPES[columns]}
        if normalized:
            entry["normalized"] = True
        if bounds:
            entry["min"] = np.atleast_1d(array.min(axis=0)).tolist()
            entry["max"] = np.atleast_1d(array.max(axis=0)).tolist()
        return entry


def checksum_entry(checksum: str) -> bytes:
    """The bytes of the JSON in which the checksum stands."""
    return f'"sha256":"{checksum}"'.encode()
