"""Files beside a model that say which of its vertices are the 68 landmarks."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from toongeo.io import read_mesh_landmarks
from toongeo.model.ibug68 import PARTS
from toongeo.model.loaders.files.read_pickle import plain, unpickled
from toongeo.model.morphable_model import MorphableModel
from toongeo.model.supply.outline_paths import outline_landmarks
from toongeo.reading.check_file import file_bytes
from toongeo.reading.promise import promise
from toongeo.reading.read_npz import read_npz

__all__ = ["read_landmark_vertices", "with_landmark_file"]

_TRIANGLES = (  # names of triangle numbers and barycentric coordinates in the tables of FLAME
    ("full_lmk_faces_idx", "full_lmk_bary_coords"),
    ("static_lmk_faces_idx", "static_lmk_bary_coords"),
    ("lmk_face_idx", "lmk_b_coords"),
)
_INNER = len(range(17, 68))


def with_landmark_file(model: MorphableModel, path: Path) -> MorphableModel:
    """A model with the landmarks of a file: see :func:`read_landmark_vertices`; contour lines are found if it has none.

    Raises
    ------
    ValueError
        As :func:`read_landmark_vertices`.
    """
    return model.with_landmarks(read_landmark_vertices(path, model))


def read_landmark_vertices(path: Path, model: MorphableModel) -> NDArray[np.int64]:
    """Vertices (68,) of a file of landmarks.

    Parameters
    ----------
    path : Path
        ``.json .txt .csv .pp .ljson``: vertices or points, as :func:`toongeo.io.read_mesh_landmarks` takes them, in the
        frame of the model. ``.npz``: ``vertices`` (68,), or ``indices`` and ``weights`` (68, 3) as of GNM. ``.npz``,
        ``.npy`` or ``.pkl``: triangles and barycentric coordinates of FLAME; with 51 of them (without the jaw) the jaw
        points lie on the outline of the mean.
    model : MorphableModel

    Raises
    ------
    ValueError
        If it is none of these, or holds other than 51 or 68 landmarks of the model.
    """
    with promise(path, "a table of 68 landmarks", "landmarks", alone=True):
        if path.suffix in (".json", ".txt", ".csv", ".pp", ".ljson"):
            points = read_mesh_landmarks(path, model.mean)
            if not np.isfinite(points).all():
                raise ValueError("some of the 68 landmarks are missing")
            return _nearest(points, model)
        table = _table(path)
        if "vertices" in table:
            return np.asarray(table["vertices"]).astype(np.int64)
        corners, weights = _embedded(table, model)
        points = (model.mean[corners] * weights[:, :, None]).sum(axis=1)
        vertices = _nearest(points, model)
        if len(vertices) == 68:
            return vertices
        full = np.zeros(68, np.int64)
        full[17:] = vertices
        full[PARTS["jaw"]] = outline_landmarks(model, full)
        return full


def _nearest(points: NDArray[np.float64], model: MorphableModel) -> NDArray[np.int64]:
    return np.array([((model.mean - point) ** 2).sum(axis=1).argmin() for point in points])


def _table(path: Path) -> dict[str, Any]:
    if path.suffix == ".npz":
        return read_npz(path, expected="a table of 68 landmarks", argument="landmarks")
    content = file_bytes(path)
    if path.suffix == ".npy":  # an array of one object: behind its header stands a pickle
        length = int.from_bytes(content[8:10], "little")
        content = content[10 + length :]
    found = plain(unpickled(content))
    while isinstance(found, list | np.ndarray) and len(found) == 1:
        found = found[0]
    if not isinstance(found, dict):
        raise ValueError("it holds no dictionary of arrays")
    return found


def _embedded(table: dict[str, Any], model: MorphableModel) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """Corners (k, 3) and weights (k, 3) of landmarks."""
    if "indices" in table and "weights" in table:
        corners = np.asarray(table["indices"]).astype(np.int64).reshape(-1, 3)
        weights = np.asarray(table["weights"], np.float64).reshape(-1, 3)
    else:
        for triangles, bary in _TRIANGLES:
            if triangles in table and bary in table:
                numbers = np.asarray(table[triangles]).astype(np.int64).ravel()
                if len(numbers) and not 0 <= numbers.min() <= numbers.max() < len(model.faces):
                    raise ValueError(f"triangles are {numbers.min()} to {numbers.max()} of {len(model.faces)}")
                corners, weights = model.faces[numbers], np.asarray(table[bary], np.float64).reshape(-1, 3)
                break
        else:
            raise ValueError(f"it holds {', '.join(table) or 'nothing'}, no triangles or vertices")
    if len(corners) not in (_INNER, 68) or len(weights) != len(corners) or not np.isfinite(weights).all():
        raise ValueError(f"it holds {len(corners)} landmarks and {len(weights)} weights, not 51 or 68")
    if not 0 <= corners.min() <= corners.max() < len(model.mean):
        raise ValueError(f"vertices are {corners.min()} to {corners.max()} of {len(model.mean)}")
    return corners, weights
