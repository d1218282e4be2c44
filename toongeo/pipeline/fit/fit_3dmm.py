"""The coarse stage: a morphable model fitted to the landmarks of a picture."""

from __future__ import annotations

import time
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toongeo.geometry.one_thread import one_thread
from toongeo.model.default_model import default_model
from toongeo.model.morphable_model import MorphableModel
from toongeo.pipeline.fit.face_fit import FaceFit
from toongeo.pipeline.fit.fit_options import FitOptions, changed_options
from toongeo.pipeline.fit.losses.gauss_newton import GAUSS_NEWTON
from toongeo.pipeline.fit.photometric_fit import photometric_fit
from toongeo.pipeline.fit.problem.fit_task import check_call, fit_task
from toongeo.pipeline.landmarks.given_or_found import given_or_found
from toongeo.protocols import Regressor

__all__ = ["fit_3dmm"]


def fit_3dmm(
    img: NDArray[np.uint8] | None,
    landmarks: ArrayLike | None = None,
    *,
    model: MorphableModel | None = None,
    algorithm: str = GAUSS_NEWTON,
    options: FitOptions | None = None,
    regressor: Regressor | None = None,
    photometric: bool = False,
    **changes: Any,
) -> FaceFit:
    """Pose, identity and expression of a morphable model from landmarks.

    Minimises ``w_l L_lan + w_r L_reg`` (Eq. 3 without the photometric term): the landmark loss of Eq. 4
    and the prior of Eq. 6, about the likeliest face of the model, with a weak prior on the pitch. The camera is
    scaled orthographic, or, with ``camera="perspective"``, has a focal length that is given or found. Jaw points
    slide along the contour lines of the model: they are placed for the pose, held while the loss is minimised, and
    placed anew, until they stay.

    Errors are measured in face sizes of the picture, so its resolution, and the place and the tilt of the
    face in it, change nothing. Named expressions stay in [0, 1]. ``mouthClose`` stays 0: it corrects an
    open jaw, and 68 points do not tell a jaw dropped behind closed lips from a long chin. Of two expressions that
    exclude each other, such as ``jawLeft`` and ``jawRight``, at most one is above 0.

    Parameters
    ----------
    img : (H, W, 3) uint8 array or None
        The picture; without the photometric term only its size is looked at, to check the landmarks against.
    landmarks : (68, 2) array_like, px, optional
        iBUG-68 order, or as ``scheme`` says; x right, y down, integer = pixel centre. A NaN row is a missing point.
        None: those of the largest face that `detect_landmarks` finds.
    model : MorphableModel, optional
        `default_model` if None.
    algorithm : str
        ``"gauss-newton"``, whose steps end at the minimum of a quadratic model in the bounds, or any optimizer of
        nlopt by name (``"LD_LBFGS"``); those without derivatives (``LN_``, ``GN_``) are hopeless at this size.
    options : FitOptions, optional
        Weights and limits.
    regressor : Regressor, optional
        ``(img, landmarks) -> Coefficients``: where the fit starts or, with ``refine=False``, the answer.
    photometric : bool
        Go on with `photometric_fit` with its defaults: shape and pose are refined, and albedo and light found, by
        comparing a rendering with the picture. Call it yourself to give it a mask.
    **changes
        Fields of `FitOptions` that differ from ``options``, as in ``fit_3dmm(img, points, robust=None)``.

    Returns
    -------
    FaceFit
        For several pictures of one person see `fit_3dmm_together`.

    Raises
    ------
    ValueError
        If the landmarks are not numbers, have another shape, hold infinities, are fewer than 6, coincide, lie on a
        line or outside the picture; the picture is not (H, W, 3) uint8; the algorithm is not known. If a regressor
        returns something else than coefficients, or of another shape. If there are several pictures, or no landmarks
        and no face or no picture to find them in. If ``photometric`` is asked for without a picture, with ``adjust`` or
        a landmark table.
    RuntimeError
        If the optimizer fails.

    References
    ----------
    Pan et al. 2024, "Generating animatable 3D cartoon faces from single portraits", section 3.1, Eq. 1, 3, 4,
    6. The minimiser: J. Nocedal, S. J. Wright, "Numerical Optimization", 2nd ed., sections 10.3 and 16.7.

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
    options = changed_options(options, changes)
    check_call(algorithm, options, regressor)
    if isinstance(img, list | tuple):
        raise ValueError(f"img: expected one picture or None, got {len(img)}; fit_3dmm_together fits several")
    if photometric:
        _check_photometric(img, options)
    landmarks = given_or_found(img, landmarks, options.scheme)
    task = fit_task(img, landmarks, default_model() if model is None else model, options, regressor)
    with one_thread():
        solution = task.problem.solve(algorithm)
        fit = task.face(solution, algorithm, time.perf_counter() - started)
    if photometric:
        assert img is not None  # checked above
        return photometric_fit(img, fit, task.pixels, fit_options=options)
    return fit


def _check_photometric(img: NDArray[np.uint8] | None, options: FitOptions) -> None:
    """A picture can be rendered and compared; what that would undo is refused."""
    if img is None:
        raise ValueError("img: expected one picture for the photometric term, got None")
    if not isinstance(options.scheme, str):
        raise ValueError("scheme: expected a scheme by name with the photometric term, got a table")
    if options.adjust is not None:
        raise ValueError(f"adjust: expected None with the photometric term, which has a prior, got {options.adjust!r}")
