"""What an avatar knows beyond what a GLB can show, as bytes: nested dataclasses of the library, and their arrays."""

from __future__ import annotations

import json
import math
import zlib
from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np

from toongeo.avatar.field_types import check_field_types
from toongeo.avatar.report import AvatarReport
from toongeo.metrics import MeshQuality
from toongeo.model import EyeballTemplate, MorphableModel
from toongeo.model.model_checksum import model_checksum
from toongeo.pipeline import AlignedFace, AlignReport, Eyes, FaceFit, LandmarkNoise, Rig, RigReport
from toongeo.pipeline.fit.face_fit import FitReport, PhotometricReport
from toongeo.protocols import FaceParse, HairMask
from toongeo.render import PerspectiveCamera, ScaledOrthographicCamera

__all__ = ["decode_state", "encode_state"]

_TIMES = "seconds"  # what a run took is not kept: one input gives one file, bit for bit
_CLASSES: dict[str, Any] = {
    kind.__name__: kind
    for kind in (
        AlignReport,
        AlignedFace,
        AvatarReport,
        EyeballTemplate,
        Eyes,
        FaceFit,
        FaceParse,
        FitReport,
        HairMask,
        LandmarkNoise,
        MeshQuality,
        PerspectiveCamera,
        PhotometricReport,
        Rig,
        RigReport,
        ScaledOrthographicCamera,
    )
}
# Fields that came later are left out where they are None: a file without them is as it was before.
_LATER = ("hair", "noise", "mouth_opens")
_VERSION = 1
_MOST_BYTES = 1 << 30  # that a file may ask for


def encode_state(state: Mapping[str, Any], known: Mapping[str, np.ndarray], model: MorphableModel) -> bytes:
    """Compressed bytes of named values; nothing of them is ever executed when they are read.

    Parameters
    ----------
    state : name -> value
        Numbers, texts, None, arrays, tuples, lists, mappings by text, and the dataclasses ``_CLASSES``, nested.
    known : name -> array
        Arrays that the reader will have from elsewhere; one that is equal is not stored.
    model : MorphableModel
        Not stored either, only its checksum.

    Raises
    ------
    ValueError
        If a value is of another kind (says where).
    """
    writer = _Writer(known, model)
    tree = {name: writer.node(value, name) for name, value in state.items()}
    head = {"version": _VERSION, "model": model_checksum(model), "state": tree, "arrays": writer.described()}
    text = json.dumps(head, separators=(",", ":")).encode()
    content = len(text).to_bytes(8, "little") + text + b"".join(map(_packed, writer.arrays))
    return len(content).to_bytes(8, "little") + zlib.compress(content, 6)


def decode_state(content: bytes, known: Mapping[str, np.ndarray], model: MorphableModel) -> dict[str, Any]:
    """Inverse of :func:`encode_state`.

    Raises
    ------
    ValueError
        If the bytes are none of ours, or the model is another than that of the avatar.
    """
    try:
        size = int.from_bytes(content[:8], "little")
        if not 8 <= size <= _MOST_BYTES:
            raise ValueError(f"it announces {size} bytes")
        # Never more than announced, whatever the compressed bytes would grow to.
        data = zlib.decompressobj().decompress(content[8:], size)
        start = 8 + int.from_bytes(data[:8], "little")
        head = json.loads(data[8:start])
        if len(data) != size or head["version"] != _VERSION:
            raise ValueError(f"it is of version {head['version']} and has {len(data)} bytes of {size}")
        same_model = head["model"] == model_checksum(model)
        arrays = _arrays(memoryview(data)[start:], head["arrays"])
        if same_model:
            reader = _Reader(known, model, arrays)
            return {name: reader.value(node) for name, node in head["state"].items()}
    except (zlib.error, LookupError, TypeError, AttributeError, ArithmeticError, RecursionError, ValueError) as error:
        reason = f"{type(error).__name__}: {error}"[:200]
        raise ValueError(f"content: expected the state of an avatar, got other bytes ({reason})") from error
    raise ValueError("model: expected the model with which the avatar was made, got another")


