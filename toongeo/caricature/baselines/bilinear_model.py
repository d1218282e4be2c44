"""A bilinear face model of identities and expressions (Wu et al. 2018, section 5.2, Eq. 19)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toongeo._brief_repr import brief_repr
from toongeo._read_only import read_only, restored
from toongeo.arrays import Floats
from toongeo.caricature.baselines.linear_fit import LinearFit, equations, posed, ridge_solution
from toongeo.geometry.one_thread import one_thread
from toongeo.model.morphable_model import MorphableModel
from toongeo.pipeline.fit.ibug_landmarks import ibug_landmarks
from toongeo.render.camera import ScaledOrthographicCamera

__all__ = ["BilinearModel", "bilinear_fit"]

_RANKS = 50, 25  # kept singular vectors, as FaceWarehouse keeps them
_PASSES = 10  # of camera and coefficients in turn
_RIDGE = 1e-3  # of the mean diagonal: without it, coefficients that landmarks do not tell run away


@dataclass(frozen=True, eq=False)
class BilinearModel:
    """Faces ``C x2 u_id x3 u_exp`` (Eq. 19), the core C by the higher-order SVD of identities x expressions.

    In the data every identity has every expression by the same displacement, ``T_ie = M + A_i + B_e``; then neither
    the data tensor nor the core has to be formed.

    Attributes
    ----------
    mean : (n, 3) float64
    identities, expressions : (i, n, 3), (e, n, 3) float32
        A and B.
    left, right : (i, r), (e, s) float64
        Leading singular vectors of the two modes.
    """

    mean: Floats
    identities: NDArray[np.float32]
    expressions: NDArray[np.float32]
    left: Floats
    right: Floats

    __repr__ = brief_repr
    __setstate__ = restored

    def __post_init__(self) -> None:
        read_only(self, "mean", "identities", "expressions", "left", "right")

    @classmethod
    def from_model(cls, model: MorphableModel, rng: np.random.Generator, *, identities: int = 150) -> BilinearModel:
        """Of random identities and the named expressions (and none) of a model; the ranks of FaceWarehouse are kept."""
        modes = model.principal_modes
        a = rng.standard_normal((identities, len(modes))).astype(np.float32)
        with one_thread():
            A = (a @ modes.reshape(len(modes), -1)).reshape(identities, -1, 3)
        B = np.concatenate([np.zeros_like(model.expression[:1]), model.expression[: model.n_named]])
        left = _mode_vectors(model.mean, A, B, _RANKS[0])
        right = _mode_vectors(model.mean, B, A, _RANKS[1])
        return cls(model.mean, A, B, left, right)

    def vertices(self, u_id: Floats, u_exp: Floats, at: NDArray[np.int64] | slice = slice(None)) -> Floats:
        """Vertices (n, 3) for coefficients (r,) and (s,), or those ``at`` some indices."""
        a, b = self.left @ u_id, self.right @ u_exp
        total = a.sum() * b.sum() * self.mean[at]
        total = total + b.sum() * np.tensordot(a, self.identities[:, at], 1)
        return total + a.sum() * np.tensordot(b, self.expressions[:, at], 1)


def _mode_vectors(mean: Floats, A: NDArray[np.float32], B: NDArray[np.float32], count: int) -> Floats:
    """Leading left singular vectors (i, count) of ``T_(1)``, ``T_ie = M + A_i + B_e``, from its Gram matrix."""
    rows = mean.ravel() + A.reshape(len(A), -1).astype(np.float64)
    other = B.reshape(len(B), -1).astype(np.float64)
    with one_thread():
        cross = rows @ other.sum(axis=0)
        gram = len(B) * rows @ rows.T + cross[:, None] + cross + (other**2).sum()
        return np.linalg.eigh(gram)[1][:, ::-1][:, :count]


def bilinear_fit(
    landmarks: ArrayLike, model: MorphableModel, bilinear: BilinearModel, *, scheme: str = "ibug68"
) -> LinearFit:
    """Pose and the two coefficient vectors of least landmark error, in turns.

    Parameters
    ----------
    landmarks : (68, 2) array_like, px
        NaN rows are missing.
    model : MorphableModel
        Its landmarks and contour lines are used.
    bilinear : BilinearModel
    scheme : str
        What the landmarks are: see :func:`toongeo.ibug_landmarks`.

    Raises
    ------
    ValueError
        If the landmarks are not those of the scheme, or all are missing.
    """
    pixels = ibug_landmarks(landmarks, scheme)
    seen = np.isfinite(pixels).all(axis=1)
    mean_id, mean_exp = bilinear.left.mean(axis=0), bilinear.right[0]  # the mean identity without expression
    u_id, u_exp, vertices = mean_id, mean_exp, model.landmarks
    with one_thread():
        for _ in range(_PASSES):
            camera, vertices = posed(bilinear.vertices(u_id, u_exp), model, pixels, vertices)
            at = vertices[seen]
            core = np.stack([bilinear.vertices(e, u_exp, at) for e in np.eye(len(u_id))])
            u_id = _nearest(core, pixels[seen], camera, mean_id)
            core = np.stack([bilinear.vertices(u_id, e, at) for e in np.eye(len(u_exp))])
            u_exp = _nearest(core, pixels[seen], camera, mean_exp)
    return LinearFit(bilinear.vertices(u_id, u_exp), camera, vertices)


def _nearest(core: Floats, pixels: Floats, camera: ScaledOrthographicCamera, start: Floats) -> Floats:
    """Coefficients (c,) of modes (c, k, 3) that meet the pixels (k, 2), not far from ``start``."""
    k = len(pixels)
    J, wanted = equations(np.zeros((k, 3)), core, np.arange(k), pixels, camera)
    ridge = _RIDGE * float((J * J).sum()) / len(start)
    return start + ridge_solution(J, wanted - J @ start, ridge)
