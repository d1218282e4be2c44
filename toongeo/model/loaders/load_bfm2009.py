"""The Basel Face Model of 2009, and what others made of it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from toongeo.model.loaders.exp_pca import ExpPca, read_exp_pca, trimmed_faces
from toongeo.model.loaders.files.read_mat import mat_names, read_mat
from toongeo.model.morphable_model import MorphableModel
from toongeo.reading.promise import promise

__all__ = ["is_bfm2009", "load_bfm2009"]

_MICROMETRES, _DECIMETRES = 1e-3, 100.0  # mm a unit: of the original, of Deep3D
_BYTE = 255.0  # colours are 0..255
_ORIGINAL = ("shapeMU", "shapePC", "shapeEV", "tl")
_DEEP3D = ("meanshape", "idBase", "exBase", "tri")
_COLOURS = ("texMU", "texPC", "texEV"), ("meantex", "texBase")


def is_bfm2009(path: Path) -> bool:
    """Whether a MATLAB file is one of these."""
    names = set(mat_names(path))
    return names >= set(_ORIGINAL) or names >= set(_DEEP3D) or "model" in names


def load_bfm2009(
    path: str | Path, landmarks: NDArray[np.int64] | None = None, expression: str | Path | None = None
) -> MorphableModel:
    """``01_MorphableModel.mat``; face3d's ``BFM.mat``; Deep3D's ``BFM_model_front.mat``.

    A unit of a mode becomes one standard deviation (``EV`` of these files are standard deviations; Deep3D's bases
    hold them already), micrometres and decimetres become mm, vertices are counted from 0, triangles face outwards, and
    colours are in [0, 1]. The original has no expressions and no landmarks; the others have both.

    Parameters
    ----------
    path : str or Path
    landmarks : (68,) int, optional
        Vertices from 0, in place of the file's.
    expression : str or Path, optional
        ``Exp_Pca.bin``, expressions for the original, with what lies beside it: see :func:`read_exp_pca`. The model
        then has the 53,215 vertices that these move, in their order.

    Raises
    ------
    ValueError
        If it is none of these, sizes do not fit, numbers are not finite or indices out of range.

    References
    ----------
    P. Paysan et al., "A 3D face model for pose and illumination invariant face recognition", AVSS 2009. Y. Deng et al.,
    "Accurate 3D face reconstruction with weakly-supervised learning", CVPRW 2019.
    """
    path = Path(path)
    extra = None if expression is None else read_exp_pca(Path(expression))
    with promise(path, "a Basel Face Model of 2009", alone=True):
        z: dict[str, Any] = read_mat(path, (*_ORIGINAL, *_DEEP3D, *_COLOURS[0], *_COLOURS[1], "keypoints", "model"))
        has_its_own = isinstance(z.get("model"), dict) or all(name in z for name in _DEEP3D)
        if expression is not None and has_its_own:
            raise ValueError(f"{path}: expected the original model to go with expression, got one that has its own")
        if isinstance(z.get("model"), dict):
            return _face3d(z["model"], landmarks)
        if all(name in z for name in _DEEP3D):
            return _deep3d(z, landmarks)
        missing = [name for name in _ORIGINAL if name not in z]
        if missing:
            raise ValueError(f"{path}: expected the arrays {', '.join(_ORIGINAL)}, without {', '.join(missing)}")
        return _original(z, landmarks, extra)


def _original(z: dict[str, Any], landmarks: NDArray[np.int64] | None, extra: ExpPca | None) -> MorphableModel:
    mean, faces, identity = _points(z["shapeMU"]), _from_one(z["tl"], 3), _modes(z["shapePC"], z["shapeEV"])
    colours = _colours(z)
    if extra is not None:
        kept = extra.vertices
        if kept.max(initial=0) >= len(mean) or not 0 <= faces.min(initial=0) <= faces.max(initial=0) < len(mean):
            raise ValueError(f"vertices are not all in 0..{len(mean) - 1}")
        faces = trimmed_faces(faces, kept, len(mean))
        mean, identity = mean[kept], identity[:, kept]
        colours = {name: np.take(values, kept, axis=-2) for name, values in colours.items()}
    return MorphableModel.from_arrays(
        mean,
        faces,
        identity=identity,
        expression=None if extra is None else extra.modes,
        landmarks=landmarks,
        unit=_MICROMETRES,
        **colours,
    )


def _face3d(z: dict[str, NDArray], landmarks: NDArray[np.int64] | None) -> MorphableModel:
    has_expressions = all(name in z for name in ("expMU", "expPC", "expEV"))
    faces = _from_one(z["tri"], 3)
    if "tri_mouth" in z:
        faces = np.vstack([faces, _from_one(z["tri_mouth"], 3)])
    if landmarks is None and "kpt_ind" in z:
        landmarks = _from_one(z["kpt_ind"], None)
    return MorphableModel.from_arrays(
        _points(z["shapeMU"]) + (_points(z["expMU"]) if has_expressions else 0.0),
        faces,
        identity=_modes(z["shapePC"], z["shapeEV"]),
        expression=_modes(z["expPC"], z["expEV"]) if has_expressions else None,
        landmarks=landmarks,
        unit=_MICROMETRES,
        **_colours(z),
    )


def _deep3d(z: dict[str, NDArray], landmarks: NDArray[np.int64] | None) -> MorphableModel:
    colours: dict[str, NDArray] = {}
    if all(name in z for name in _COLOURS[1]):
        colours = {"albedo_mean": _points(z["meantex"]) / _BYTE, "albedo": _modes(z["texBase"], None, 1 / _BYTE)}
    if landmarks is None and "keypoints" in z:
        landmarks = _from_one(z["keypoints"], None)
    return MorphableModel.from_arrays(
        _points(z["meanshape"]),
        _from_one(z["tri"], 3),
        identity=_modes(z["idBase"], None),
        expression=_modes(z["exBase"], None),
        landmarks=landmarks,
        unit=_DECIMETRES,
        **colours,
    )


def _colours(z: dict[str, NDArray]) -> dict[str, NDArray]:
    if not all(name in z for name in _COLOURS[0]):
        return {}
    return {
        "albedo_mean": _points(z["texMU"]) / _BYTE,
        "albedo": _modes(z["texPC"], z["texEV"], 1 / _BYTE),
    }


def _points(values: NDArray) -> NDArray[np.float64]:
    return np.asarray(values, np.float64).reshape(-1, 3)


def _modes(basis: NDArray, deviations: NDArray | None, factor: float = 1.0) -> NDArray[np.float32]:
    """Modes (k, n, 3) of columns (3 n, k)."""
    columns = np.asarray(basis, np.float32)
    scale = np.full(columns.shape[1], factor) if deviations is None else factor * np.ravel(deviations)
    if scale.shape != columns.shape[1:] or len(columns) % 3:
        raise ValueError(f"expected a basis (3 n, k) and k deviations, got {columns.shape} and {scale.shape}")
    return np.ascontiguousarray((columns * scale.astype(np.float32)).T).reshape(columns.shape[1], -1, 3)


def _from_one(indices: NDArray, width: int | None) -> NDArray[np.int64]:
    """Indices from 0; triangles as rows, whichever way the file has them."""
    whole = np.asarray(indices)
    if not np.isfinite(whole).all() or (whole != np.rint(whole)).any() or np.abs(whole).max(initial=0) > 2**31:
        raise ValueError("expected whole numbers as indices")
    whole = whole.astype(np.int64) - 1
    if width is None:
        return whole.ravel()
    if whole.ndim != 2 or width not in whole.shape:
        raise ValueError(f"expected triangles (m, {width}), got {whole.shape}")
    return whole if whole.shape[1] == width else np.ascontiguousarray(whole.T)
