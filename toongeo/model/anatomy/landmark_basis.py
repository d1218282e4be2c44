"""The few rows of a morphable model that landmarks need, gathered once a model."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from toongeo.model.ibug68 import OUTER_EYES, PARTS
from toongeo.model.morphable_model import MorphableModel

__all__ = ["LandmarkBasis", "landmark_basis"]


@dataclass(frozen=True, eq=False)
class LandmarkBasis:
    """Mean and modes at the landmarks, on the contour lines and around these, as small dense arrays.

    Attributes
    ----------
    landmarks : (68,) int
        Vertices of the landmarks for a face that looks at the camera.
    lines : 17 arrays of vertices, front to back
    vertices : (k,) int, ascending
        Every vertex that is gathered: landmarks, lines, and the neighbours of the lines.
    mean : (k, 3) float64, mm
    modes : (3 k, c) float64, mm
        Row ``3 i + j`` is coordinate ``j`` of gathered vertex ``i``; columns are identity, then expression.
    line_rows : (l,) int
        Gathered rows of all lines, one line after the other.
    line_starts : (17,) int
        Where each line begins in ``line_rows``.
    fan : (f, 3) int
        Faces around the lines, as gathered rows.
    outer_eye_mm : float
        Distance of the outer eye corners of the mean face: the unit of the landmark loss.
    model : MorphableModel
        Whose rows these are.
    """

    landmarks: NDArray[np.int64]
    lines: tuple[NDArray[np.int64], ...]
    vertices: NDArray[np.int64]
    mean: NDArray[np.float64]
    modes: NDArray[np.float64]
    line_rows: NDArray[np.int64]
    line_starts: NDArray[np.int64]
    fan: NDArray[np.int64]
    outer_eye_mm: float
    model: MorphableModel

    def rows(self, vertices: NDArray[np.int64]) -> NDArray[np.int64]:
        """Gathered rows of vertices that were gathered."""
        return np.searchsorted(self.vertices, vertices)

    def at(self, vertices: NDArray[np.int64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Mean (v, 3) and modes (3 v, c) of vertices (v,), quickly where they were gathered."""
        rows = np.minimum(self.rows(vertices), len(self.vertices) - 1)
        if not np.array_equal(self.vertices[rows], vertices):  # a jaw point on the silhouette may lie anywhere
            return self.model.mean[vertices], _modes(self.model, vertices)
        modes = self.modes.reshape(len(self.mean), 3, -1)[rows]
        return self.mean[rows], modes.reshape(3 * len(rows), -1)

    def positions(self, coefficients: NDArray[np.float64]) -> NDArray[np.float64]:
        """All gathered vertices (k, 3), mm, for coefficients (c,) (Pan et al. 2024, Eq. 1)."""
        return self.mean + (self.modes @ coefficients).reshape(-1, 3)


@lru_cache(maxsize=4)
def landmark_basis(model: MorphableModel) -> LandmarkBasis:
    """The rows of ``model`` that landmarks need; kept for the last few models.

    Raises
    ------
    ValueError
        If the model has not 68 landmarks and a contour line for every jaw point.
    """
    n_jaw = len(PARTS["jaw"])
    if model.landmarks.shape != (68,) or len(model.contour_lines) != n_jaw:
        raise ValueError(
            f"model: expected 68 landmarks and {n_jaw} contour lines, "
            f"got {len(model.landmarks)} landmarks and {len(model.contour_lines)} lines"
        )
    on_lines = np.concatenate(model.contour_lines)
    is_on_line = np.zeros(len(model.mean), bool)
    is_on_line[on_lines] = True
    fan = model.faces[is_on_line[model.faces].any(axis=1)]
    vertices = np.unique(np.concatenate([model.landmarks, on_lines, fan.ravel()]))
    right, left = (model.mean[model.landmarks[k]] for k in OUTER_EYES)
    return LandmarkBasis(
        landmarks=model.landmarks,
        lines=tuple(model.contour_lines),
        vertices=vertices,
        mean=model.mean[vertices],
        modes=_modes(model, vertices),
        line_rows=np.searchsorted(vertices, on_lines),
        line_starts=np.cumsum([0, *map(len, model.contour_lines[:-1])]),
        fan=np.searchsorted(vertices, fan),
        outer_eye_mm=float(np.linalg.norm(left - right)),
        model=model,
    )


def _modes(model: MorphableModel, vertices: NDArray[np.int64]) -> NDArray[np.float64]:
    """Modes (3 v, c) at vertices (v,)."""
    modes = np.concatenate([model.identity[:, vertices], model.expression[:, vertices]])
    return np.ascontiguousarray(modes.transpose(1, 2, 0).reshape(3 * len(vertices), -1), dtype=np.float64)
