"""Morphable models in the binary files of the eos library, such as the Surrey Face Model."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from toongeo.model.ibug68 import PARTS
from toongeo.model.morphable_model import MorphableModel
from toongeo.model.supply.outline_paths import outline_landmarks, outline_paths
from toongeo.reading.check_file import file_bytes
from toongeo.reading.promise import promise

__all__ = ["load_eos"]

_VERSION = 1
_INNER_MOUTH_CORNERS = {60: 48, 64: 54}  # the published table leaves them out: the outer corners take their place


def load_eos(
    shape: str | Path,
    landmarks: str | Path,
    expression: str | Path | None = None,
    contours: str | Path | None = None,
) -> MorphableModel:
    """A shape model of eos with its table of landmarks and, if given, its expression blendshapes.

    The origin moves midway between the eyes, 13 mm behind the middle of their corners, because these models have
    no eyeballs. Units (mm) and axes are ours already. A unit of an identity mode is one standard deviation, the
    blendshapes range in [0, 1]. Jaw points that the table does not have get vertices on
    the outline of the mean as seen from in front; from there they slide along paths over its sides.

    Parameters
    ----------
    shape : str or Path
        ``sfm_shape_3448.bin`` or another model without colour, as cereal writes it (little endian).
    landmarks : str or Path
        ``ibug_to_sfm.txt``: lines ``number = vertex`` under ``[landmark_mappings]``, numbers from 1.
    expression : str or Path, optional
        ``expression_blendshapes_3448.bin``.
    contours : str or Path, optional
        ``sfm_model_contours.json``: vertices of the right and the left outline, on which eos looks for the nearest.
        They are regions here, ``contour_right`` and ``contour_left``.

    Returns
    -------
    MorphableModel

    Raises
    ------
    ValueError
        If a file is not of this kind, or the table misses a point that is needed.

    References
    ----------
    P. Huber et al., "A multiresolution 3D morphable face model and fitting framework", VISAPP 2016.

    Examples
    --------
    >>> import toongeo as tg
    >>> tg.load_eos("sfm_shape_3448.bin", "ibug_to_sfm.txt")  # doctest: +SKIP
    >>> from pathlib import Path
    >>> size = Path("other.bin").write_bytes(bytes(3))
    >>> tg.load_eos("other.bin", "other.txt")
    Traceback (most recent call last):
    ...
    ValueError: other.bin: expected a binary file of eos, it ends at byte 3
    """
    with promise(Path(shape), "a shape model of eos", "shape", alone=True):
        mean, modes, faces, uv = _shape_model(_Reader(Path(shape)))
    with promise(Path(landmarks), "a table of landmarks of eos", "landmarks", alone=True):
        table = _landmark_table(Path(landmarks), len(mean))
    blendshapes: dict[str, NDArray[np.float32]] = {}
    if expression is not None:
        with promise(Path(expression), "blendshapes of eos", "expression", alone=True):
            blendshapes = _blendshapes(_Reader(Path(expression)), len(mean))
    regions = {}
    if contours is not None:
        with promise(Path(contours), "contours of eos", "contours", alone=True):
            regions = _contours(Path(contours), len(mean))
    with promise(Path(shape), "a shape model of eos", "shape", alone=True):
        points = np.zeros(68, np.int64)
        points[list(table)] = list(table.values())
        uv_parts = {"uv": uv, "uv_faces": faces} if len(uv) else {}
        model = MorphableModel.from_arrays(
            mean,
            faces,
            identity=modes,
            expression=np.array(list(blendshapes.values()), np.float32).reshape(-1, len(mean), 3),
            expression_names=list(blendshapes),
            landmarks=points,
            regions=regions,
            **uv_parts,
        )
        missing = [k for k in PARTS["jaw"] if k not in table]
        points[missing] = outline_landmarks(model, points)[missing]
        return replace(model, landmarks=points, contour_lines=outline_paths(model, points))


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
    if mean.size % 3 or basis.shape != (mean.size, eigenvalues.size) or not (eigenvalues >= 0).all():
        raise ValueError(f"{reader.path}: expected a basis (3 n, k) with k eigenvalues, got {basis.shape}")
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
        if name in shapes:
            raise ValueError(f"expression: expected each name once, got {name!r} again")
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


def _contours(path: Path, n: int) -> dict[str, NDArray[np.bool_]]:
    """Masks (n,) of the outlines."""
    found = json.loads(path.read_text(encoding="utf-8"))["model_contour"]
    regions = {}
    for side in ("right", "left"):
        vertices = np.array(found[f"{side}_contour"], np.int64)
        if vertices.ndim != 1 or not len(vertices) or not 0 <= vertices.min() <= vertices.max() < n:
            raise ValueError(f"contours: expected vertices below {n} in {path}")
        regions[f"contour_{side}"] = np.bincount(vertices, minlength=n) > 0
    return regions
