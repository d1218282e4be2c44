"""A regressor that is no network: coefficients linear in how the landmarks differ from the mean face."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toongeo._brief_repr import brief_repr
from toongeo._read_only import read_only, restored
from toongeo.arrays import Floats
from toongeo.geometry.one_thread import one_thread
from toongeo.model.anatomy.landmark_basis import LandmarkBasis, landmark_basis
from toongeo.model.anatomy.visible_landmarks import visible_landmarks
from toongeo.model.ibug68 import INNER
from toongeo.model.morphable_model import MorphableModel
from toongeo.pipeline.fit.frame.canonical_frame import canonical_frame
from toongeo.protocols import Coefficients
from toongeo.render.camera import ScaledOrthographicCamera

__all__ = ["RidgeRegressor", "train_ridge_regressor"]

_FEWEST = 6  # points overdetermine the pose
_IDENTITY_DEVIATION = 0.7  # of the faces it learns from, standard deviations
_EXPRESSIONS, _STRONGEST = 4, 0.8  # named expressions at once, and their largest weight
_YAW, _PITCH = 35.0, 15.0  # degrees
_NOISE = 0.015  # of a landmark, in outer-eye distances


@dataclass(frozen=True, eq=False)
class RidgeRegressor:
    """A Regressor: identity and expression from landmarks alone, in a fraction of a millisecond.

    The features are the errors of the mean face under its closed-form pose, in outer-eye distances, alone and
    times the sine of the yaw; place, size and tilt of the face in the picture cancel. A missing point has no
    error. The pose is left to the fit.

    Attributes
    ----------
    model : MorphableModel
    weights : (f, c) float
        From features to identity and expression.
    offset : (c,) float

    Examples
    --------
    >>> import numpy as np
    >>> import toongeo as tg
    >>> from toongeo.model import data_path
    >>> landmarks = tg.read_landmarks(data_path("examples/portraits/moustache_man.pts"))
    >>> regressor = tg.train_ridge_regressor(tg.default_model(), np.random.default_rng(0), 100)
    >>> guess = regressor(None, landmarks)
    >>> guess.identity.shape, guess.expression.shape
    ((81,), (64,))
    >>> fit = tg.fit_3dmm(None, landmarks, regressor=regressor)  # the fit starts there
    """

    model: MorphableModel
    weights: Floats
    offset: Floats

    __repr__ = brief_repr
    __setstate__ = restored

    def __post_init__(self) -> None:
        read_only(self, "weights", "offset")

    def __call__(self, img: NDArray[np.uint8] | None, landmarks: ArrayLike) -> Coefficients:
        """Identity and expression for landmarks (68, 2) px; the picture is not looked at.

        Raises
        ------
        ValueError
            If fewer than six landmarks are there or they lie on a line.
        """
        basis = landmark_basis(self.model)
        guess = self.offset + _features(basis, np.asarray(landmarks, np.float64)) @ self.weights
        identity, expression = np.split(guess, [len(self.model.identity)])
        expression[: self.model.n_named] = np.clip(expression[: self.model.n_named], 0.0, 1.0)
        if "mouthClose" in self.model.expression_names:
            expression[self.model.expression_index("mouthClose")] = 0.0
        return Coefficients(identity=identity, expression=expression)


def train_ridge_regressor(
    model: MorphableModel, rng: np.random.Generator, n: int = 2000, *, ridge: float = 1e-2
) -> RidgeRegressor:
    """Ridge regression from the landmarks of ``n`` synthetic faces of a model to their coefficients.

    Faces are random, look within 35 degrees of the camera, and their landmarks are off by 1.5 % of the
    outer-eye distance.

    Parameters
    ----------
    model : MorphableModel
    rng : numpy Generator
    n : int
        About a millisecond each.
    ridge : float > 0
        Weight of the squared coefficients against the mean squared error.

    Returns
    -------
    RidgeRegressor

    Raises
    ------
    ValueError
        If ``n`` < 2 or ``ridge`` is not positive.

    References
    ----------
    A. E. Hoerl, R. W. Kennard, "Ridge regression", Technometrics 12, 1970.

    Examples
    --------
    >>> import numpy as np
    >>> import toongeo as tg
    >>> from toongeo.model import data_path
    >>> landmarks = tg.read_landmarks(data_path("examples/portraits/moustache_man.pts"))
    >>> model = tg.default_model()
    >>> regressor = tg.train_ridge_regressor(model, np.random.default_rng(0), 100)
    >>> regressor(None, landmarks).identity.shape
    (81,)
    """
    if n < 2:
        raise ValueError(f"n: expected at least 2 faces, got {n}")
    if not (np.isfinite(ridge) and ridge > 0):
        raise ValueError(f"ridge: expected a finite number > 0, got {ridge!r}")
    basis = landmark_basis(model)
    with one_thread():
        faces = [_random_face(model, rng) for _ in range(n)]
        X = np.array([_features(basis, _synthetic(basis, face, rng)) for face in faces])
        Y = np.array(faces)
        x_mean, y_mean = X.mean(axis=0), Y.mean(axis=0)
        X, Y = X - x_mean, Y - y_mean
        spread = np.sqrt((X**2).mean())
        gram = X.T @ X / n + ridge * spread**2 * np.eye(X.shape[1])
        weights = np.linalg.solve(gram, X.T @ Y / n)
    return RidgeRegressor(model, weights, y_mean - x_mean @ weights)


def _random_face(model: MorphableModel, rng: np.random.Generator) -> Floats:
    """Identity and expression (c,) of a plausible face."""
    expression = np.zeros(len(model.expression))
    chosen = rng.choice(model.n_named, min(_EXPRESSIONS, model.n_named), replace=False)
    expression[chosen] = rng.uniform(0.0, _STRONGEST, len(chosen))
    if "mouthClose" in model.expression_names:
        expression[model.expression_index("mouthClose")] = 0.0
    return np.concatenate([_IDENTITY_DEVIATION * rng.standard_normal(len(model.identity)), expression])


def _synthetic(basis: LandmarkBasis, face: Floats, rng: np.random.Generator) -> Floats:
    """Noisy landmarks (68, 2) px of a face seen from a random direction."""
    camera = ScaledOrthographicCamera.look(rng.uniform(-_YAW, _YAW), rng.uniform(-_PITCH, _PITCH))
    mean, modes = basis.at(visible_landmarks(basis, face, camera.rotation))
    noise = rng.normal(0.0, _NOISE * basis.outer_eye_mm * camera.scale, (68, 2))
    return camera.project(mean + (modes @ face).reshape(-1, 3)) + noise


def _features(basis: LandmarkBasis, pixels: Floats) -> Floats:
    """Features (f,) of landmarks (68, 2) px."""
    seen = np.flatnonzero(np.isfinite(pixels).all(axis=1))
    posing = np.intersect1d(seen, INNER)
    posing = posing if len(posing) >= _FEWEST else seen
    if len(posing) < _FEWEST:
        raise ValueError(f"landmarks: expected at least {_FEWEST} points that are not NaN, got {len(posing)}")
    mean = basis.mean[basis.rows(basis.landmarks)]
    frame = canonical_frame(mean[posing], pixels[posing])
    errors = (frame.from_pixels(pixels) - (mean @ frame.rotation0.T)[:, :2]) / basis.outer_eye_mm
    errors = np.where(np.isfinite(errors), errors, 0.0).ravel()
    yaw, pitch = -frame.rotation0[2, 0], frame.rotation0[2, 1]
    return np.concatenate([errors, yaw * errors, [yaw, pitch]])
