"""The fit, refined by the picture or not."""

from typing import Literal

import numpy as np
from numpy.typing import NDArray

from toongeo.arrays import Floats
from toongeo.pipeline import FaceFit, PhotometricOptions, photometric_fit
from toongeo.pipeline.fit.photometric_choice import photometric_choice

__all__ = ["Photometric", "check_photometric", "refined", "refinement"]

Photometric = bool | Literal["auto"]


def check_photometric(photometric: Photometric) -> None:
    """Refuse what is neither."""
    if photometric not in (True, False, "auto"):
        raise ValueError(f"photometric: expected True, False or 'auto', got {photometric!r}")


def refinement(img: NDArray[np.uint8], fit: FaceFit, photometric: Photometric) -> PhotometricOptions | None:
    """How the picture refines a fit: as it is asked for, with "auto" as `photometric_choice` says; None: not at all."""
    if photometric == "auto":
        return photometric_choice(img, fit)
    return PhotometricOptions() if photometric else None


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
