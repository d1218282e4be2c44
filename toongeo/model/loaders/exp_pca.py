"""The expressions that others supply for the Basel Face Model of 2009: ``Exp_Pca.bin``."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from toongeo.arrays import Floats, Integers, Singles
from toongeo.model.loaders.files.read_mat import read_mat
from toongeo.reading.check_file import file_bytes
from toongeo.reading.promise import promise

__all__ = ["ExpPca", "read_exp_pca", "trimmed_faces"]

_DEVIATIONS = "std_exp.txt"
_TRIMS = ("BFM_exp_idx.mat", "model_info.mat")  # of Deep3D, of 3DDFA
_TRIM = "trimIndex"
_MOST_MODES = 1000  # there are 79


@dataclass(frozen=True, eq=False)
class ExpPca:
    """Expressions of some vertices of the model.

    Attributes
    ----------
    vertices : (n,) int64
        Of the model, from 0: which the expressions move, and which are kept.
    modes : (k, n, 3) float32
        Micrometres a standard deviation.
    """

    vertices: Integers
    modes: Singles


def read_exp_pca(path: Path) -> ExpPca:
    """``Exp_Pca.bin`` with ``std_exp.txt`` and ``BFM_exp_idx.mat`` (or 3DDFA's ``model_info.mat``) beside it.

    The file is int32 k, a mean of 3 n float32, which nobody uses, and k modes of 3 n float32, one after the other; n
    follows from its size. The text has k standard deviations; ``trimIndex`` says, from 1, which of the model's 53,490
    vertices the n are.

    Raises
    ------
    OSError
        If a file is missing.
    ValueError
        If sizes do not fit, or numbers are not finite.

    References
    ----------
    Y. Guo et al., "CNN-based real-time dense face reconstruction with inverse-rendered photo-realistic face images",
    PAMI 2019, from whom the file is. Y. Deng et al., "Accurate 3D face reconstruction with weakly-supervised learning",
    CVPRW 2019, whose script reads it this way.
    """
    with promise(path, "expressions of the Basel Face Model (Exp_Pca.bin)", "expression", alone=True):
        content = file_bytes(path, argument="expression")
        count = int(np.frombuffer(content, "<i4", 1)[0]) if len(content) >= 4 else 0
        numbers = (len(content) - 4) // 4
        if not 1 <= count <= _MOST_MODES or (len(content) - 4) % (12 * (count + 1)):
            raise ValueError(f"{count} modes and a mean do not fit into {len(content)} bytes")
        n = numbers // (3 * (count + 1))
        basis = np.frombuffer(content, "<f4", 3 * n * count, 4 + 12 * n).reshape(count, n, 3)
        if not np.isfinite(basis).all():
            raise ValueError("its numbers are not finite")
    deviations = _deviations(path.with_name(_DEVIATIONS), count)
    return ExpPca(_trim(path.parent, n), basis * deviations[:, None, None].astype(np.float32))


def trimmed_faces(faces: Integers, vertices: Integers, count: int) -> Integers:
    """Triangles (m, 3) of which all corners are kept, among the kept vertices (n,) of ``count``."""
    place = np.full(count, -1)
    place[vertices] = np.arange(len(vertices))
    moved = place[faces]
    return np.asarray(moved[(moved >= 0).all(axis=1)], np.int64)


def _deviations(path: Path, count: int) -> Floats:
    with promise(path, f"{count} standard deviations", "expression", alone=True):
        values = np.array(file_bytes(path, argument="expression").split(), np.float64)
        if values.shape != (count,) or not (np.isfinite(values) & (values >= 0)).all():
            raise ValueError(f"got {len(values)} numbers")
        return values


def _trim(folder: Path, count: int) -> Integers:
    for name in _TRIMS:
        if (folder / name).is_file():
            break
    else:
        raise FileNotFoundError(f"expression: expected {' or '.join(_TRIMS)} beside it in {folder}, got none")
    with promise(folder / name, "the vertices that the expressions move", "expression", alone=True):
        found = read_mat(folder / name, (_TRIM,)).get(_TRIM)
        indices = np.zeros(0) if found is None or isinstance(found, dict) else np.ravel(found)
        if indices.shape != (count,) or (indices != np.rint(indices)).any() or not (indices >= 1).all():
            raise ValueError(f"expected {count} vertices from 1 as {_TRIM}, got {len(indices)}")
        vertices = indices.astype(np.int64) - 1
        if len(np.unique(vertices)) != count:
            raise ValueError(f"some vertices of {_TRIM} are there twice")
        return vertices
