"""What can be set in a photometric fit."""

from __future__ import annotations

from dataclasses import dataclass, fields

from toongeo.pipeline.fit.check_positive import check_positive

__all__ = ["PhotometricOptions"]

_COUNTED = ("passes", "steps", "max_evaluations", "samples")


@dataclass(frozen=True)
class PhotometricOptions:
    """Weights and limits of `photometric_fit`; the defaults were found on rendered faces of known shape.

    Attributes
    ----------
    independent_samples : float
        How many independent observations a picture is worth that the model explains to within ``noise``: the N of
        ``w_p = w_r N (noise / s) / s^2`` in Eq. 3 (Pan et al. 2024), where the standard deviation s of the
        residuals is estimated in each pass. So a picture that the model explains well counts much, a drawing
        little. N is far below the number of samples, because the errors of a rendering are alike over whole regions.
        Clean photographs of people bear 100, with 8 passes and a ``blur`` of 1 mm, which bends drawings by
        millimetres; more than that makes faces worse again.
    noise : float
        Least standard deviation of a residual, sRGB (0..1), for each channel.
    albedo_weight : float
        ``w_r w_tex / w_p``: the drop in mean squared residual for which a coefficient of the albedo may grow to one
        standard deviation. Unlike the shape's, it does not depend on how well the picture is explained.
    light_weight : float
        Ridge on the light's degrees 1 and 2, as a part of what the samples say about it, for a picture explained to
        within ``noise``; it grows with the misfit, so that light does not run wild where a face is in shadow.
    passes : int
        How often visibility, normals and robust weights are computed anew.
    samples : int
        About how many points of the face are compared.
    resolution : float, mm
        Pixel of the resampled picture. 0.6 makes a face about 320 px high.
    blur : float, mm
        Standard deviation of the Gaussian that the picture is smoothed by: about the distance of the samples.
    steps : int
        Gauss-Newton steps in a pass.
    tolerance : float
        Relative change of the quadratic model of the loss at which the optimizer stops.
    max_evaluations : int
        Of that model, in one step.

    Raises
    ------
    ValueError
        If one of them is not a finite positive number.

    Examples
    --------
    >>> import toongeo as tg
    >>> tg.PhotometricOptions(independent_samples=100.0, passes=8).passes  # for clean photographs of people
    8
    >>> tg.PhotometricOptions(blur=0.0)
    Traceback (most recent call last):
    ...
    ValueError: blur: expected a finite number > 0, got 0.0
    """

    independent_samples: float = 20.0
    noise: float = 0.003
    albedo_weight: float = 3e-6
    light_weight: float = 1e-5
    passes: int = 4
    samples: int = 1500
    resolution: float = 0.6
    blur: float = 0.6
    steps: int = 1
    tolerance: float = 1e-7
    max_evaluations: int = 300

    def __post_init__(self) -> None:
        for field in fields(self):
            check_positive(field.name, getattr(self, field.name), whole=field.name in _COUNTED)
