"""One identity for several pictures of a person."""

from collections.abc import Sequence

from toongeo.app.making.make_options import MakeOptions
from toongeo.arrays import Bytes, Floats
from toongeo.pipeline import FaceFit, denoise_landmarks, fit_3dmm_together

__all__ = ["same_person"]


def same_person(imgs: Sequence[Bytes], landmarks: Sequence[Floats], options: MakeOptions) -> tuple[FaceFit, ...]:
    """Fits with one identity, to landmarks (68, 2) px without what is plainly noise in them.

    Raises
    ------
    ValueError
        As :func:`toongeo.fit_3dmm_together`.
    """
    fits = fit_3dmm_together(imgs, landmarks, model=options.model)
    cleaned = [denoise_landmarks(fit, points, options.noise) for fit, points in zip(fits, landmarks, strict=True)]
    if not any(points.change for points in cleaned):
        return fits
    return fit_3dmm_together(imgs, [points.points for points in cleaned], model=options.model)
