"""Morphable models in the binary files of the eos library, such as the Surrey Face Model."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from toongeo.model.ibug68 import PARTS
from toongeo.model.loaders.foreign_model import named_parts
from toongeo.model.morphable_model import MorphableModel
from toongeo.reading.check_file import file_bytes
from toongeo.reading.promise import promised

__all__ = ["load_eos"]

_VERSION = 1
_EYE_DEPTH_MM = 13.0  # from the corners of an eye back to its centre
_INNER_MOUTH_CORNERS = {60: 48, 64: 54}  # the published table leaves them out: the outer corners take their place


@promised("a binary file of eos", argument="shape")
def load_eos(shape: str | Path, landmarks: str | Path, expression: str | Path | None = None) -> MorphableModel:
    """A shape model of eos with its table of landmarks and, if given, its expression blendshapes.

    The origin moves midway between the eyes, 13 mm behind the middle of their corners, because these models have
    no eyeballs. Units (mm) and axes are ours already. A unit of an identity mode is one standard deviation, the
    blendshapes range in [0, 1]. Jaw points that the table does not have get vertices on
    the outline of the mean as seen from in front; they do not slide.

    Parameters
    ----------
    shape : str or Path
        ``sfm_shape_3448.bin`` or another model without colour, as cereal writes it (little endian).
    landmarks : str or Path
        ``ibug_to_sfm.txt``: lines ``number = vertex`` under ``[landmark_mappings]``, numbers from 1.
    expression : str or Path, optional
        ``expression_blendshapes_3448.bin``.

    Raises
    ------
    ValueError
        If a file is not of this kind, or the table misses a point that is needed.

    References
    ----------
    P. Huber et al., "A multiresolution 3D morphable face model and fitting framework", VISAPP 2016.
    """
    mean, modes, faces, uv = _shape_model(_Reader(Path(shape)))
    table = _landmark_table(Path(landmarks), len(mean))
    blendshapes = _blendshapes(_Reader(Path(expression)), len(mean)) if expression is not None else {}
    corners = mean[[table[k] for k in (36, 39, 42, 45)]]
    mean = mean - (corners.mean(axis=0) - [0.0, 0.0, _EYE_DEPTH_MM])
    points = _jaw(mean, table)
    return MorphableModel(
        mean=mean,
        faces=faces,
        identity=modes,
        expression=np.array(list(blendshapes.values()), np.float32).reshape(-1, len(mean), 3),
        expression_names=tuple(blendshapes),
        n_named=len(blendshapes),
        landmarks=points,
        regions=named_parts(mean, points),
        uv=uv,
        uv_faces=faces,
    )


class _Reader:
    """Little-endian numbers, one after the other."""

    def __init__(self, path: Path) -> None:
        self.path, self.data, self.offset = path, file_bytes(path, argument="shape"), 0

    def take(self, dtype: str, count: int) -> NDArray:
        size = count * np.dtype(dtype).itemsize
        if count < 0 or self.offset + size > len(self.data):
            raise ValueError(f"{self.path}: expected a binary file of eos, it ends at byte {len(self.data)}")
        values = np.frombuffer(self.data, dtype, count, self.offset)
        self.offset += size
        return values

    def number(self, dtype: str) -> int:
        return int(self.take(dtype, 1)[0])

    def matrix(self) -> NDArray[np.float32]:
        rows, columns = (int(n) for n in self.take("<i4", 2))
        if min(rows, columns) < 0:
            raise ValueError(f"{self.path}: expected a binary file of eos, got a matrix of {rows} x {columns}")
        return self.take("<f4", rows * columns).reshape(columns, rows).T

    def pca(self) -> tuple[NDArray[np.float32], NDArray[np.float32], NDArray[np.float32], NDArray[np.int32]]:
        """Mean, orthonormal basis, eigenvalues, triangles."""
        mean, basis, eigenvalues = self.matrix(), self.matrix(), self.matrix()
        return mean, basis, eigenvalues, self.take("<i4", 3 * self.number("<u8")).reshape(-1, 3)


def _shape_model(
    reader: _Reader,
) -> tuple[NDArray[np.float64], NDArray[np.float32], NDArray[np.int64], NDArray[np.float64]]:
    """Mean (n, 3), modes (k, n, 3), faces and texture coordinates, origin bottom left."""
    version = reader.number("<u4")
    if version != _VERSION:
        raise ValueError(f"{reader.path}: expected version {_VERSION} of an eos model, got {version}")
    mean, basis, eigenvalues, faces = reader.pca()
    reader.pca()  # the colour, empty in a shape model
    uv = reader.take("<f8", 2 * reader.number("<u8")).reshape(-1, 2)
    modes = (basis * np.sqrt(eigenvalues.ravel())).T.reshape(eigenvalues.size, -1, 3)
    return (
        mean.reshape(-1, 3).astype(float),
        np.ascontiguousarray(modes),
        faces.astype(np.int64),
        np.c_[uv[:, 0], 1 - uv[:, 1]],
    )


def _blendshapes(reader: _Reader, n: int) -> dict[str, NDArray[np.float32]]:
    shapes = {}
    for _ in range(reader.number("<u8")):
        name = reader.take("u1", reader.number("<u8")).tobytes().decode()
        shapes[name] = reader.matrix()
        if shapes[name].size != 3 * n:
            raise ValueError(f"expression: expected {n} vertices like the shape, got {shapes[name].size // 3}")
    return shapes


def _landmark_table(path: Path, n: int) -> dict[int, int]:
    """Vertex of each point that the table has, by its number from 0."""
    mappings = path.read_text(encoding="utf-8").split("[landmark_mappings]")[-1].split("[contour_landmarks]")[0]
    rows = re.findall(r"^\s*(\d+)\s*=\s*(\d+)", mappings, re.MULTILINE)
    table = {int(number) - 1: int(vertex) for number, vertex in rows}
    for point, stand_in in _INNER_MOUTH_CORNERS.items():
        if stand_in in table:
            table.setdefault(point, table[stand_in])
    needed = {8, *range(17, 68)}
    if not needed <= set(table) or max(table.values()) >= n:
        raise ValueError(f"landmarks: expected points 9 and 18-68 with vertices below {n} in {path}, got {len(table)}")
    return table


def _jaw(mean: NDArray[np.float64], table: dict[int, int]) -> NDArray[np.int64]:
    """The 68 vertices; jaw points on an arc from the height of the eyes round the chin.

    The arc is the outline of the mean as the camera in front sees it: in 17 directions from the bridge of the nose,
    at equal angles from eye to chin, the vertex that is farthest away in the picture.
    """
    missing = np.array([k for k in PARTS["jaw"] if k not in table])
    centre = mean[[table[k] for k in range(27, 31)]].mean(axis=0)
    away = (mean - centre)[:, :2]
    angle, radius = np.arctan2(away[:, 1], away[:, 0]), np.hypot(*away.T)
    points = np.zeros(68, np.int64)
    points[list(table)] = list(table.values())
    for k in missing:
        direction = -np.pi + k * np.pi / 16  # point 0 on the subject's right, 8 straight below
        near = np.abs((angle - direction + np.pi) % (2 * np.pi) - np.pi) < np.radians(4)
        points[k] = np.flatnonzero(near)[np.argmax(radius[near])]
    return points
