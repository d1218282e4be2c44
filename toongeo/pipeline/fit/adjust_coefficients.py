"""The template-based baselines of Pan et al.: coefficients bent onto the landmarks without a prior."""

from __future__ import annotations

import time
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from toongeo.arrays import Floats
from toongeo.io.check_landmarks import check_landmarks
from toongeo.model.anatomy.landmark_basis import landmark_basis
from toongeo.model.ibug68 import OUTER_EYES
from toongeo.pipeline.fit.face_fit import FaceFit
from toongeo.pipeline.fit.ibug_landmarks import ibug_landmarks
from toongeo.pipeline.fit.landmarks.inner_error import inner_error
from toongeo.pipeline.fit.losses.nlopt_minimize import nlopt_minimize
from toongeo.protocols import HeadCamera

__all__ = ["ADJUSTMENTS", "DistanceLoss", "adjust_coefficients"]

ADJUSTMENTS = ("expression", "identity+expression")

# The distance has a kink at zero; below this share of the outer-eye distance it is rounded off.
_ROUND = 1e-3


@dataclass(frozen=True, eq=False)
class DistanceLoss:
    """Eq. 7-8 of Pan et al. 2024, ``sum_n |q_n - P(R p_n + t)|``: distances, not their squares.

    Attributes
    ----------
    camera : HeadCamera
    points : (k, 2) float, px
    mean, modes : (k, 3) and (3 k, c) float, mm
        Landmarks ``p = mean + modes a`` (Eq. 8).
    unit : float, px
        Distances are measured in it; the kink at zero is rounded off below 1/1000 of it.
    """

    camera: HeadCamera
    points: Floats
    mean: Floats
    modes: Floats
    unit: float

    def __call__(self, x: Floats) -> tuple[float, Floats]:
        """Value and gradient (c,) at coefficients (c,)."""
        p = self.mean + (self.modes @ x).reshape(-1, 3)
        e = (self.camera.project(p) - self.points) / self.unit
        length = np.sqrt((e**2).sum(axis=1) + _ROUND**2)
        pull = np.einsum("ki,kij->kj", e / length[:, None], self.camera.jacobian(p)) / self.unit
        return float((length - _ROUND).sum()), pull.ravel() @ self.modes

    def curvature(self, x: Floats) -> Floats:
        """Diagonal (c,) of the second derivative where the distances are taken as weights."""
        p = self.mean + (self.modes @ x).reshape(-1, 3)
        e = (self.camera.project(p) - self.points) / self.unit
        J = self.camera.jacobian(p) / self.unit @ self.modes.reshape(len(p), 3, -1)
        return (J**2).sum(axis=1).T @ (1 / np.sqrt((e**2).sum(axis=1) + _ROUND**2))


def adjust_coefficients(
    fit: FaceFit,
    landmarks: ArrayLike,
    adjust: str,
    *,
    algorithm: str = "LD_LBFGS",
    max_evaluations: int = 2000,
    scheme: str = "ibug68",
) -> FaceFit:
    """The face of a fit bent onto the landmarks by its expression, or by identity and expression.

    These are the rivals "Adjust Exp" and "Adjust Id+Exp" of Pan et al.'s Table 2: no prior, and the camera and
    the landmark vertices are those of the fit. They meet the points better than the fit does and pay for it
    with folds; `toongeo.align_face` is the better way. Named expressions stay in [0, 1]; nothing else is bounded.

    Parameters
    ----------
    fit : FaceFit
    landmarks : (68, 2) array_like, px
        iBUG-68 order; NaN rows are missing.
    adjust : {"expression", "identity+expression"}
    algorithm : str
        Of nlopt, by name.
    max_evaluations : int
    scheme : str
        What the landmarks are: see :func:`toongeo.ibug_landmarks`.

    Returns
    -------
    FaceFit
        Its report's ``loss`` and ``landmark_loss`` are Eq. 7 in outer-eye distances of the fit; the prior's are 0.

    Raises
    ------
    ValueError
        If ``adjust`` or ``algorithm`` is not known, or the landmarks are none.

    References
    ----------
    Pan et al. 2024, "Generating animatable 3D cartoon faces from single portraits", Eq. 7-8, Table 2.

    Examples
    --------
    >>> import numpy as np
    >>> import toongeo as tg
    >>> from toongeo.model import data_path
    >>> landmarks = tg.read_landmarks(data_path("examples/portraits/moustache_man.pts"))
    >>> fit = tg.fit_3dmm(None, landmarks)
    >>> nearer = tg.adjust_coefficients(fit, landmarks, "expression")
    >>> def miss(fit):
    ...     return np.linalg.norm(fit.project(fit.vertices[fit.landmark_vertices]) - landmarks, axis=1).mean()
    ...
    >>> bool(miss(nearer) < miss(fit))
    True
    """
    started = time.perf_counter()
    if adjust not in ADJUSTMENTS:
        raise ValueError(f"adjust: expected one of {', '.join(map(repr, ADJUSTMENTS))}, got {adjust!r}")
    landmarks = ibug_landmarks(landmarks, scheme)
    check_landmarks(landmarks)
    pixels = np.array(landmarks, np.float64)
    mean, modes = landmark_basis(fit.model).at(fit.landmark_vertices)
    coefficients = np.concatenate([fit.identity, fit.expression])
    n_identity = len(fit.identity)
    first = n_identity if adjust == "expression" else 0
    held = mean + (modes[:, :first] @ coefficients[:first]).reshape(-1, 3)
    seen = np.isfinite(pixels).all(axis=1)
    eyes = fit.project(fit.vertices[fit.landmark_vertices[list(OUTER_EYES)]])
    loss = DistanceLoss(
        camera=fit.camera,
        points=pixels[seen],
        mean=held[seen],
        modes=modes.reshape(68, 3, -1)[seen, :, first:].reshape(3 * seen.sum(), -1),
        unit=float(np.linalg.norm(eyes[0] - eyes[1])),
    )
    lower, upper = (np.full(len(coefficients), s * np.inf) for s in (-1, 1))
    lower[n_identity:][: fit.model.n_named], upper[n_identity:][: fit.model.n_named] = 0.0, 1.0
    start = coefficients[first:]
    minimum = nlopt_minimize(
        loss,
        start,
        bounds=(lower[first:], upper[first:]),
        scale=1 / np.sqrt(np.maximum(loss.curvature(start), 1e-6)),
        algorithm=algorithm,
        max_evaluations=max_evaluations,
    )
    found = np.concatenate([coefficients[:first], minimum.x])
    fitted = fit.project(mean + (modes @ found).reshape(-1, 3))
    rms_px, outer_eye_px = inner_error(fitted, pixels)
    report = replace(
        fit.report,
        algorithm=algorithm,
        status=minimum.status,
        evaluations=fit.report.evaluations + minimum.evaluations,
        landmark_loss=minimum.value,
        prior_loss=0.0,
        prior_weight=0.0,
        loss=minimum.value,
        rms_px=rms_px,
        rms_percent=100 * rms_px / outer_eye_px,
        seconds=fit.report.seconds + time.perf_counter() - started,
    )
    return replace(fit, identity=found[:n_identity], expression=found[n_identity:], report=report)
