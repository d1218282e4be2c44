"""The Basel Face Models of 2017 and 2019."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from toongeo.model.loaders.files.read_h5 import read_h5
from toongeo.model.morphable_model import MorphableModel
from toongeo.model.supply.eye_frame import EYE_DEPTH_MM
from toongeo.reading.check_file import file_bytes
from toongeo.reading.promise import promise

__all__ = ["load_bfm2017"]

_PARTS = ("mean", "pcaBasis", "pcaVariance")
_SHAPE = tuple(f"shape/model/{part}" for part in _PARTS)
_MORE = tuple(f"{kind}/model/{part}" for kind in ("expression", "color") for part in _PARTS)
_CELLS, _POINTS_OF_INTEREST = "shape/representer/cells", "metadata/landmarks/json"
_TEXTURE = "model2019_textureMapping.json"
_CORNERS = tuple(f"{side}.eye.corner_{end}" for side in ("left", "right") for end in ("outer", "inner"))


def load_bfm2017(path: str | Path, landmarks: NDArray[np.int64] | None = None) -> MorphableModel:
    """``model2017-1_bfm_nomouth.h5``, ``model2017-1_face12_nomouth.h5``, ``model2019_fullHead.h5`` and their like.

    A unit of a mode becomes one standard deviation: the files hold variances. They are in mm and have no iBUG-68 table;
    if their own landmarks name the corners of the eyes, the origin lies behind these. ``model2019_textureMapping.json``
    beside the file gives texture coordinates, if it has one for every vertex: it belongs to the full head.

    Parameters
    ----------
    path : str or Path
    landmarks : (68,) int, optional
        Vertices of the file.

    Raises
    ------
    ImportError
        If h5py is not installed (the extra ``models``).
    ValueError
        If it is none of these, sizes do not fit, numbers are not finite or indices out of range.

    References
    ----------
    T. Gerig et al., "Morphable face models - an open framework", FG 2018.
    """
    path = Path(path)
    z: dict[str, Any] = read_h5(path, (*_SHAPE, _CELLS), (*_MORE, _POINTS_OF_INTEREST))
    with promise(path, "a Basel Face Model of 2017 or 2019", alone=True):
        cells = z[_CELLS]
        faces = cells if cells.ndim == 2 and cells.shape[1] == 3 else cells.T
        mean = _points(z["shape/model/mean"])
        expression = None
        if all(f"expression/model/{part}" in z for part in _PARTS):
            mean = mean + _points(z["expression/model/mean"])
            expression = _modes(z, "expression")
        colours = {}
        if all(f"color/model/{part}" in z for part in _PARTS):
            colours = {"albedo_mean": _points(z["color/model/mean"]), "albedo": _modes(z, "color")}
        return MorphableModel.from_arrays(
            mean,
            np.ascontiguousarray(faces, np.int64),
            identity=_modes(z, "shape"),
            expression=expression,
            landmarks=landmarks,
            **_texture(path.with_name(_TEXTURE), faces, len(mean)),
            origin=None if landmarks is not None else _between_eyes(z.get(_POINTS_OF_INTEREST)),
            **colours,
        )


def _texture(path: Path, faces: NDArray[np.int64], count: int) -> dict[str, NDArray]:
    """Texture coordinates of each of ``count`` vertices, v up, if there is a file that has as many."""
    if not path.is_file():
        return {}
    with promise(path, "the texture mapping of the Basel Face Model", alone=True):
        uv = np.array(json.loads(file_bytes(path))["textureMapping"]["pointData"], np.float64)
        if uv.ndim != 2 or uv.shape[1] != 2:
            raise ValueError(f"expected points (n, 2), got {uv.shape}")
        if len(uv) != count:
            return {}
        return {"uv": uv, "uv_faces": np.ascontiguousarray(faces, np.int64)}


def _points(values: NDArray) -> NDArray[np.float64]:
    return np.asarray(values, np.float64).reshape(-1, 3)


def _modes(z: dict[str, Any], kind: str) -> NDArray[np.float32]:
    """Modes (k, n, 3): orthonormal columns (3 n, k) times the roots of their variances."""
    basis, variance = (np.asarray(z[f"{kind}/model/{part}"]) for part in _PARTS[1:])
    if basis.ndim != 2 or variance.shape != basis.shape[1:] or len(basis) % 3 or not (variance >= 0).all():
        raise ValueError(f"expected a basis (3 n, k) and k variances, got {basis.shape} and {variance.shape}")
    columns = basis.astype(np.float32) * np.sqrt(variance).astype(np.float32)
    return np.ascontiguousarray(columns.T).reshape(len(variance), -1, 3)


def _between_eyes(text: str | None) -> NDArray[np.float64] | None:
    """Behind the middle of the corners of the eyes, if the landmarks of the file have them."""
    if text is None:
        return None
    entries = json.loads(text)
    points = {
        entry["id"]: entry["coordinates"] for entry in entries if isinstance(entry, dict) and "coordinates" in entry
    }
    if not all(name in points for name in _CORNERS):
        return None
    middle = np.mean([np.asarray(points[name], float) for name in _CORNERS], axis=0)
    return np.asarray(middle - [0.0, 0.0, EYE_DEPTH_MM])
