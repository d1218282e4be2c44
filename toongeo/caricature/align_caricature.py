"""A caricature as the face that later stages work on."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from toongeo.caricature.caricature_fit import CaricatureFit
from toongeo.caricature.fit_caricature import fit_caricature
from toongeo.pipeline.align.align_face import AlignedFace, AlignReport
from toongeo.pipeline.fit.face_fit import FaceFit

__all__ = ["align_caricature", "aligned", "caricature_of"]


def align_caricature(fit: FaceFit, landmarks: NDArray[np.float64]) -> AlignedFace:
    """Deform a fitted face onto its landmarks in the deformation space: `fit_caricature` in the place of `align_face`.

    The camera of the result is that of the caricature, which is not that of the fit.

    Parameters
    ----------
    fit : FaceFit
        With a scaled orthographic camera.
    landmarks : (68, 2) float, px
        NaN rows are missing.

    Raises
    ------
    ValueError
        As `fit_caricature`.
    """
    return aligned(caricature_of(fit, landmarks))


def caricature_of(fit: FaceFit, landmarks: NDArray[np.float64]) -> CaricatureFit:
    """`fit_caricature` from a fit; the last one is kept, since alignment and rig ask for the same."""
    points = np.ascontiguousarray(landmarks, np.float64)
    return _kept(fit, points.tobytes())


@lru_cache(maxsize=1)
def _kept(fit: FaceFit, points: bytes) -> CaricatureFit:
    return fit_caricature(None, np.frombuffer(points).reshape(-1, 2), start=fit)


def aligned(face: CaricatureFit) -> AlignedFace:
    """A caricature with the report of an aligned face, for rig, eyes and texture."""
    report = AlignReport(face.report.rms_px, face.report.max_px, face.report.seconds)
    return AlignedFace(face.vertices, face.camera, face.landmark_vertices, face.model, face.fit, report)
