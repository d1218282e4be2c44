"""The fit, refined by the picture or not."""

from typing import Literal

import numpy as np
from numpy.typing import NDArray

from toongeo.arrays import Floats
from toongeo.pipeline import FaceFit, PhotometricOptions, photometric_fit
from toongeo.pipeline.landmarks.looks_photographed import looks_photographed

__all__ = ["Photometric", "check_photometric", "refined", "refinement"]

Photometric = bool | Literal["auto"]

# Of the inner landmarks, in percent of the outer-eye distance: people are met within 3, as a rule (rendered scans with
# a pixel of noise, 1.5 to 2.9), faces that are drawn or carved as no person looks hardly ever within 5.
_PERSON = 4.0
# Half of the evidence that serves rendered scans best: with all of it the landmarks of one portrait of three are met
# worse by 0.03 %.
_PHOTOGRAPHS = PhotometricOptions(independent_samples=50.0, passes=8, blur=1.0)


def check_photometric(photometric: Photometric) -> None:
    """Refuse what is neither."""
    if photometric not in (True, False, "auto"):
        raise ValueError(f"photometric: expected True, False or 'auto', got {photometric!r}")


def refinement(img: NDArray[np.uint8], fit: FaceFit, photometric: Photometric) -> PhotometricOptions | None:
    """How the picture refines a fit to landmarks; None: not at all.

    With "auto" it does in photographs of people, where shading tells of the shape: of rendered scans it is truer by
    eight standard errors of the gain. In drawings, and in faces that the model meets badly, it would bend the shape by
    millimetres.
    """
    if photometric != "auto":
        return PhotometricOptions() if photometric else None
    if not fit.model.has("albedo") or not fit.report.rms_percent <= _PERSON:
        return None
    points = fit.project(fit.vertices[fit.landmark_vertices])
    return _PHOTOGRAPHS if looks_photographed(img, points) else None


def refined(
    img: NDArray[np.uint8], fit: FaceFit, landmarks: Floats, options: PhotometricOptions, *, asked: bool
) -> FaceFit:
    """`photometric_fit`; if it fails, as where no skin is seen, whoever did not ask for it keeps the fit."""
    try:
        return photometric_fit(img, fit, landmarks, options=options)
    except (ValueError, RuntimeError):
        if asked:
            raise
        return fit
