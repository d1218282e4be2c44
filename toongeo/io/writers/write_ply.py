"""A mesh with colours and texture coordinates at its vertices."""

import os

import numpy as np
from numpy.typing import ArrayLike

from toongeo.io.atomic_write import atomic_write

__all__ = ["write_ply"]


def write_ply(
    path: str | os.PathLike[str],
    V: ArrayLike,
    F: ArrayLike,
    colors: ArrayLike | None = None,
    uv: ArrayLike | None = None,
) -> None:
    """Write a binary little-endian ``.ply``; atomically.

    Parameters
    ----------
    path
        File to write.
    V
        (n, 3) mm, stored as float32 in the same order.
    F
        (m, 3) into ``V``.
    colors
        (n, 3) uint8 sRGB, stored as ``red``, ``green``, ``blue``.
    uv
        (n, 2), origin bottom-left, stored as ``s`` and ``t``; a format with one uv a vertex, so split the seams
        (:func:`split_seams`) first.

    Raises
    ------
    ValueError
        If shapes, types or indices do not fit.
    OSError
        If the path cannot be written; nothing half-written remains.

    Examples
    --------
    >>> import tempfile, pathlib
    >>> path = pathlib.Path(tempfile.mkdtemp()) / "t.ply"
    >>> write_ply(path, np.eye(3), [[0, 1, 2]])
    >>> path.read_bytes()[:3]
    b'ply'
    """
    V, F = np.asarray(V), np.asarray(F)
    if V.ndim != 2 or V.shape[1] != 3 or not np.isfinite(V).all():
        raise ValueError(f"V: expected finite (n, 3), got shape {V.shape}")
    if F.ndim != 2 or F.shape[1] != 3 or F.dtype.kind not in "iu":
        raise ValueError(f"F: expected (m, 3) integers, got {F.dtype} {F.shape}")
    if F.size and (F.min() < 0 or F.max() >= len(V)):
        raise ValueError(f"F: expected indices in 0..{len(V) - 1}, got {F.min()}..{F.max()}")
    fields = [("position", "<f4", 3)]
    header = ["ply", "format binary_little_endian 1.0", "comment mm", f"element vertex {len(V)}"]
    header += [f"property float {axis}" for axis in "xyz"]
    if colors is not None:
        colors = np.asarray(colors)
        if colors.shape != V.shape or colors.dtype != np.uint8:
            raise ValueError(f"colors: expected uint8 {V.shape}, got {colors.dtype} {colors.shape}")
        fields.append(("color", "u1", 3))
        header += [f"property uchar {channel}" for channel in ("red", "green", "blue")]
    if uv is not None:
        uv = np.asarray(uv)
        if uv.shape != (len(V), 2) or uv.dtype.kind != "f" or not np.isfinite(uv).all():
            raise ValueError(f"uv: expected finite ({len(V)}, 2), got {uv.dtype} {uv.shape}")
        fields.append(("uv", "<f4", 2))
        header += [f"property float {axis}" for axis in "st"]
    vertices = np.zeros(len(V), fields)
    vertices["position"] = V
    if colors is not None:
        vertices["color"] = colors
    if uv is not None:
        vertices["uv"] = uv
    faces = np.zeros(len(F), [("count", "u1"), ("corners", "<i4", 3)])
    faces["count"], faces["corners"] = 3, F
    header += [f"element face {len(F)}", "property list uchar int vertex_indices", "end_header", ""]
    atomic_write({path: "\n".join(header).encode() + vertices.tobytes() + faces.tobytes()})
