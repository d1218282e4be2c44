"""How well a face is known where nobody said how it is."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from toongeo.metrics import landmark_error
from toongeo.metrics.outer_eye_distance import outer_eye_distance
from toongeo.model import MorphableModel
from toongeo.model.ibug68 import INNER
from toongeo.pipeline.align.align_face import AlignedFace, align_face
from toongeo.pipeline.fit import FaceFit, fit_3dmm

__all__ = ["held_out_errors"]

_FOLDS = 4  # each leaves out every fourth inner point, whose neighbours on both sides stay


def held_out_errors(
    img: np.ndarray | None,
    landmarks: np.ndarray,
    *,
    model: MorphableModel | None = None,
    align: Callable[[FaceFit, np.ndarray], AlignedFace] | None = None,
) -> dict[str, float]:
    """Landmark error of points that a face was not fitted and aligned to, by leave-some-out cross-validation.

    The face of all landmarks goes through them, whatever it is: its error is forced. Here every fourth of the inner
    points is left out in turn, the face is fitted and aligned to the others, and tells where the left ones are. The
    jaw is not left out, since its points slide along the outline.

    Parameters
    ----------
    img : (H, W, 3) uint8 RGB or None
    landmarks : (68, 2) float, px
        NaN rows are missing.
    model : MorphableModel, optional
    align : (fit, landmarks) -> AlignedFace, optional
        Another way to align, such as that of caricatures; :func:`toongeo.align_face` without an estimate of noise
        unless given.

    Returns
    -------
    dict of str to float
        RMS by part of the inner points, and of all (``inner51``), as a fraction of the outer-eye distance; NaN for
        a part that has none.

    Raises
    ------
    ValueError
        As :func:`toongeo.fit_3dmm`; too few points may be left.

    Examples
    --------
    >>> from toongeo.io import read_landmarks
    >>> from toongeo.model import data_path
    >>> points = read_landmarks(data_path("examples/portraits/moustache_man.pts"))
    >>> 0.002 < held_out_errors(None, points)["inner51"] < 0.03
    True
    """
    found = np.full(landmarks.shape, np.nan)
    for k in range(_FOLDS):
        left = INNER[k::_FOLDS]
        some = np.array(landmarks, np.float64)
        some[left] = np.nan
        fit = fit_3dmm(img, some, model=model)
        face = align_face(fit, some, noise=0) if align is None else align(fit, some)
        found[left] = face.project(face.vertices[face.landmark_vertices[left]])
    errors = landmark_error(found, landmarks, scale=outer_eye_distance(landmarks, found))
    return {part: error for part, error in errors.items() if part not in ("jaw", "total")}
