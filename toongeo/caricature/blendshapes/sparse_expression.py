"""The expression of a face whose identity may be exaggerated.

Constants were judged on faces of the deformation space and four pictures (``benchmarks/caricature_expressions.py``).
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import lsq_linear

from toongeo.arrays import Floats
from toongeo.geometry.one_thread import one_thread
from toongeo.model.ibug68 import PARTS
from toongeo.model.morphable_model import MorphableModel
from toongeo.pipeline.fit.face_fit import FaceFit
from toongeo.pipeline.fit.ibug_landmarks import ibug_landmarks

__all__ = ["sparse_expression"]

# How loosely a drawing keeps to the model, as multiples of the three rows below; the likeliest is taken.
_LOOSENESS = 0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0
_NOISE_MM, _JAW_MM = 0.2, 3.0  # s.d. of a landmark, and of a jaw point, which slides along the outline
_PART_SHIFT_MM, _PART_GROWTH, _PART_TURN = 1.0, 0.03, 0.02  # s.d. of place, size and tilt of a part

_RARITY = 8.0  # cost of a named expression at weight 1: few are seen at a time
_FEW = 0.5  # precision of a named expression beside that; keeps the system well-conditioned
_UNNAMED = 0.3  # standard deviation of the unnamed expressions: they are corrections
_TURN, _SHIFT_MM, _SWELL = 0.1, 30.0, 0.1  # how far the pose may be off, s.d.
_BOUND = 3.0  # of unnamed expressions


def sparse_expression(fit: FaceFit, landmarks: ArrayLike, *, spread: float = 1.0, scheme: str = "ibug68") -> FaceFit:
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
    scheme : str
        What the landmarks are: see :func:`toongeo.ibug_landmarks`.

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
    pixels = ibug_landmarks(landmarks, scheme)
    with one_thread():
        A, B, left = _equations(fit, pixels)
        seen = np.isfinite(left)
        A[:, : len(fit.identity)] *= spread
        A, B, left, parts = A[seen], B[seen], left[seen], _part_motions(fit)[seen]
        found = [_explained(A, B, left, k * parts, _variances(k)[seen], fit.model) for k in _LOOSENESS]
        _, expression, unexplained = min(found, key=lambda each: each[0])
        identity = _likeliest(fit.model) + spread * A[:, : len(fit.identity)].T @ unexplained
    return replace(fit, identity=identity, expression=expression)


def _likeliest(model: MorphableModel) -> Floats:
    return np.zeros(len(model.identity)) if model.prior is None else np.asarray(model.prior.mean)


def _explained(
    A: Floats, B: Floats, left: Floats, parts: Floats, variances: Floats, model: MorphableModel
) -> tuple[float, Floats, Floats]:
    """Minus the log of the evidence, the expression, and what it leaves, divided by its covariance."""
    lower = np.linalg.cholesky(A @ A.T + parts @ parts.T + np.diag(variances))
    whiten = np.linalg.inv(lower)
    expression, cost = _sparse(whiten @ B, whiten @ left, model)
    evidence = cost / 2 + np.log(lower.diagonal()).sum()
    return float(evidence), expression, whiten.T @ (whiten @ (left - B @ expression))


def _part_motions(fit: FaceFit) -> Floats:
    """How place, size and tilt of the parts, of one standard deviation each, move the landmarks: (136, c), mm."""
    camera = fit.camera
    points = camera.project(fit.vertices[fit.landmark_vertices]) / np.linalg.norm(
        camera.jacobian(np.zeros((1, 3)))[0, 0]
    )
    columns = []
    for part in PARTS.values():
        x, y = (points[part] - points[part].mean(0)).T
        one, none = np.ones(len(part)), np.zeros(len(part))
        for motion, deviation in (
            ((one, none), _PART_SHIFT_MM),
            ((none, one), _PART_SHIFT_MM),
            ((x, none), _PART_GROWTH),
            ((none, y), _PART_GROWTH),
            ((-y, x), _PART_TURN),
        ):
            column = np.zeros((68, 2))
            column[part] = deviation * np.stack(motion, axis=1)
            columns.append(column.ravel())
    return np.stack(columns, axis=1)


def _variances(looseness: float) -> Floats:
    """Of the coordinates (136,) of the landmarks, mm^2; the jaw points' own is never less than in people."""
    deviation = np.full((68, 2), looseness * _NOISE_MM)
    deviation[PARTS["jaw"]] = max(looseness, 1.0) * _JAW_MM
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


def _sparse(M: Floats, y: Floats, model: MorphableModel) -> tuple[Floats, float]:
    """Expression (e,) of least ``|M e - y|^2 + priors`` within its bounds, and this value."""
    count, named = M.shape[1], np.arange(M.shape[1]) < model.n_named
    H = M.T @ M + np.diag(np.where(named, _FEW**2, _UNNAMED**-2))
    g = M.T @ y - np.where(named, _RARITY, 0.0)
    free = (M != 0).any(axis=0)  # what moves no landmark stays at rest
    if "mouthClose" in model.expression_names:
        free[model.expression_index("mouthClose")] = False  # it corrects an open jaw; 68 points do not tell it
    upper = np.linalg.cholesky(H[np.ix_(free, free)]).T
    lowest, highest = np.where(named, 0.0, -_BOUND), np.where(named, 1.0, _BOUND)
    e, target = np.zeros(count), np.linalg.solve(upper.T, g[free])
    e[free] = lsq_linear(upper, target, (lowest[free], highest[free]), method="bvls", max_iter=10 * count).x
    e = np.clip(e, lowest, highest)
    return e, float(y @ y + e @ (H @ e) - 2 * e @ g)
