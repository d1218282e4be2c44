"""Landmarks without the noise that a smooth motion of the face cannot explain.

Constants were chosen on thirteen pictures and seeds of noise, and only looked at on twelve others
(``benchmarks/noise.py``).
"""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from toongeo._brief_repr import brief_repr
from toongeo._read_only import read_only
from toongeo.arrays import Floats
from toongeo.model.default_model import default_model
from toongeo.model.ibug68 import OUTER_EYES
from toongeo.pipeline.align.noise.field_likelihood import FieldLikelihood
from toongeo.pipeline.align.noise.left_out import left_out
from toongeo.pipeline.align.symmetric_field import FieldPrior, observed_covariance
from toongeo.pipeline.fit.face_fit import FaceFit
from toongeo.pipeline.fit.fit_3dmm import fit_3dmm

__all__ = ["DenoisedLandmarks", "LandmarkNoise", "Noise", "check_noise", "denoise_landmarks"]

Noise = float | Literal["auto"]
_BY_HAND = 0.018  # outer-eye distances; points set by hand on 25 pictures show 0.001 to 0.0172
_ODD = 3.5  # standard deviations
_GROSS = 0.25  # outer-eye distances; among exact points, what is odd by less than that was drawn so (0.17 is the most)
_MOST_REJECTED = 1 / 4  # of the points; if more are odd, the noise is not what is wrong
_FEWEST = 24  # points from which noise can be told
_PRIOR = FieldPrior()


@dataclass(frozen=True)
class LandmarkNoise:
    """How noisy landmarks are, and what was done about it.

    Attributes
    ----------
    sigma : float
        Standard deviation of the noise in each coordinate, in outer-eye distances of the fitted face.
    smoothed : bool
        Whether every point was moved to where the field most likely is.
    rejected : tuple of int
        Points that the others contradict; each was moved to where the others put it.
    """

    sigma: float = 0.0
    smoothed: bool = False
    rejected: tuple[int, ...] = ()

    def __str__(self) -> str:
        moved = "all points were smoothed" if self.smoothed else "the other points were kept"
        odd = ", ".join(map(str, self.rejected))
        put_back = f"; put where the others have them: {odd}" if odd else ""
        return f"the landmarks have noise of {100 * self.sigma:.1f} % of the outer-eye distance: {moved}{put_back}"


@dataclass(frozen=True, eq=False)
class DenoisedLandmarks:
    """Landmarks, and what was done to them.

    Attributes
    ----------
    points : (68, 2) float64, px
        Bit for bit those that were given, where nothing had to be done. NaN rows stay missing.
    noise : LandmarkNoise
    """

    points: Floats
    noise: LandmarkNoise

    __repr__ = brief_repr

    def __post_init__(self) -> None:
        read_only(self, "points")

    @property
    def change(self) -> LandmarkNoise | None:
        """The noise if any point was moved for it, else None."""
        return self.noise if self.noise.smoothed or self.noise.rejected else None


