"""Where a fit is better refined by the picture."""

import numpy as np
from numpy.typing import NDArray

from toongeo.pipeline.fit.face_fit import FaceFit
from toongeo.pipeline.fit.photometric_options import PhotometricOptions
from toongeo.pipeline.landmarks.looks_photographed import looks_photographed

__all__ = ["photometric_choice"]

# Of the inner landmarks, in percent of the outer-eye distance: people are met within 3, as a rule (rendered scans with
# a pixel of noise, 1.5 to 2.9), faces that are drawn or carved as no person looks hardly ever within 5.
_PERSON = 4.0


def photometric_choice(img: NDArray[np.uint8], fit: FaceFit) -> PhotometricOptions | None:
    """How `photometric_fit` shall go on from a fit to landmarks; None if the landmarks are better left alone.

    In photographs of people shading tells of the shape: of rendered scans it is truer by eight standard errors of the
    gain. In drawings, and in faces that the model meets badly, it bends the shape by millimetres.

    Parameters
    ----------
    img : (H, W, 3) uint8
    fit : FaceFit
        Of :func:`toongeo.fit_3dmm`.
    """
    if not fit.model.has("albedo") or not fit.report.rms_percent <= _PERSON:
        return None
    points = fit.project(fit.vertices[fit.landmark_vertices])
    return PhotometricOptions(independent_samples=50.0, passes=8) if looks_photographed(img, points) else None