class _Writer:
    """Values as JSON; arrays are collected."""

    def __init__(self, known: Mapping[str, np.ndarray], model: MorphableModel) -> None:
        self.known, self.model = known, model
        self.arrays: list[np.ndarray] = []

    def node(self, value: Any, where: str) -> Any:
        if isinstance(value, float) and _TIMES in where.split("."):
            return 0.0
        if value is None or isinstance(value, bool | int | float | str):
            return value
        if isinstance(value, np.generic):
            return self.node(value.item(), where)
        if isinstance(value, np.ndarray):
            return self._array(value, where)
        if isinstance(value, tuple | list):
            return {"tuple" if isinstance(value, tuple) else "list": [self.node(v, where) for v in value]}
        if isinstance(value, Mapping) and all(isinstance(key, str) for key in value):
            return {"mapping": {key: self.node(v, f"{where}.{key}") for key, v in value.items()}}
        if value is self.model:
            return {"model": None}
        for side, eye in enumerate(self.model.eyes):
            if value is eye:
                return {"eye": side}
        if is_dataclass(value) and type(value) is _CLASSES.get(type(value).__name__):
            parts = {field.name: getattr(value, field.name) for field in fields(value) if field.init}
            parts = {name: v for name, v in parts.items() if v is not None or name not in _LATER}
            return {type(value).__name__: {name: self.node(v, f"{where}.{name}") for name, v in parts.items()}}
        kinds = f"numbers, texts, arrays or {', '.join(_CLASSES)}"
        raise ValueError(f"{where}: expected {kinds} in a loadable file, got {type(value)}")

    def _array(self, value: np.ndarray, where: str) -> dict[str, Any]:
        if value.dtype.kind not in "biuf":
            raise ValueError(f"{where}: expected an array of numbers, got {value.dtype}")
        for name, array in self.known.items():
            if array.dtype == value.dtype and np.array_equal(array, value):
                return {"known": name}
        self.arrays.append(value.astype(value.dtype.newbyteorder("<")))
        return {"array": len(self.arrays) - 1}

    def described(self) -> list[list[Any]]:
        return [[array.dtype.str, list(array.shape)] for array in self.arrays]


class _Reader:
    """Inverse of the writer."""

    def __init__(self, known: Mapping[str, np.ndarray], model: MorphableModel, arrays: list[np.ndarray]) -> None:
        self.known, self.model, self.arrays = known, model, arrays

    def value(self, node: Any) -> Any:
        if not isinstance(node, dict):
            return node
        ((kind, content),) = node.items()
        if kind in ("tuple", "list"):
            return (tuple if kind == "tuple" else list)(self.value(part) for part in content)
        if kind == "mapping":
            return {key: self.value(part) for key, part in content.items()}
        simple: dict[str, Any] = {"array": self.arrays, "known": self.known, "eye": self.model.eyes}
        if kind in simple:
            return simple[kind][content]
        if kind == "model":
            return self.model
        instance = _CLASSES[kind](**{name: self.value(part) for name, part in content.items()})
        check_field_types(instance)
        return instance


def _packed(array: np.ndarray) -> bytes:
    """Bytes of an array so that they shrink well: the first of every number, then the second and so on.

    Of tables and pictures, what each number's bits differ by from what its neighbours left and above let expect.
    """
    bits = np.ascontiguousarray(array).view(f"<u{array.itemsize}")
    if bits.ndim == 2:
        bits = bits.copy()
        bits[:, 1:] -= bits[:, :-1].copy()
        bits[1:] -= bits[:-1].copy()
    return bits.reshape(-1).view(np.uint8).reshape(-1, array.itemsize).T.tobytes()


def _unpacked(part: memoryview, dtype: np.dtype, shape: list[int]) -> np.ndarray:
    """Inverse of :func:`_packed`."""
    rows = np.frombuffer(part, np.uint8).reshape(dtype.itemsize, math.prod(shape))
    bits = np.ascontiguousarray(rows.T).reshape(-1).view(f"<u{dtype.itemsize}").reshape(shape)
    if bits.ndim == 2:
        bits = np.cumsum(np.cumsum(bits, axis=0, dtype=bits.dtype), axis=1, dtype=bits.dtype)
    return bits.view(dtype)


def _arrays(data: memoryview, described: list[list[Any]]) -> list[np.ndarray]:
    arrays, offset = [], 0
    for kind, shape in described:
        dtype = np.dtype(kind)
        if dtype.kind not in "biuf" or not all(isinstance(side, int) and side >= 0 for side in shape):
            raise ValueError(f"an array is of {dtype} {shape}")
        size = math.prod(shape) * dtype.itemsize
        arrays.append(_unpacked(data[offset : offset + size], dtype, shape))
        offset += size
    if offset != len(data):
        raise ValueError(f"its arrays take {offset} bytes of {len(data)}")
    return arrays
