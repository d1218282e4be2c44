"""``toongeo bench caricature``: section 5.2 of Wu et al. 2018 on a folder of pictures."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from tqdm import tqdm

from toongeo.app.bench.bench_folder import bench_folder
from toongeo.app.bench.bench_table import BenchTable
from toongeo.app.bench.caricature_methods import FoundFace, caricature_methods
from toongeo.caricature import face_space
from toongeo.io.readers.read_landmarks import read_landmarks
from toongeo.metrics import mesh_quality
from toongeo.model.default_model import default_model
from toongeo.model.ibug68 import OUTER_EYES
from toongeo.model.morphable_model import MorphableModel

__all__ = ["bending_energy", "caricature_table"]

_PANELS = {
    "px, Eq. 20": ("E_error",),
    "% of the outer-eye distance, 23 landmarks left out": ("held out",),
    "% of the face's triangles": ("intersecting",),
    "% of the meshes": ("none",),
    "edges past 100 degrees": ("folds",),
    "sum over the face's edges of |n - n'|^2": ("bending",),
}
_HELD_OUT = 23  # of 68
_PREDICT = ("fit_3dmm", "fit_3dmm + ARAP", "align_face", "fit_caricature")  # whose held-out error is measured
_PAPER = "paper, Table 1, E_error: 3DMM 7.24, 3DMM(-) 4.86, FaceWarehouse 19.00, caricatured 3DMM 6.46, theirs 0.03"


def caricature_table(folder: Path) -> BenchTable:
    """Landmark error, quality and prediction of the baselines and of `fit_caricature` (Table 1 of Wu et al. 2018).

    Landmarks alone are used; the pictures are not opened.

    Raises
    ------
    ValueError, OSError
        If the folder holds no pictures or lacks landmarks, or landmarks cannot be used; says which.
    """
    pictures, model = bench_folder(folder), default_model()
    methods = caricature_methods(model)
    face_space()  # built before the first fit
    rows: dict[str, list[list[float]]] = {name: [] for name in methods}
    for picture in tqdm(pictures, unit="picture", leave=False):
        try:
            landmarks = read_landmarks(picture.landmarks)
            fewer, held = _fewer(landmarks)
            for name, method in methods.items():
                found = method(landmarks)
                predicted = method(fewer) if name in _PREDICT else None
                rows[name].append(_figures(found, predicted, landmarks, held, model))
        except (ValueError, RuntimeError) as error:
            raise type(error)(f"{picture.name}: {error}") from error
    return BenchTable(
        "Caricatures: baselines and fit_caricature",
        tuple(picture.name for picture in pictures),
        _PANELS,
        {name: np.array(values) for name, values in rows.items()},
        decimals=3,
        notes=(_PAPER, "Silhouette landmarks are updated by the pose. The first four, without ARAP, are the paper's."),
    )


def _fewer(landmarks: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Landmarks of which a third is missing, always the same rows, and these."""
    held = np.random.default_rng(0).permutation(len(landmarks))[:_HELD_OUT]
    fewer = landmarks.copy()
    fewer[held] = np.nan
    return fewer, held


def _figures(
    found: FoundFace,
    predicted: FoundFace | None,
    landmarks: NDArray[np.float64],
    held: NDArray[np.int64],
    model: MorphableModel,
) -> list[float]:
    face = model.region("face")[model.faces].all(axis=1)
    quality = mesh_quality(found.vertices, model.faces, selection=face)
    eyes = float(np.linalg.norm(np.subtract(*landmarks[list(OUTER_EYES)])))
    every = np.flatnonzero(np.isfinite(landmarks).all(axis=1))
    return [
        _error_px(found, landmarks, every),
        np.nan if predicted is None else 100 * _error_px(predicted, landmarks, np.intersect1d(held, every)) / eyes,
        100 * quality.intersecting_fraction,
        100.0 * (len(quality.intersecting) == 0),
        quality.folded_count,
        bending_energy(found.vertices, model.faces[face]),
    ]


def _error_px(found: FoundFace, landmarks: NDArray[np.float64], rows: NDArray[np.int64]) -> float:
    """Root mean square distance of some landmarks."""
    left = found.camera.project(found.vertices[found.landmark_vertices[rows]]) - landmarks[rows]
    return float(np.sqrt((left**2).sum(axis=1).mean()))


def bending_energy(V: NDArray[np.float64], F: NDArray[np.int64]) -> float:
    """Squared differences of the unit normals across the edges of triangles (m, 3), summed.

    Examples
    --------
    >>> bending_energy(np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]), np.array([[0, 1, 2], [1, 0, 3]]))
    2.0
    """
    normals = np.cross(V[F[:, 1]] - V[F[:, 0]], V[F[:, 2]] - V[F[:, 0]])
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-30)
    edges = np.sort(np.stack([F, np.roll(F, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)
    key = edges[:, 0].astype(np.int64) * len(V) + edges[:, 1]
    order = np.argsort(key, kind="stable")
    pair = np.flatnonzero(key[order][1:] == key[order][:-1])
    a, b = order[pair] // 3, order[pair + 1] // 3
    return float(((normals[a] - normals[b]) ** 2).sum())
