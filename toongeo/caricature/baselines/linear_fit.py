"""A linear face model fitted to landmarks, as the paper's comparison has it (Wu et al. 2018, section 5.2)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toongeo._brief_repr import brief_repr
from toongeo._read_only import read_only, restored
from toongeo.arrays import Floats
from toongeo.geometry.one_thread import one_thread
from toongeo.geometry.scaled_orthographic_pose import scaled_orthographic_pose
from toongeo.model.anatomy.landmark_basis import landmark_basis
from toongeo.model.anatomy.visible_landmarks import landmarks_seen
from toongeo.model.morphable_model import MorphableModel
from toongeo.pipeline.fit.ibug_landmarks import ibug_landmarks
from toongeo.protocols import HeadCamera
from toongeo.render.camera import ScaledOrthographicCamera

__all__ = ["LinearFit", "equations", "linear_fit", "posed", "ridge_solution"]

_PASSES = 20  # of camera and coefficients in turn
_TINY = 1e-9  # ridge of what has no regularization, against the mean diagonal: picks the smallest of many solutions


@dataclass(frozen=True, eq=False)
class LinearFit:
    """A face of a linear or bilinear model.

    Attributes
    ----------
    vertices : (n, 3) float64, mm, model frame
    camera : HeadCamera
    landmark_vertices : (68,) int64
    """

    vertices: Floats
    camera: HeadCamera
    landmark_vertices: NDArray[np.int64]

    __repr__ = brief_repr
    __setstate__ = restored

    def __post_init__(self) -> None:
        read_only(self, "vertices", "landmark_vertices")

    def project(self, points: ArrayLike) -> Floats:
        """Points (k, 3), mm, model frame -> pixels (k, 2)."""
        return self.camera.project(np.asarray(points, np.float64))


def linear_fit(
    landmarks: ArrayLike,
    model: MorphableModel,
    mean: Floats,
    modes: NDArray[np.float32],
    regularization: float,
    *,
    scheme: str = "ibug68",
) -> LinearFit:
    """3DMM with ``E_lan + regularization * sum (alpha / sigma)^2`` (Eq. 16-18).

    Parameters
    ----------
    landmarks : (68, 2) array_like, px
        NaN rows are missing.
    model : MorphableModel
        Its landmarks and contour lines are used.
    mean : (n, 3) float, mm
    modes : (c, n, 3) float
        Identity and expression, each of one standard deviation.
    regularization : float
        3000 and 0 in the paper; 0 gives the smallest coefficients among the best.
    scheme : str
        What the landmarks are: see :func:`toongeo.ibug_landmarks`.

    Returns
    -------
    LinearFit

    Raises
    ------
    ValueError
        If the landmarks are not those of the scheme, or all are missing.
    """
    pixels = ibug_landmarks(landmarks, scheme)
    seen = np.isfinite(pixels).all(axis=1)
    V: Floats = mean
    vertices = model.landmarks
    with one_thread():
        flat = modes.reshape(len(modes), -1)
        for _ in range(_PASSES):
            camera, vertices = posed(V, model, pixels, vertices)
            J, wanted = equations(mean, modes, vertices[seen], pixels[seen], camera)
            alpha = ridge_solution(J, wanted, regularization)
            V = mean + (alpha.astype(np.float32) @ flat).reshape(-1, 3)
    return LinearFit(V, camera, vertices)


def posed(
    V: Floats, model: MorphableModel, pixels: Floats, vertices: NDArray[np.int64]
) -> tuple[ScaledOrthographicCamera, NDArray[np.int64]]:
    """Camera that sees a face (n, 3) nearest to its landmarks, and the landmark vertices (68,) this pose shows."""
    seen, basis = np.isfinite(pixels).all(axis=1), landmark_basis(model)
    camera = ScaledOrthographicCamera(*scaled_orthographic_pose(V[vertices[seen]], pixels[seen]))
    return camera, landmarks_seen(basis, V[basis.vertices], camera.rotation)


def equations(
    mean: Floats,
    modes: NDArray[np.float32] | Floats,
    vertices: NDArray[np.int64],
    pixels: Floats,
    camera: ScaledOrthographicCamera,
) -> tuple[Floats, Floats]:
    """Matrix (2 k, c) and right-hand side (2 k,) of the landmarks' errors, px (Eq. 13)."""
    projection = camera.jacobian(np.zeros((1, 3)))[0]
    J = np.einsum("ab,ckb->kac", projection, modes[:, vertices].astype(np.float64))
    return J.reshape(-1, len(modes)), (pixels - camera.project(mean[vertices])).ravel()


def ridge_solution(J: Floats, wanted: Floats, regularization: float) -> Floats:
    """Coefficients of least ``|J x - wanted|^2 + regularization |x|^2``."""
    H = J.T @ J
    H[np.diag_indices_from(H)] += regularization + _TINY * H.diagonal().mean()
    return np.linalg.solve(H, J.T @ wanted).astype(np.float64)
