"""A morphable model from arrays of any unit, checked."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toongeo.model.ibug68 import OUTER_EYES
from toongeo.model.morphable_model import MorphableModel
from toongeo.model.supply.eye_frame import eye_origin
from toongeo.model.supply.named_parts import named_parts
from toongeo.model.supply.outward import outward

__all__ = ["from_arrays"]

_MOST_VERTICES = 10**7  # of any mesh that a head can be; more is a damaged count
_EYES_MM = 90.0  # between the outer corners of people's eyes
_HEAD_MM = 230.0  # of a head, chin to crown
_FARTHEST_MM = 1e5  # from the origin: a model of a head whose numbers are not broken


def from_arrays(
    mean: ArrayLike,
    faces: ArrayLike,
    *,
    identity: ArrayLike | None = None,
    landmarks: ArrayLike | None = None,
    expression: ArrayLike | None = None,
    expression_names: Sequence[str] = (),
    n_named: int | None = None,
    unit: float | Literal["auto"] = 1.0,
    origin: ArrayLike | None = None,
    **parts: Any,
) -> MorphableModel:
    """See :meth:`toongeo.MorphableModel.from_arrays`."""
    V = _numbers(mean, "mean", (None, 3))
    n = len(V)
    if not 3 <= n <= _MOST_VERTICES:
        raise ValueError(f"mean: expected 3 to {_MOST_VERTICES} vertices, got {n}")
    F = _indices(faces, "faces", n, width=3)
    table = np.zeros(0, np.int64) if landmarks is None else _indices(landmarks, "landmarks", n).ravel()
    if table.size not in (0, 68):
        raise ValueError(f"landmarks: expected 68 vertices (iBUG-68) or none, got {table.size}")
    scale = _scale(V, table) if unit == "auto" else float(unit)
    if not 0 < scale < np.inf:
        raise ValueError(f"unit: expected millimetres a unit, > 0, got {unit}")
    centre = _numbers(origin, "origin", (3,)) if origin is not None else eye_origin(V, table, scale)
    house = scale * (V - centre)
    if np.abs(house).max() > _FARTHEST_MM:
        raise ValueError(f"mean: expected a head in mm, got one that reaches {np.abs(house).max():.3g} mm")
    shapes, names = _modes(expression, "expression", n, scale), tuple(str(name) for name in expression_names)
    if len(names) > len(shapes):
        raise ValueError(f"expression_names: expected at most {len(shapes)} names, got {len(names)}")
    named = len(names) if n_named is None else int(n_named)
    if not 0 <= named <= len(names):
        raise ValueError(f"n_named: expected 0 to {len(names)}, got {named}")
    if len(set(names)) < len(names):
        raise ValueError("expression_names: expected each name once")
    regions = _regions(parts.pop("regions", {}), n)
    found = {**(named_parts(house, table) if table.size else {}), **regions}
    return MorphableModel(
        mean=house,
        faces=outward(house, F),
        identity=_modes(identity, "identity", n, scale),
        landmarks=table,
        expression=shapes,
        expression_names=(*names, *(f"extra{i + 1:02d}" for i in range(len(shapes) - len(names)))),
        n_named=named,
        regions=found,
        **_checked_parts(parts, house, F),
    )


def _scale(V: NDArray[np.float64], landmarks: NDArray[np.int64]) -> float:
    """The power of ten that makes a head as large as people's: files are in m, dm, cm, mm or micrometres."""
    size, wanted = float(np.ptp(V[:, 1])), _HEAD_MM
    if landmarks.size:
        size, wanted = float(np.linalg.norm(np.subtract(*V[landmarks[list(OUTER_EYES)]]))), _EYES_MM
    if not size > 0:
        raise ValueError("mean: expected a face, got points at one place")
    return float(10.0 ** np.round(np.log10(wanted / size)))


