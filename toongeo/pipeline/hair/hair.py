"""The hair of an avatar."""

from dataclasses import dataclass

import numpy as np

from toongeo._brief_repr import brief_repr
from toongeo._read_only import read_only, restored

__all__ = ["Hair"]


@dataclass(frozen=True, eq=False)
class Hair:
    """A closed mesh over the scalp, rigid on the head.

    Attributes
    ----------
    vertices : (n, 3) float64, mm, model frame
        Each is a number of float32, so that a file holds it exactly.
    faces : (m, 3) int64
        Counter-clockwise from outside.
    uv : (t, 2) float64
        Origin bottom left.
    uv_faces : (m, 3) int64
        Corners of the faces in ``uv``.
    texture : (H, W, 3) uint8 RGB

    Raises
    ------
    ValueError
        If shapes do not fit, an index is out of range, or a number is not finite.

    Examples
    --------
    >>> import numpy as np
    >>> import toongeo as tg
    >>> vertices = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], dtype=float)
    >>> faces = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])  # a tuft
    >>> hair = tg.Hair(vertices, faces, vertices[:, :2], faces, np.zeros((8, 8, 3), dtype=np.uint8))
    >>> hair.faces.shape
    (4, 3)
    """

    vertices: np.ndarray
    faces: np.ndarray
    uv: np.ndarray
    uv_faces: np.ndarray
    texture: np.ndarray

    __repr__ = brief_repr
    __setstate__ = restored

    def __post_init__(self) -> None:
        for name, rows, columns in (("vertices", self.vertices, 3), ("uv", self.uv, 2)):
            if rows.ndim != 2 or rows.shape[1] != columns or not np.isfinite(rows).all():
                raise ValueError(f"{name}: expected finite numbers (n, {columns}), got shape {rows.shape}")
        for name, corners, count in (
            ("faces", self.faces, len(self.vertices)),
            ("uv_faces", self.uv_faces, len(self.uv)),
        ):
            if corners.shape != (len(self.faces), 3) or corners.min(initial=0) < 0 or corners.max(initial=-1) >= count:
                raise ValueError(f"{name}: expected indices ({len(self.faces)}, 3) below {count}, got {corners.shape}")
        if self.texture.ndim != 3 or self.texture.shape[2] != 3 or self.texture.dtype != np.uint8:
            raise ValueError(f"texture: expected (H, W, 3) uint8, got {self.texture.dtype} {self.texture.shape}")
        read_only(self, "vertices", "faces", "uv", "uv_faces", "texture")
