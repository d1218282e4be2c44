"""A caricature of a fitted face.

Constants were chosen on the seven examples and eight caricatures (``toongeo bench caricature``).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from toongeo.caricature.caricature_fit import CaricatureFit, CaricatureReport
from toongeo.caricature.inner_parts import with_inner_parts
from toongeo.caricature.space.face_space import FaceSpace, face_space
from toongeo.geometry.rotations.similarity import similarity
from toongeo.pipeline.fit.face_fit import FaceFit

__all__ = ["exaggerate"]

_STEPS = 10  # of Levenberg-Marquardt at most
_RIDGE = 1e-2  # what differs from the mean is explained by small weights, which extrapolate


def exaggerate(fit: FaceFit | CaricatureFit, amount: float, *, space: FaceSpace | None = None) -> CaricatureFit:
    """Push a face away from the mean face: what makes it differ is extrapolated in the deformation space.

    Of a `FaceFit` the identity is exaggerated and the expression kept; of a caricature all that differs from the
    mean. Vertices keep their texture coordinates, so a
    texture baked for ``fit`` fits the result.

    Parameters
    ----------
    fit : FaceFit or CaricatureFit
    amount : float
        0 gives the face back, 1 doubles what differs; negative values bring it nearer to the mean (-1).
    space : FaceSpace, optional
        `face_space` of the fit's model if None.

    Returns
    -------
    CaricatureFit
        With the camera and the landmark vertices of ``fit``. The report's errors are NaN: no landmarks were fitted.

    Raises
    ------
    ValueError
        If the amount is not finite, or the space has another model than the fit.

    Examples
    --------
    >>> import toongeo as tg
    >>> from toongeo.model import data_path
    >>> landmarks = tg.read_landmarks(data_path("examples/portraits/moustache_man.pts"))
    >>> fit = tg.fit_3dmm(None, landmarks)
    >>> half = tg.exaggerate(fit, 0.5)
    >>> bool(abs(tg.exaggerate(fit, 0.0).vertices - fit.vertices).max() < 0.5)  # mm
    True
    >>> bool(abs(half.vertices - fit.vertices).max() > 1)  # mm
    True
    """
    if not np.isfinite(amount):
        raise ValueError(f"amount: expected a finite number, got {amount}")
    if space is None:
        space = fit.space if isinstance(fit, CaricatureFit) else face_space(fit.model)
    if space.model is not fit.model:
        raise ValueError("space: expected one of the model of the fit, got one of another")
    deformation, face = space.space, _upright(fit.vertices, space)
    whole = deformation.fit(face, ridge=_RIDGE, iterations=_STEPS).w
    differs, shape = whole, face
    if isinstance(fit, FaceFit):
        shape = fit.model.vertices(fit.identity)[space.vertices]
        differs = deformation.fit(shape, ridge=_RIDGE, iterations=_STEPS).w
    w = whole + amount * differs
    # What the space leaves of the difference is small, and extrapolated as a displacement.
    left = shape - deformation.vertices(differs)
    P = face + deformation.vertices(w) - deformation.vertices(whole) + amount * (left - left.mean(0))
    scale, rotation, shift = similarity(face, fit.vertices[space.vertices])
    V = with_inner_parts(space, fit.vertices, scale * P @ rotation.T + shift, tuck=amount != 0)
    report = CaricatureReport(0, True, np.nan, np.nan, (), 0.0)
    ordinary = fit.fit if isinstance(fit, CaricatureFit) else fit
    return CaricatureFit(V, w, (), fit.camera, fit.landmark_vertices, space, ordinary, report)


def _upright(V: NDArray[np.float64], space: FaceSpace) -> NDArray[np.float64]:
    """Vertices (k, 3) of the space, turned and shifted onto its reference, not scaled."""
    P = V[space.vertices]
    _, rotation, _ = similarity(P, space.space.reference)
    return (P - P.mean(0)) @ rotation.T + space.space.reference.mean(0)
