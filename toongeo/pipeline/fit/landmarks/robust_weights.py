"""How far each landmark is believed, from how far off it lies.

Constants were chosen on heads of known shape and ten pictures (``benchmarks/truth3d.py``, ``benchmarks/landmarks.py``).
"""

from __future__ import annotations

from collections.abc import Callable
from types import MappingProxyType

import numpy as np

from toongeo.arrays import Floats

__all__ = ["KERNELS", "SETTLED", "robust_weights"]

_MEDIAN_SQUARE = 2 * np.log(2)  # of the squared length of a 2D error with unit variance a coordinate
_HUBER = 2.5  # standard deviations from which the pull of a point stops growing
# Up to _TRUSTED standard deviations a point counts in full, so that a face without outliers is that of least
# squares; beyond, the squared error is Geman-McClure's with this width.
_TRUSTED, _GEMAN_MCCLURE = 5.0, 4.0

SETTLED = 0.05  # weights that change by less between passes are settled


def _huber(t: Floats) -> Floats:
    return 1 / np.sqrt(np.maximum(t / _HUBER**2, 1.0))


def _geman_mcclure(t: Floats) -> Floats:
    return 1 / (1 + np.maximum(t - _TRUSTED**2, 0.0) / _GEMAN_MCCLURE**2) ** 2


# Weight of a point whose squared error is t variances: rho'(t) of the kernel rho.
KERNELS: MappingProxyType[str, Callable[[Floats], Floats]] = MappingProxyType(
    {"huber": _huber, "geman-mcclure": _geman_mcclure}
)


def robust_weights(squares: Floats, kernel: str | None, least_variance: float) -> Floats:
    """Weights (k,) in (0, 1] of points with squared errors (k,): iteratively reweighted least squares.

    The kernel is as wide as the errors are: its variance comes from their median, which a few gross errors
    hardly move. A caricature misses most of its points, its median is large, and none of them is an outlier;
    five wrong points on a face that else fits are.

    Parameters
    ----------
    squares : (k,) float
        Squared errors; a NaN belongs to a point that weighs nothing and gets the weight 1.
    kernel : str or None
        A name of `KERNELS`, or None for least squares: all ones.
    least_variance : float
        Variance a coordinate that is expected in any case; an error of this size is never an outlier, however
        well the other points fit.

    References
    ----------
    P. J. Huber, "Robust estimation of a location parameter", Ann. Math. Statist. 35, 1964. S. Geman,
    D. McClure, "Statistical methods for tomographic image reconstruction", Bull. ISI 52, 1987.

    Examples
    --------
    >>> robust_weights(np.array([1.0, 1.0, 1.0, 1e4]), "huber", 0.0).round(3)
    array([1.   , 1.   , 1.   , 0.021])
    """
    there = np.isfinite(squares)
    weights = np.ones(len(squares))
    if kernel is None or not there.any():
        return weights
    variance = max(float(np.median(squares[there])) / _MEDIAN_SQUARE, least_variance)
    if variance > 0:
        weights[there] = KERNELS[kernel](squares[there] / variance)
    return weights