def denoise_landmarks(fit: FaceFit, landmarks: Floats, noise: Noise = "auto") -> DenoisedLandmarks:
    """Take out of landmarks what the Gaussian process of the alignment holds for noise.

    The motion that takes the fitted face to its landmarks is a sample of the process whose posterior mean is
    :func:`~toongeo.pipeline.align.symmetric_field.most_likely_field`. Its size and the noise upon it are those that
    make the landmarks most likely (:class:`~toongeo.pipeline.align.noise.field_likelihood.FieldLikelihood`). In turn,
    the point that lies farthest from where all others put it is set aside while that is odd
    (:func:`~toongeo.pipeline.align.noise.left_out.left_out`); then every point moves to the posterior mean of the rest.

    Parameters
    ----------
    fit : FaceFit
        To these landmarks. In the place of a fit of another model than the default one stands one of that: what a model
        with few faces or no expressions cannot show would pass for noise.
    landmarks : (68, 2) float, px
        NaN rows are missing.
    noise : "auto" or float
        Standard deviation in outer-eye distances; 0: the points are exact. ``"auto"``: as found, and points that seem
        to be set with care (below 0.018) are left as they are, but for those that are off by 0.25 and more.

    Returns
    -------
    DenoisedLandmarks

    Raises
    ------
    ValueError
        If `noise` is neither "auto" nor a number >= 0.

    Examples
    --------
    >>> from toongeo.io import read_landmarks
    >>> from toongeo.model import data_path
    >>> from toongeo.pipeline import fit_3dmm
    >>> points = read_landmarks(data_path("examples/portraits/moustache_man.pts"))
    >>> wrong = points.copy()
    >>> wrong[33] += 80
    >>> denoise_landmarks(fit_3dmm(None, points), points).change

    >>> denoise_landmarks(fit_3dmm(None, wrong), wrong).noise.rejected
    (33,)
    """
    check_noise(noise)
    seen = np.flatnonzero(np.isfinite(landmarks).all(1))
    if noise == 0 or len(seen) < _FEWEST:
        return DenoisedLandmarks(landmarks, LandmarkNoise())
    if fit.model is not default_model():
        fit = fit_3dmm(None, landmarks)
    covariance, missed, px = _observations(fit, landmarks, seen)
    kept, amplitude, sigma = _believed(covariance, missed, noise)
    smoothed = noise != "auto" or sigma >= _BY_HAND
    rows = _rows(kept)
    # A head without any motion has no covariance to divide by.
    ratio = sigma / amplitude if amplitude else 1.0
    inner = covariance[np.ix_(rows, rows)] + ratio**2 * np.eye(len(rows))
    error = missed - (covariance[:, rows] @ np.linalg.solve(inner, missed[kept].ravel())).reshape(-1, 2)
    off = np.setdiff1d(np.arange(len(seen)), kept)
    if not smoothed:
        off = off[np.linalg.norm(error[off], axis=1) > _GROSS]
    moved = np.arange(len(seen)) if smoothed else off
    points = np.array(landmarks, np.float64)
    points[seen[moved]] -= px * error[moved]
    return DenoisedLandmarks(points, LandmarkNoise(sigma, smoothed, tuple(seen[off].tolist())))


def check_noise(noise: Noise) -> None:
    """Raise ValueError unless noise is "auto" or a number >= 0."""
    known = noise == "auto" if isinstance(noise, str) else np.isfinite(noise) and noise >= 0
    if not known:
        raise ValueError(f"noise: expected 'auto' or a number >= 0 in outer-eye distances, got {noise!r}")


def _observations(fit: FaceFit, landmarks: Floats, seen: np.ndarray) -> tuple[Floats, Floats, float]:
    """Covariance (2 k, 2 k) of what is seen of the motion, that motion (k, 2), and the pixels of their unit."""
    V, at = fit.vertices, fit.landmark_vertices[seen]
    unit = float(np.linalg.norm(np.subtract(*V[fit.model.landmarks[list(OUTER_EYES)]])))
    jacobians = fit.camera.jacobian(V[at]) * unit
    px = float(np.sqrt((jacobians**2).mean() * 3))
    covariance = observed_covariance(V[at] / unit, jacobians / px, _PRIOR)
    return covariance, (landmarks[seen] - fit.camera.project(V[at])) / px, px


def _believed(covariance: Floats, missed: Floats, noise: Noise) -> tuple[np.ndarray, float, float]:
    """The points (indices) that do not contradict the others, and amplitude and sigma by them."""
    kept = np.arange(len(missed))
    while True:
        rows = _rows(kept)
        own = covariance[np.ix_(rows, rows)]
        likelihood = FieldLikelihood.of(own, missed[kept].ravel())
        if noise == "auto":
            amplitude, sigma = likelihood.most_likely()
        else:
            amplitude, sigma = likelihood.amplitude_for(noise), noise
        spread = max(sigma, _BY_HAND)
        _, z = left_out(amplitude**2 * own + spread**2 * np.eye(len(rows)), missed[kept])
        worst = int(np.argmax(z))
        if z[worst] <= _ODD or len(kept) <= (1 - _MOST_REJECTED) * len(missed):
            return kept, amplitude, sigma
        kept = np.delete(kept, worst)


def _rows(points: np.ndarray) -> np.ndarray:
    """Rows of both coordinates of points in a flat vector."""
    return (2 * points[:, None] + [0, 1]).ravel()
