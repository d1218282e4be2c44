"""What can be set in a photometric fit."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

__all__ = ["PhotometricOptions"]

_COUNTED = ("passes", "max_evaluations", "samples")


@dataclass(frozen=True)
class PhotometricOptions:
    """Weights and limits of `photometric_fit`; the defaults were found on rendered faces of known shape.

    Attributes
    ----------
    photometric_weight : float
        ``w_p / w_r`` of Eq. 3 (Pan et al. 2024). Residuals are sRGB, 0..1. With independent samples it would be
        their number over twice the variance of one; the errors of a rendering are strongly correlated, so the
        number is that of a few hundred.
    albedo_weight : float
        ``w_tex`` of Eq. 6.
    light_weight : float
        Ridge on the light's degrees 1 and 2, as a part of what the samples say about it.
    robust : float
        Residual (sRGB, root of the sum over channels) from which a sample counts as an outlier, or more where most
        samples differ by more: the scale of Geman and McClure's loss.
    passes : int
        How often visibility, normals and robust weights are computed anew.
    samples : int
        About how many points of the face are compared.
    resolution : float, mm
        Pixel of the resampled picture. 0.6 makes a face about 320 px high.
    blur : float, mm
        Standard deviation of the Gaussian that the picture is smoothed by: about the distance of the samples.
    tolerance : float
        Relative change of the loss at which a pass stops.
    max_evaluations : int
        Of the loss, in one pass.

    Raises
    ------
    ValueError
        If one of them is not a finite positive number.
    """

    photometric_weight: float = 2e4
    albedo_weight: float = 1.0
    light_weight: float = 1e-3
    robust: float = 0.12
    passes: int = 5
    samples: int = 3000
    resolution: float = 0.6
    blur: float = 1.0
    tolerance: float = 1e-5
    max_evaluations: int = 15

    def __post_init__(self) -> None:
        for field in fields(self):
            value = getattr(self, field.name)
            if field.name in _COUNTED and not (isinstance(value, int) and value >= 1):
                raise ValueError(f"{field.name}: expected an integer >= 1, got {value!r}")
            if not (np.isfinite(value) and value > 0):
                raise ValueError(f"{field.name}: expected a finite number > 0, got {value!r}")
