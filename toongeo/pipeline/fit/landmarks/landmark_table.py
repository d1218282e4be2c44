"""Landmarks of one's own: points on the surface of a model."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toongeo._read_only import read_only, restored
from toongeo.arrays import Floats
from toongeo.io.point_array import point_array
from toongeo.model.morphable_model import MorphableModel

__all__ = ["LandmarkTable", "landmark_table", "table_landmarks"]

_FEWEST = 6  # points overdetermine the pose


@dataclass(frozen=True, eq=False)
class LandmarkTable:
    """Points on a mesh by barycentric coordinates.

    Attributes
    ----------
    corners : (k, 3) int
        Vertices.
    weights : (k, 3) float
        Of each corner; rows sum to 1.
    """

    corners: NDArray[np.int64]
    weights: Floats

    __setstate__ = restored

    def __post_init__(self) -> None:
        read_only(self, "corners", "weights")

    def rows(self, model: MorphableModel) -> tuple[Floats, Floats]:
        """Mean (k, 3) and modes (3 k, c), mm, of the points; columns are identity, then expression."""
        modes = np.concatenate([model.identity[:, self.corners], model.expression[:, self.corners]])
        modes = np.einsum("ckvj,kv->kjc", modes.astype(np.float64), self.weights)
        mean = np.einsum("kvj,kv->kj", model.mean[self.corners], self.weights)
        return mean, modes.reshape(3 * len(mean), -1)


def landmark_table(table: Any, model: MorphableModel) -> LandmarkTable:
    """The caller's table, checked against a model.

    Parameters
    ----------
    table : (k,) int array_like, or a pair (faces (k,), weights (k, 3))
        Vertices; or triangles of the model with the weights of their corners.
    model : MorphableModel

    Raises
    ------
    ValueError
        If shapes do not fit, an index is not in the model, or weights do not sum to 1.
    """
    if isinstance(table, tuple) and len(table) == 2:
        faces = _indices(table[0], len(model.faces), "faces")
        weights = point_array(table[1], "scheme", "weights (k, 3)")
        if weights.shape != (len(faces), 3):
            raise ValueError(f"scheme: expected weights of shape ({len(faces)}, 3), got {weights.shape}")
        if not (np.isfinite(weights).all() and np.allclose(weights.sum(axis=1), 1.0, atol=1e-6)):
            raise ValueError("scheme: expected barycentric weights that sum to 1 in every row")
        return LandmarkTable(model.faces[faces], weights)
    vertices = _indices(table, len(model.mean), "vertices")
    return LandmarkTable(np.repeat(vertices[:, None], 3, axis=1), np.tile([1.0, 0.0, 0.0], (len(vertices), 1)))


def _indices(values: Any, count: int, name: str) -> NDArray[np.int64]:
    try:
        indices = np.asarray(values)
    except ValueError:
        raise ValueError(f"scheme: expected {name} (k,) as integers, got rows of different lengths") from None
    if indices.ndim != 1 or indices.dtype.kind not in "iu" or len(indices) < _FEWEST:
        raise ValueError(
            f"scheme: expected at least {_FEWEST} {name} (k,) as integers, got shape {indices.shape} of {indices.dtype}"
        )
    if indices.min() < 0 or indices.max() >= count:
        raise ValueError(f"scheme: expected {name} in 0..{count - 1}, got {indices.min()}..{indices.max()}")
    return indices.astype(np.int64)


def table_landmarks(landmarks: ArrayLike, table: LandmarkTable) -> Floats:
    """Checked copy (k, 2) of landmarks that go with a table; NaN rows are missing.

    Raises
    ------
    ValueError
        If they are not numbers or of another shape, a row is half missing or infinite, or fewer than six are there.
    """
    pixels = point_array(landmarks)
    if pixels.shape != (len(table.corners), 2):
        raise ValueError(f"landmarks: expected shape ({len(table.corners)}, 2) to go with scheme, got {pixels.shape}")
    missing = np.isnan(pixels)
    if np.isinf(pixels).any() or (missing[:, 0] != missing[:, 1]).any():
        raise ValueError("landmarks: expected finite px, or NaN in both coordinates of a row")
    there = int((~missing[:, 0]).sum())
    if there < _FEWEST:
        raise ValueError(f"landmarks: expected at least {_FEWEST} points that are not NaN, got {there}")
    return pixels
