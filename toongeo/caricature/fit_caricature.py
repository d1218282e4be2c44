"""A 3D caricature from the landmarks of a picture."""

from __future__ import annotations

import time

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toongeo.caricature.alternation import WEIGHT, Alternation
from toongeo.caricature.caricature_fit import CaricatureFit, CaricatureReport
from toongeo.caricature.caricature_options import CaricatureOptions
from toongeo.caricature.inner_parts import with_inner_parts
from toongeo.caricature.space.face_space import FaceSpace, face_space
from toongeo.io.check_image import check_image
from toongeo.io.check_landmarks import check_landmarks
from toongeo.pipeline.fit.face_fit import FaceFit
from toongeo.pipeline.fit.ibug_landmarks import ibug_landmarks

__all__ = ["fit_caricature"]


def fit_caricature(
    img: NDArray[np.uint8] | None,
    landmarks: ArrayLike,
    *,
    space: FaceSpace | None = None,
    weight: float = WEIGHT,
    iterations: int = 4,
    start: CaricatureFit | FaceFit | None = None,
    options: CaricatureOptions | None = None,
    scheme: str = "ibug68",
) -> CaricatureFit:
    """A face as exaggerated as its landmarks ask for (Wu et al. 2018, Algorithm 1).

    Minimizes ``E_def(P', w) + weight * E_lan / s^2`` (Eq. 14) over the mesh P' and the weights w of a deformation
    space made of ordinary faces, in turns: the weights that explain the mesh (Eq. 9); the pose and the silhouette's
    landmark vertices for the face of w (Eq. 13); the mesh between T(w) and the landmarks (Eq. 15).

    Three things differ from the paper, because its energy alone folds lips and lids, makes a spike of each landmark,
    and predicts badly what no landmark shows. It begins with the mesh that `align_face` gives instead of w = 0. A
    P'-step does not take the mesh of w as it is, whose lips and lids can pass through each other: the aligned face
    follows it by a smooth map of space (`looseness` in the options), and flows on to the landmarks by the likeliest
    motion when left and right move alike; what is then left of the way, next to nothing, is closed by the energy
    (with `smoothness`). And `ridge` keeps weights small that the landmarks do not tell.

    Parameters
    ----------
    img : (H, W, 3) uint8 RGB or None
        Only its size is looked at, to check the landmarks against.
    landmarks : (68, 2) array_like, px
        iBUG-68 order; x right, y down, integer = pixel centre. NaN rows are missing.
    space : FaceSpace, optional
        `face_space` of the default model, or that of ``start``, if None.
    weight : float > 0
        Lambda of Eq. 14. The paper's, 0.01, mixes px^2 with the model's unit; here E_lan is measured in (px / s)^2,
        with the camera's scale s in px/mm, so that both terms are mm^2 and the picture's resolution changes nothing.
        The default leaves about a hundredth of a millimetre.
    iterations : int
        P'-steps, at most. It ends earlier when E_def falls by less than the tolerance of the options; if it rises, as
        another silhouette can make it, the step before is the result.
    start : CaricatureFit or FaceFit, optional
        Of a caricature: go on from it with its weights, its camera and its landmark vertices, keeping also what its
        space does not explain. The same landmarks give nearly the same face, and with one iteration a new expression
        takes a third of a second. Of an ordinary face: begin with this one instead of the `fit_3dmm` of the landmarks.
    options : CaricatureOptions, optional
    scheme : str
        What the landmarks are: see :func:`toongeo.ibug_landmarks`.

    Returns
    -------
    CaricatureFit

    Raises
    ------
    ValueError
        If the picture is not (H, W, 3) uint8; if the landmarks have another shape, hold infinities, are fewer than 6,
        lie on a line or outside the picture; if weight or iterations are not positive; or if ``start`` is of another
        space or model, or has a perspective camera.

    References
    ----------
    Wu, Zhang, Lai, Zheng, Cai 2018, "Alive caricature from 2D to 3D".

    Examples
    --------
    >>> import numpy as np
    >>> from toongeo.model import default_model
    >>> from toongeo.render import ScaledOrthographicCamera
    >>> model = default_model()
    >>> points = ScaledOrthographicCamera.look(yaw=20.0).project(model.mean[model.landmarks])
    >>> fit = fit_caricature(None, points * [1.0, 1.3], iterations=2)
    >>> fit.report.rms_px < 0.03
    True
    """
    started = time.perf_counter()
    if img is not None:
        check_image(img)
    pixels = ibug_landmarks(landmarks, scheme)
    warnings = check_landmarks(pixels, None if img is None else img.shape)
    if not (np.isfinite(weight) and weight > 0):
        raise ValueError(f"weight: expected a finite number > 0, got {weight}")
    if iterations < 1:
        raise ValueError(f"iterations: expected at least 1, got {iterations}")
    if space is None:
        space = start.space if isinstance(start, CaricatureFit) else face_space(start.model if start else None)
    solver = Alternation(space, pixels, weight, CaricatureOptions() if options is None else options)
    state = solver.resumed(start) if isinstance(start, CaricatureFit) else solver.first(start)
    P, state, energies, converged = solver.run(state, iterations)
    V = with_inner_parts(space, state.before, P, tuck=solver.options.tuck)
    error = np.linalg.norm((state.camera.project(V[state.landmarks]) - pixels)[solver.seen], axis=1)
    report = CaricatureReport(
        iterations=len(energies),
        converged=converged,
        rms_px=float(np.sqrt((error**2).mean())),
        max_px=float(error.max()),
        warnings=tuple(warnings),
        seconds=time.perf_counter() - started,
    )
    return CaricatureFit(V, state.w, tuple(energies), state.camera, state.landmarks, space, state.fit, report)
