"""FaceScape's bilinear model."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from toongeo.model.morphable_model import MorphableModel
from toongeo.reading.promise import promise
from toongeo.reading.read_npz import npz_names, read_npz

__all__ = ["is_facescape", "load_facescape"]

_KEYS = ("shape_bm_core", "fv_indices")
_MORE = ("id_mean", "id_var", "texcoords", "ft_indices", "lm_list_v16", "color_bm_mean", "color_bm_core")
_EYES_MM = 90.0  # between the outer corners of people's eyes
_BYTE = 255.0


def is_facescape(path: Path) -> bool:
    """Whether an archive is FaceScape's bilinear model."""
    return set(_KEYS) <= set(npz_names(path))


def load_facescape(path: str | Path, landmarks: NDArray[np.int64] | None = None) -> MorphableModel:
    """``facescape_bm_v1.6_*.npz``: the bilinear core, linear about its mean person.

    Expression k of the mean person, less its neutral, is an expression (the files do not name them); mode j is how one
    standard deviation of coefficient j changes the neutral face. Without ``id_mean`` and ``id_var`` the first
    coefficient is taken to be the mean, as in any decomposition of faces that were not centred: its size is that of
    people's eyes, and the others spread as far. Indices of the file count from 1, except landmarks. Dictionaries in it
    are pickles, and not read.

    Parameters
    ----------
    path : str or Path
    landmarks : (68,) int, optional
        In place of the file's.

    Raises
    ------
    ValueError
        If arrays are missing, sizes do not fit, numbers are not finite or indices out of range.

    References
    ----------
    H. Yang et al., "FaceScape: a large-scale high quality 3D face dataset", CVPR 2020.
    """
    path = Path(path)
    z = read_npz(path, _KEYS, _MORE, expected="FaceScape's bilinear model")
    with promise(path, "FaceScape's bilinear model", alone=True):
        core = z["shape_bm_core"]
        if core.ndim != 3 or len(core) % 3 or min(core.shape[1:]) < 1:
            raise ValueError(f"expected shape_bm_core (3 n, expressions, identities), got {core.shape}")
        if landmarks is None and "lm_list_v16" in z:
            landmarks = z["lm_list_v16"].astype(np.int64).ravel()
        person, spread = _person(z, core, landmarks)
        faces = core.astype(np.float64) @ person  # (3 n, expressions)
        shapes = (faces[:, 1:] - faces[:, :1]).T.reshape(-1, len(core) // 3, 3)
        return MorphableModel.from_arrays(
            faces[:, 0].reshape(-1, 3),
            z["fv_indices"].astype(np.int64).reshape(-1, 3) - 1,
            identity=(core[:, 0] * spread).T.reshape(len(spread), -1, 3),
            expression=shapes,
            landmarks=landmarks,
            **_uv(z),
            **_colours(z, len(core)),
        )


def _person(
    z: dict[str, NDArray], core: NDArray, landmarks: NDArray[np.int64] | None
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Coefficients (i,) of the mean person, and their standard deviations."""
    if "id_mean" in z and "id_var" in z:
        person, variance = np.ravel(z["id_mean"]).astype(float), np.ravel(z["id_var"]).astype(float)
        if person.shape != core.shape[2:] or variance.shape != person.shape or not (variance >= 0).all():
            raise ValueError(f"expected {core.shape[2]} means and variances, got {person.shape}, {variance.shape}")
        return person, np.sqrt(variance)
    first = core[:, 0, 0].reshape(-1, 3).astype(float)
    if landmarks is None or landmarks.shape != (68,) or not 0 <= landmarks.min() <= landmarks.max() < len(first):
        raise ValueError("without id_mean it needs the 68 landmarks, which tell its size")
    across = first[landmarks[45]] - first[landmarks[36]]  # towards the subject's left, +X
    size = _EYES_MM / np.linalg.norm(across) * (1 if across[0] > 0 else -1)
    person = np.zeros(core.shape[2])
    person[0] = size
    spread = np.full(core.shape[2], abs(size))
    spread[0] = 0.0
    return person, spread


def _uv(z: dict[str, NDArray]) -> dict[str, NDArray]:
    if "texcoords" not in z or "ft_indices" not in z:
        return {}
    return {"uv": z["texcoords"][:, :2], "uv_faces": z["ft_indices"].astype(np.int64).reshape(-1, 3) - 1}


def _colours(z: dict[str, NDArray], length: int) -> dict[str, NDArray]:
    """Colours of all vertices, if the file has them: (b, g, r), 0..255."""
    if "color_bm_mean" not in z or z["color_bm_mean"].size != length:
        return {}
    found = {"albedo_mean": z["color_bm_mean"].reshape(-1, 3)[:, ::-1] / _BYTE}
    if "color_bm_core" in z and z["color_bm_core"].shape[:1] == (length,):
        modes = z["color_bm_core"].T.reshape(-1, length // 3, 3)[:, :, ::-1]
        found["albedo"] = np.ascontiguousarray(modes / _BYTE, np.float32)
    return found
