"""The coarse stage: a morphable model fitted to the landmarks of a picture."""

from __future__ import annotations

import time

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toongeo.geometry.one_thread import one_thread
from toongeo.io.check_landmarks import check_landmarks
from toongeo.model.default_model import default_model
from toongeo.model.ibug68 import INNER, OUTER_EYES
from toongeo.model.morphable_model import MorphableModel
from toongeo.pipeline.fit.face_fit import FaceFit, FitReport
from toongeo.pipeline.fit.fit_options import FitOptions
from toongeo.pipeline.fit.landmark_basis import LandmarkBasis
from toongeo.pipeline.fit.landmark_fit import LandmarkFit, Solution
from toongeo.pipeline.fit.nlopt_minimize import known_algorithms
from toongeo.pipeline.fit.photometric_fit import photometric_fit

__all__ = ["fit_3dmm"]

Floats = NDArray[np.float64]


def fit_3dmm(
    img: NDArray[np.uint8] | None,
    landmarks: ArrayLike,
    *,
    model: MorphableModel | None = None,
    algorithm: str = "LD_LBFGS",
    options: FitOptions | None = None,
    photometric: bool = False,
) -> FaceFit:
    """Pose, identity and expression of a morphable model from 68 landmarks.

    Minimises ``w_l L_lan + w_r L_reg`` (Eq. 3 without the photometric term): the landmark loss of Eq. 4
    and the prior of Eq. 6. The camera is scaled orthographic. Jaw points slide along the contour lines of
    the model: they are placed for the pose, held while the loss is minimised, and placed anew, until they
    stay.

    Errors are measured in face sizes of the picture, so its resolution, and the place and the tilt of the
    face in it, change nothing. Named expressions stay in [0, 1]. ``mouthClose`` stays 0: it corrects an
    open jaw, and 68 points do not tell a jaw dropped behind closed lips from a long chin.

    Parameters
    ----------
    img : (H, W, 3) array or None
        The picture; here only its size is looked at, to check the landmarks against.
    landmarks : (68, 2) array_like, px
        iBUG-68 order; x right, y down, integer = pixel centre. A NaN row is a missing point.
    model : MorphableModel, optional
        `default_model` if None.
    algorithm : str
        Any optimizer of nlopt by name; those without derivatives (``LN_``, ``GN_``) are hopeless at this
        size.
    options : FitOptions, optional
        Weights and limits.
    photometric : bool
        Go on with `photometric_fit` with its defaults: shape and pose are refined, and albedo and light found, by
        comparing a rendering with the picture. Call it yourself to give it a mask.

    Returns
    -------
    FaceFit

    Raises
    ------
    ValueError
        If the landmarks have another shape, hold infinities, are fewer than 6, coincide, lie on a line or
        outside the picture, or the algorithm is not known, or ``photometric`` is asked for without a picture.
    RuntimeError
        If the optimizer fails.

    References
    ----------
    Pan et al. 2024, "Generating animatable 3D cartoon faces from single portraits", section 3.1, Eq. 1, 3, 4,
    6. Bounded L-BFGS: J. Nocedal 1980, in nlopt by S. G. Johnson after L. Lukšan.

    Examples
    --------
    >>> import numpy as np
    >>> from toongeo.model import default_model
    >>> from toongeo.render import ScaledOrthographicCamera
    >>> model = default_model()
    >>> camera = ScaledOrthographicCamera.look(yaw=20.0)
    >>> fit = fit_3dmm(None, camera.project(model.mean[model.landmarks]))
    >>> bool(abs(fit.camera.yaw - 20.0) < 2.0)
    True
    """
    started = time.perf_counter()
    options = FitOptions() if options is None else options
    model = default_model() if model is None else model
    if photometric and img is None:
        raise ValueError("img: expected a picture for the photometric term, got None")
    if algorithm not in known_algorithms():
        raise ValueError(f"algorithm: no algorithm {algorithm!r}; known: {', '.join(known_algorithms())}")
    warnings = check_landmarks(landmarks, _image_shape(img))
    pixels = np.array(landmarks, np.float64)
    with one_thread():
        problem = LandmarkFit.of(model, pixels, options)
        solution = problem.solve(algorithm)
        rms_px, outer_eye_px = _inner_error(problem.basis, solution, pixels)
    fit = FaceFit(
        identity=solution.coefficients[problem.unknowns.identity],
        expression=solution.coefficients[problem.unknowns.expression],
        camera=solution.camera,
        landmark_vertices=solution.landmark_vertices,
        model=model,
        report=FitReport(
            algorithm=algorithm,
            status=solution.status,
            passes=solution.passes,
            evaluations=solution.evaluations,
            landmark_loss=solution.landmark_loss,
            prior_loss=solution.prior_loss,
            prior_weight=solution.prior_weight,
            loss=solution.loss,
            rms_px=rms_px,
            rms_percent=100 * rms_px / outer_eye_px,
            warnings=tuple(warnings),
            seconds=time.perf_counter() - started,
        ),
    )
    if not photometric or img is None:
        return fit
    return photometric_fit(img, fit, pixels, fit_options=options)


def _image_shape(img: NDArray[np.uint8] | None) -> tuple[int, ...] | None:
    if img is None:
        return None
    shape = np.shape(img)
    if len(shape) != 3 or shape[2] != 3 or min(shape) < 1:
        raise ValueError(f"img: expected shape (H, W, 3) with H, W >= 1, got {shape}")
    return shape


def _inner_error(basis: LandmarkBasis, solution: Solution, pixels: Floats) -> tuple[float, float]:
    """Root mean square error of the inner landmarks, and the distance of the outer eye corners, px."""
    mean, modes = basis.at(solution.landmark_vertices)
    fitted = solution.camera.project(mean + (modes @ solution.coefficients).reshape(-1, 3))
    squares = ((fitted - pixels)[INNER] ** 2).sum(axis=1)
    right, left = np.where(np.isfinite(pixels), pixels, fitted)[list(OUTER_EYES)]
    there = np.isfinite(squares)
    rms = float(np.sqrt(squares[there].mean())) if there.any() else float("nan")
    return rms, float(np.linalg.norm(left - right))
