"""What can be set in a caricature fit.

Constants were chosen on the seven examples and eight caricatures (``toongeo bench caricature``).
"""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from toongeo.pipeline.align.denoise_landmarks import Noise, check_noise

__all__ = ["CaricatureOptions"]


@dataclass(frozen=True)
class CaricatureOptions:
    """Weights and limits of `fit_caricature` beside those it names itself.

    Attributes
    ----------
    looseness : float
        Of the smooth map by which the face follows the mesh of the weights (`smooth_warp`); 0 interpolates the skin of
        that mesh at two hundred places.
    smoothness : float
        Weight of ``tr(r^T L^2 r)`` against ``tr(r^T L r)``, where ``r`` is what the landmarks add to the face that has
        flowed to them and L the cotangent Laplacian. 0 is the P'-step of the paper, which leaves a spike at each
        landmark.
    rim_weight : float
        Weight of the rims of lips and lids between the landmarks, whose displacement is interpolated, as a fraction
        of the landmarks' weight; 0 leaves them free.
    ridge : float
        Weight of ``|w|^2`` (of the change of w, with a caricature to start from) in the w-step, as a fraction of the
        mean diagonal entry of its Gauss-Newton matrix (of the scale/shear part). 0 is the paper's.
    tolerance : float
        Relative fall of E_def below which the alternation stops.
    steps : int
        Of Levenberg-Marquardt in a w-step; the next P'-step moves its target anyway.
    tuck : bool
        Whether mouth and sockets are pushed back where they come through the skin. Takes a tenth of a second.

    noise : "auto" or float
        Of the landmarks: see :func:`toongeo.align_face`.

    Raises
    ------
    ValueError
        If a number is negative or not finite, ``steps`` is below 1, or the noise is neither "auto" nor a number.

    Examples
    --------
    >>> import toongeo as tg
    >>> tg.CaricatureOptions(smoothness=0.0, ridge=0.0).steps  # nearer to the paper
    3
    >>> tg.CaricatureOptions(steps=0)
    Traceback (most recent call last):
    ...
    ValueError: steps: expected at least 1, got 0
    """

    looseness: float = 0.01
    smoothness: float = 100.0
    rim_weight: float = 0.01
    ridge: float = 1.0
    tolerance: float = 1e-2
    steps: int = 3
    tuck: bool = True
    noise: Noise = "auto"

    def __post_init__(self) -> None:
        for option in fields(self):
            value = getattr(self, option.name)
            if option.name != "noise" and not (np.isfinite(value) and value >= 0):
                raise ValueError(f"{option.name}: expected a finite number >= 0, got {value}")
        check_noise(self.noise)
        if self.steps < 1:
            raise ValueError(f"steps: expected at least 1, got {self.steps}")
