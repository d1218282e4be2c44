"""The photometric refinement of a fit: the face rendered, and compared with its picture."""

from __future__ import annotations

import time
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toongeo.arrays import Floats
from toongeo.geometry.one_thread import one_thread
from toongeo.io.check_image import check_image
from toongeo.io.check_landmarks import check_landmarks
from toongeo.model.ibug68 import INNER, OUTER_EYES
from toongeo.pipeline.fit.face_fit import FaceFit, PhotometricReport
from toongeo.pipeline.fit.fit_options import FitOptions
from toongeo.pipeline.fit.ibug_landmarks import ibug_landmarks
from toongeo.pipeline.fit.photometric.parallel_view import in_perspective, parallel_view
from toongeo.pipeline.fit.photometric.photometric_problem import PhotometricProblem
from toongeo.pipeline.fit.photometric_options import PhotometricOptions

__all__ = ["photometric_fit"]


def photometric_fit(
    img: NDArray[np.uint8],
    fit: FaceFit,
    landmarks: ArrayLike,
    *,
    mask: ArrayLike | None = None,
    options: PhotometricOptions | None = None,
    fit_options: FitOptions | None = None,
    scheme: str = "ibug68",
) -> FaceFit:
    """Identity, expression, pose, albedo and light of a face whose landmarks were fitted.

    Minimises ``w_l L_lan + w_p L_photo + w_r L_reg`` (Eq. 3) from where `fit_3dmm` arrived. Each pass freezes
    visibility and robust weights at the face found so far, and takes a Gauss-Newton step over shape, pose and albedo
    with the light eliminated in closed form: nlopt minimises the quadratic model within the bounds. Landmarks stay in
    the loss, so the face cannot drift from them.

    The picture is resampled onto the canonical frame of the fit, so its size, and the place and tilt of the face in
    it, matter only through the resampling.

    Parameters
    ----------
    img : (H, W, 3) uint8
        RGB, sRGB encoded.
    fit : FaceFit
        From `fit_3dmm` with the same landmarks. Of a perspective camera the focal length and the principal point are
        kept: the picture is resampled to a parallel view with the depth of this fit, and refined there.
    landmarks : (68, 2) array_like, px
        NaN rows are missing.
    mask : (H, W) array_like of bool or float in [0, 1], optional
        Confidence map A of Eq. 5: where the bare face is seen. By default the likelihood of skin, learned from
        cheeks and nose.
    options : PhotometricOptions, optional
    fit_options : FitOptions, optional
        Those that ``fit`` was made with.
    scheme : str
        What the landmarks are: see :func:`toongeo.ibug_landmarks`.

    Returns
    -------
    FaceFit
        With ``albedo`` (a,) in standard deviations, ``light`` (9, 3) as radiance in the camera frame (see
        `toongeo.render.irradiance`), and ``photometric``, the report.

    Raises
    ------
    ValueError
        If the picture is not (H, W, 3) uint8, the mask has another size or other values, nothing of the face is in
        both picture and mask, the landmarks are not 68 or not those of a face in the picture (see
        `toongeo.io.check_landmarks`), or ``fit_options`` ask for a landmark table.
    RuntimeError
        If the optimizer fails.

    References
    ----------
    Pan et al. 2024, "Generating animatable 3D cartoon faces from single portraits", section 3.1, Eq. 1-6.
    Frozen visibility: V. Blanz, T. Vetter, "A morphable model for the synthesis of 3D faces", SIGGRAPH
    1999.

    Examples
    --------
    >>> import toongeo as tg
    >>> from toongeo.model import data_path
    >>> img = tg.read_image(data_path("examples/portraits/astronaut.png"))
    >>> landmarks = tg.read_landmarks(data_path("examples/portraits/astronaut.pts"))
    >>> fit = tg.photometric_fit(img, tg.fit_3dmm(None, landmarks), landmarks)
    >>> fit.albedo.shape, fit.light.shape
    ((9,), (9, 3))
    """
    started = time.perf_counter()
    check_image(img)
    confidence = _checked_mask(mask, img.shape[:2])
    pixels = ibug_landmarks(landmarks, scheme)
    check_landmarks(pixels, img.shape)
    fit_options = replace(fit_options or FitOptions(), camera="orthographic", focal_px=None, principal_point=None)
    if not isinstance(fit_options.scheme, str):
        raise ValueError("fit_options: expected a scheme by name, whose 68 points these are, got a table")
    with one_thread():
        seen = parallel_view(img, confidence, pixels, fit)
        problem = PhotometricProblem.of(
            seen.img, seen.fit, seen.pixels, seen.confidence, options or PhotometricOptions(), fit_options
        )
        solution = problem.solve()
    unknowns = problem.landmarks.unknowns
    found = problem.landmarks.frame.camera(solution.z, unknowns, problem.landmarks.principal_point)
    refined = FaceFit(
        identity=solution.z[unknowns.identity],
        expression=solution.z[unknowns.expression],
        camera=in_perspective(found, fit.camera),
        landmark_vertices=solution.landmark_vertices,
        model=fit.model,
        report=fit.report,
        albedo=solution.z[unknowns.size :],
        light=solution.light,
        photometric=PhotometricReport(
            residual_ambient=solution.residuals[0],
            residual_before=solution.residuals[1],
            residual_after=solution.residuals[2],
            confident_fraction=solution.confident_fraction,
            status=solution.status,
            passes=solution.passes,
            evaluations=solution.evaluations,
            seconds=time.perf_counter() - started,
        ),
    )
    rms_px, rms_percent = _inner_error(refined, pixels)
    return replace(
        refined,
        report=replace(
            fit.report,
            landmark_loss=solution.landmark_loss,
            prior_loss=solution.prior_loss,
            loss=solution.loss,
            rms_px=rms_px,
            rms_percent=rms_percent,
            seconds=fit.report.seconds + time.perf_counter() - started,
        ),
    )


def _checked_mask(mask: ArrayLike | None, shape: tuple[int, ...]) -> NDArray[np.float32] | None:
    if mask is None:
        return None
    given = np.asarray(mask)
    if given.shape != shape:
        raise ValueError(f"mask: expected shape {shape} like the picture, got {given.shape}")
    if given.dtype.kind not in "bf":
        raise ValueError(f"mask: expected bool or float, got {given.dtype}")
    if not ((given >= 0) & (given <= 1)).all():
        raise ValueError("mask: expected values in [0, 1], got others or NaN")
    return given.astype(np.float32)


def _inner_error(fit: FaceFit, pixels: Floats) -> tuple[float, float]:
    """RMS of the inner landmarks that are there, in px and in percent of the distance of the outer eye corners."""
    fitted = fit.project(fit.vertices[fit.landmark_vertices])
    squares = ((fitted - pixels)[INNER] ** 2).sum(axis=1)
    right, left = np.where(np.isfinite(pixels), pixels, fitted)[list(OUTER_EYES)]
    there = np.isfinite(squares)
    rms = float(np.sqrt(squares[there].mean())) if there.any() else float("nan")
    return rms, 100 * rms / float(np.linalg.norm(left - right))
