"""The expression of a face whose identity may be exaggerated."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import lsq_linear

from toongeo.geometry.one_thread import one_thread
from toongeo.io.landmark_array import landmark_array
from toongeo.model.ibug68 import PARTS
from toongeo.model.morphable_model import MorphableModel
from toongeo.pipeline.fit.face_fit import FaceFit

__all__ = ["sparse_expression"]

Floats = NDArray[np.float64]

_NOISE_MM = 0.2  # standard deviation of a landmark
_JAW_MM = 1.4  # of a jaw point, which slides along the outline
_RARITY = 8.0  # cost of a named expression at weight 1: few are seen at a time
_FEW = 0.5  # precision of a named expression beside that; keeps the system well-conditioned
_UNNAMED = 0.3  # standard deviation of the unnamed expressions: they are corrections
_TURN, _SHIFT_MM, _SWELL = 0.1, 30.0, 0.1  # how far the pose may be off, s.d.
_BOUND = 3.0  # of unnamed expressions


def sparse_expression(fit: FaceFit, landmarks: ArrayLike, *, spread: float = 1.0) -> FaceFit:
    """The fit with the few expressions that explain what no identity does.

    With the pose of ``fit`` the landmarks are linear in identity, expression and small changes of the pose. Identity
    and pose are Gaussian and integrated out, so a large identity costs little where ``spread`` is large; the named
    expressions are in [0, 1] and have an exponential prior, which leaves most of them at zero. The identity of the
    result is the likeliest one given the expression.

    Parameters
    ----------
    fit : FaceFit
        With a scaled orthographic camera.
    landmarks : (68, 2) array_like, px
        NaN rows are missing.
    spread : float > 0
        Standard deviation of the identity coefficients: 1 for people, more for caricatures.

    Returns
    -------
    FaceFit
        Camera and landmark vertices are those of ``fit``.

    Raises
    ------
    ValueError
        If the landmarks are malformed or the spread is not positive.
    """
    if not (np.isfinite(spread) and spread > 0):
        raise ValueError(f"spread: expected a finite number > 0, got {spread}")
    pixels = landmark_array(landmarks)
    with one_thread():
        A, B, left = _equations(fit, pixels)
        seen = np.isfinite(left)
        identities = spread * A[:, : len(fit.identity)]
        nuisance = np.hstack([identities, A[:, len(fit.identity) :]])[seen]
        covariance = nuisance @ nuisance.T + np.diag(_variances()[seen])
        whiten = np.linalg.inv(np.linalg.cholesky(covariance))
        expression = _sparse(whiten @ B[seen], whiten @ left[seen], fit.model)
        unexplained = whiten.T @ (whiten @ (left[seen] - B[seen] @ expression))
        identity = _likeliest(fit.model) + spread * identities[seen].T @ unexplained
    return replace(fit, identity=identity, expression=expression)


def _likeliest(model: MorphableModel) -> Floats:
    return np.zeros(len(model.identity)) if model.prior is None else np.asarray(model.prior.mean)


def _variances() -> Floats:
    """Of the coordinates (136,) of the landmarks, mm^2."""
    deviation = np.full((68, 2), _NOISE_MM)
    deviation[PARTS["jaw"]] = _JAW_MM
    return deviation.ravel() ** 2


def _equations(fit: FaceFit, pixels: Floats) -> tuple[Floats, Floats, Floats]:
    """Derivatives (136, .) by identity and pose and by expression, mm, and what is left of the landmarks (136,)."""
    model, camera, at = fit.model, fit.camera, fit.landmark_vertices
    projection = camera.jacobian(np.zeros((1, 3)))[0]
    scale = float(np.linalg.norm(projection[0]))
    across = projection / scale
    identities, expressions = (
        np.einsum("ab,ckb->kac", across, modes[:, at].astype(np.float64)).reshape(2 * len(at), -1)
        for modes in (model.identity, model.expression)
    )
    offsets = 0.0 if model.prior is None else model.prior.landmark_offsets
    rest = model.mean[at] + offsets + np.tensordot(_likeliest(model), model.identity[:, at].astype(np.float64), 1)
    points = model.vertices(fit.identity, fit.expression)[at] + offsets
    turns = [(_TURN * np.cross(axis, points) @ across.T).ravel() for axis in np.eye(3)]
    shifts = [np.tile(_SHIFT_MM * axis, len(at)) for axis in np.eye(2)]
    pose = np.stack([*turns, *shifts, (_SWELL * points @ across.T).ravel()], axis=1)
    return np.hstack([identities, pose]), expressions, ((pixels - camera.project(rest)) / scale).ravel()


def _sparse(M: Floats, y: Floats, model: MorphableModel) -> Floats:
    """Expression (e,) of least ``|M e - y|^2 + priors`` within its bounds."""
    count, named = M.shape[1], np.arange(M.shape[1]) < model.n_named
    H = M.T @ M + np.diag(np.where(named, _FEW**2, _UNNAMED**-2))
    g = M.T @ y - np.where(named, _RARITY, 0.0)
    free = (M != 0).any(axis=0)  # what moves no landmark stays at rest
    if "mouthClose" in model.expression_names:
        free[model.expression_index("mouthClose")] = False  # it corrects an open jaw; 68 points do not tell it
    upper = np.linalg.cholesky(H[np.ix_(free, free)]).T
    bounds = np.where(named, 0.0, -_BOUND)[free], np.where(named, 1.0, _BOUND)[free]
    found = np.zeros(count)
    found[free] = lsq_linear(upper, np.linalg.solve(upper.T, g[free]), bounds, method="bvls", max_iter=10 * count).x
    return np.clip(found, np.where(named, 0.0, -_BOUND), np.where(named, 1.0, _BOUND))