def _numbers(values: ArrayLike, name: str, shape: tuple[int | None, ...]) -> NDArray[np.float64]:
    array = np.asarray(values)
    fits = array.ndim == len(shape) and all(b in (None, a) for a, b in zip(array.shape, shape, strict=True))
    if not fits or array.dtype.kind not in "biuf":
        raise ValueError(f"{name}: expected numbers of shape {shape}, got {array.dtype} of shape {array.shape}")
    array = array.astype(np.float64)
    if not np.isfinite(array).all():
        raise ValueError(f"{name}: expected finite numbers, got NaN or infinity")
    return array


def _indices(values: ArrayLike, name: str, n: int, width: int | None = None) -> NDArray[np.int64]:
    array = np.asarray(values)
    if array.dtype.kind not in "iu" or (width is not None and (array.ndim != 2 or array.shape[1] != width)):
        wanted = f"(m, {width}) " if width is not None else ""
        raise ValueError(f"{name}: expected {wanted}whole numbers, got {array.dtype} of shape {array.shape}")
    array = np.ascontiguousarray(array, np.int64)
    if array.size and not 0 <= array.min() <= array.max() < n:
        raise ValueError(f"{name}: expected vertices in 0..{n - 1}, got {array.min()} to {array.max()}")
    if width is not None and not len(array):
        raise ValueError(f"{name}: expected at least one, got none")
    return array


def _modes(values: ArrayLike | None, name: str, n: int, scale: float = 1.0) -> NDArray[np.float32]:
    """Modes (k, n, 3) float32, their unit scaled."""
    if values is None:
        return np.zeros((0, n, 3), np.float32)
    array = np.asarray(values)
    if array.ndim != 3 or array.shape[1:] != (n, 3) or array.dtype.kind not in "biuf":
        raise ValueError(f"{name}: expected modes (k, {n}, 3), got {array.dtype} of shape {array.shape}")
    modes = np.ascontiguousarray(array, np.float32)
    modes = modes if scale == 1.0 else modes * np.float32(scale)
    if not np.isfinite(modes).all():
        raise ValueError(f"{name}: expected finite numbers, got NaN or infinity")
    return modes


def _regions(regions: Mapping[str, ArrayLike], n: int) -> dict[str, NDArray[np.bool_]]:
    found = {str(name): np.asarray(mask) for name, mask in regions.items()}
    for name, mask in found.items():
        if mask.shape != (n,) or mask.dtype != np.bool_:
            raise ValueError(f"regions: expected masks ({n},) bool, got {mask.dtype} {mask.shape} for {name!r}")
    return found


def _checked_parts(parts: dict[str, Any], mean: NDArray[np.float64], F: NDArray[np.int64]) -> dict[str, Any]:
    """Everything that a model may have or not."""
    n, checked = len(mean), dict(parts)
    if parts.get("albedo_mean") is not None:
        checked["albedo_mean"] = np.clip(_numbers(parts["albedo_mean"], "albedo_mean", (n, 3)), 0, 1).astype(np.float32)
    if parts.get("albedo") is not None:
        checked["albedo"] = _modes(parts["albedo"], "albedo", n)
    if parts.get("quads") is not None:
        checked["quads"] = _indices(parts["quads"], "quads", n).reshape(-1, 4)
    if parts.get("mirror") is not None and _indices(parts["mirror"], "mirror", n).shape != (n,):
        raise ValueError(f"mirror: expected ({n},) vertices, got {np.shape(parts['mirror'])}")
    if parts.get("uv") is not None:
        checked["uv"] = uv = _numbers(parts["uv"], "uv", (None, 2))
        checked["uv_faces"] = corners = _indices(parts.get("uv_faces", F), "uv_faces", len(uv), width=3)
        if corners.shape != F.shape:
            raise ValueError(f"uv_faces: expected shape {F.shape} like faces, got {corners.shape}")
        checked["uv_faces"] = corners if (outward(mean, F) == F).all() else corners[:, ::-1].copy()
    if parts.get("contour_lines"):
        checked["contour_lines"] = tuple(_indices(line, "contour_lines", n) for line in parts["contour_lines"])
        if len(checked["contour_lines"]) != 17 or not all(line.size for line in checked["contour_lines"]):
            raise ValueError(f"contour_lines: expected 17 with vertices, got {len(checked['contour_lines'])}")
    return {name: value for name, value in checked.items() if value is not None}
