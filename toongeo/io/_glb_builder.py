"""The two chunks of a GLB file: JSON, and the buffer its accessors look into (glTF 2.0, 3.6 and 4)."""

import json
import struct
from typing import Any

import numpy as np
from numpy.typing import NDArray

# glTF's component types by numpy type, and its element types by number of columns.
COMPONENTS = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
COLUMNS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT2": 4, "MAT3": 9, "MAT4": 16}
VERTICES, INDICES = 34962, 34963  # targets of buffer views
_CODES = {np.dtype(name): code for code, name in COMPONENTS.items()}
_TYPES = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4"}


class GlbBuilder:
    """Collects the parts of a GLB; each method that adds something returns its index."""

    def __init__(self) -> None:
        self.json: dict[str, Any] = {"asset": {"version": "2.0", "generator": "toongeo"}}
        self._binary = bytearray()

    def add(self, kind: str, **entry: Any) -> int:
        """Append to one of the document's lists; properties that are None are left out."""
        entries = self.json.setdefault(kind, [])
        entries.append({key: value for key, value in entry.items() if value is not None})
        return len(entries) - 1

    def view(self, content: bytes, target: int | None = None) -> int:
        offset = len(self._binary)
        self._binary += content + bytes(-len(content) % 4)  # every view starts at a multiple of 4
        return self.add("bufferViews", buffer=0, byteOffset=offset, byteLength=len(content), target=target)

    def accessor(self, array: NDArray, target: int | None = None, *, bounds: bool = False) -> int:
        """``array`` is (n,) or (n, columns) of the type it shall have in the file."""
        entry = self._described(array, bounds)
        return self.add("accessors", bufferView=self.view(array.tobytes(), target), **entry)

    def displacement(self, array: NDArray[np.float32], tolerance: float, *, bounds: bool) -> int:
        """(n, 3) of a morph target: only rows beyond ``tolerance`` are stored, where that is smaller."""
        moved = np.flatnonzero((np.abs(array) > tolerance).any(axis=1))
        kept = np.zeros_like(array)
        kept[moved] = array[moved]
        index_type = np.dtype("<u2" if len(array) <= 65536 else "<u4")
        if len(moved) * (index_type.itemsize + 12) >= kept.nbytes:
            return self.accessor(kept, VERTICES, bounds=bounds)
        sparse = None  # an accessor without buffer view is all zero (3.6.2.3)
        if len(moved):
            sparse = {
                "count": len(moved),
                "indices": {
                    "bufferView": self.view(moved.astype(index_type).tobytes()),
                    "componentType": _CODES[index_type],
                },
                "values": {"bufferView": self.view(kept[moved].tobytes())},
            }
        return self.add("accessors", **self._described(kept, bounds), sparse=sparse)

    def encode(self) -> bytes:
        self.json["buffers"] = [{"byteLength": len(self._binary)}]
        text = json.dumps(self.json, separators=(",", ":"), allow_nan=False).encode()
        text += b" " * (-len(text) % 4)
        binary = bytes(self._binary)
        document = struct.pack("<I4s", len(text), b"JSON") + text
        buffer = struct.pack("<I4s", len(binary), b"BIN\0") + binary
        return struct.pack("<4sII", b"glTF", 2, 12 + len(document) + len(buffer)) + document + buffer

    @staticmethod
    def _described(array: NDArray, bounds: bool) -> dict[str, Any]:
        columns = 1 if array.ndim == 1 else array.shape[1]
        entry = {"componentType": _CODES[array.dtype], "count": len(array), "type": _TYPES[columns]}
        if bounds:
            entry["min"] = np.atleast_1d(array.min(axis=0)).tolist()
            entry["max"] = np.atleast_1d(array.max(axis=0)).tolist()
        return entry
