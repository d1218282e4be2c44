"""FLAME."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from toongeo.model.loaders.files.read_pickle import plain, unpickled
from toongeo.model.morphable_model import MorphableModel
from toongeo.model.supply.skinning import Skinning
from toongeo.reading.promise import promise
from toongeo.reading.read_npz import npz_names, read_npz

__all__ = ["is_flame", "load_flame"]

_METRES = 1000.0  # mm
_N_IDENTITY = 300  # of the 400 shape directions; the others are expressions
_JOINTS = ("root", "neck", "jaw", "eye_left", "eye_right")
_KEYS = ("v_template", "f", "shapedirs", "posedirs", "J_regressor", "kintree_table", "weights")
# Turns of the jaw (radians about +X and +Y) that become named expressions: a mouth wide open, a jaw pushed aside.
_TURNS = {"jawOpen": (0.35, 0.0, 0.0), "jawLeft": (0.0, 0.1, 0.0), "jawRight": (0.0, -0.1, 0.0)}


def is_flame(path: Path) -> bool:
    """Whether an archive is FLAME; a pickle is opened to see."""
    return set(_KEYS) <= set(npz_names(path))


def load_flame(path: str | Path, landmarks: NDArray[np.int64] | None = None) -> MorphableModel:
    """FLAME 2020 or 2023, ``.pkl`` or ``.npz``.

    The first 300 shape directions are identity, the rest expressions, all in standard deviations; metres become mm. Jaw
    and neck turn by ``model.posed(pose={"jaw": ...})``; what a turned jaw does is also there as the named expressions
    ``jawOpen``, ``jawLeft`` and ``jawRight``. Pickles are read without executing anything of theirs:
    classes other than those of numpy, scipy.sparse and chumpy are refused.

    Parameters
    ----------
    path : str or Path
    landmarks : (68,) int, optional
        Vertices; :func:`flame_landmarks` reads the tables that are published beside the model.

    Raises
    ------
    ValueError
        If it is no FLAME, sizes do not fit, numbers are not finite or indices out of range, or a pickle names a class
        that numbers do not need.

    References
    ----------
    T. Li et al., "Learning a model of facial shape and expression from 4D scans", SIGGRAPH Asia 2017.
    """
    path = Path(path)
    with promise(path, "FLAME", alone=True):
        z = _arrays(path)
        mean = np.asarray(z["v_template"], np.float64)
        shapes = np.moveaxis(np.asarray(z["shapedirs"], np.float32), 2, 0)
        identity, expression = shapes[:_N_IDENTITY], shapes[_N_IDENTITY:]
        bare = MorphableModel.from_arrays(
            mean,
            np.asarray(z["f"]).astype(np.int64),
            identity=identity,
            expression=expression,
            landmarks=landmarks,
            unit=_METRES,
            skinning=_skinning(z, len(mean)),
        )
        turned = [bare.posed(pose={"jaw": turn}) - bare.mean for turn in _TURNS.values()]
        return replace(
            bare,
            expression=np.concatenate([np.asarray(turned, np.float32), bare.expression]),
            expression_names=(*_TURNS, *bare.expression_names),
            n_named=len(_TURNS),
        )


def _arrays(path: Path) -> dict[str, NDArray]:
    if path.suffix == ".npz":
        return read_npz(path, _KEYS, expected="FLAME")
    content: Any = unpickled(path.read_bytes())
    if not isinstance(content, dict):
        raise ValueError(f"{path}: expected a dictionary of arrays, got {type(content).__name__}")
    missing = [name for name in _KEYS if name not in content]
    if missing:
        raise ValueError(f"{path}: expected the arrays {', '.join(_KEYS)}, without {', '.join(missing)}")
    found = {name: plain(content[name]) for name in _KEYS}
    for name, array in found.items():
        if not isinstance(array, np.ndarray):
            raise ValueError(f"{path}: expected numbers for {name}, got none")
    return found


def _skinning(z: dict[str, NDArray], n: int) -> Skinning:
    tree = np.asarray(z["kintree_table"]).astype(np.int64)
    parents = np.where((tree[0] < 0) | (tree[0] > len(_JOINTS)), -1, tree[0])  # the root's is 2^32 - 1
    correctives = np.asarray(z["posedirs"], np.float64)
    if correctives.shape != (n, 3, 9 * (len(_JOINTS) - 1)):
        raise ValueError(f"expected posedirs ({n}, 3, {9 * (len(_JOINTS) - 1)}), got {correctives.shape}")
    return Skinning(
        names=_JOINTS,
        parents=parents,
        regressor=np.asarray(z["J_regressor"], np.float64),
        weights=np.asarray(z["weights"], np.float64),
        correctives=np.ascontiguousarray(_METRES * np.moveaxis(correctives, 2, 0), np.float32),
    )
