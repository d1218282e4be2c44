"""How likely observed displacements are, by the size of the field and that of the noise."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq

from toongeo.arrays import Floats
from toongeo.geometry.one_thread import one_thread

__all__ = ["FieldLikelihood"]

_LEAST, _MOST = 0.005, 0.7  # of the noise, per amplitude of the field; more makes heads of the model's mean alone
_GRID = 40
_AMPLITUDES = 1e-3, 2.0  # outer-eye distances: from a face of the model to a head that is twice as large


@dataclass(frozen=True, eq=False)
class FieldLikelihood:
    """Marginal likelihood of n observations y of a Gaussian process with noise.

    The field has the covariance ``a^2 K`` at the places of the observations, the noise has the variance ``sigma^2``,
    and both are Gaussian, so y is Gaussian too, with the covariance ``C = a^2 K + sigma^2 I``. What lies behind
    the field is integrated out: only the two numbers are left. With the eigenvectors ``K = Q diag(lambda) Q^T`` and
    ``z = Q^T y`` the covariance of z is diagonal, ``c_i = a^2 lambda_i + sigma^2``, and the negative logarithm of the
    likelihood is, but for a constant,

        ``L(a, sigma) = 1/2 sum_i (log c_i + z_i^2 / c_i)``.

    By ``dL/dc_i = 1/2 (1 / c_i - z_i^2 / c_i^2)`` and the chain rule,

        ``dL/dlog a = sum_i (1 / c_i - z_i^2 / c_i^2) a^2 lambda_i``,
        ``dL/dlog sigma = sum_i (1 / c_i - z_i^2 / c_i^2) sigma^2``.

    For a given ratio ``s = sigma / a`` the best amplitude is ``a^2 = 1/n sum_i z_i^2 / (lambda_i + s^2)``; there the
    derivatives add up to 0. Along the curve of these pairs the derivative by ``log s`` therefore is ``dL/dlog sigma``.

    Attributes
    ----------
    eigenvalues : (n,) float64
        Of K, not negative.
    coordinates : (n,) float64
        z.

    References
    ----------
    C. Rasmussen, C. Williams, "Gaussian Processes for Machine Learning", 2006, section 5.4.1.
    """

    eigenvalues: Floats
    coordinates: Floats

    @classmethod
    def of(cls, covariance: Floats, observed: Floats) -> "FieldLikelihood":
        """Of observations (n,) of a field with covariance (n, n)."""
        with one_thread():
            eigenvalues, vectors = np.linalg.eigh(covariance)
            return cls(eigenvalues.clip(0), vectors.T @ observed)

    def value_and_gradient(self, amplitude: float, sigma: float) -> tuple[float, Floats]:
        """L and its derivatives (2,) by log a and log sigma."""
        c = amplitude**2 * self.eigenvalues + sigma**2
        squared = self.coordinates**2
        slope = 1 / c - squared / c**2
        by_amplitude, by_sigma = amplitude**2 * slope @ self.eigenvalues, sigma**2 * slope.sum()
        return float((np.log(c) + squared / c).sum() / 2), np.array([by_amplitude, by_sigma])

    def most_likely(self) -> tuple[float, float]:
        """Amplitude and sigma of the least L, with sigma between 0.005 and 0.7 times the amplitude."""

        def pair(log_ratio: float) -> tuple[float, float]:
            ratio = np.exp(log_ratio)
            amplitude = np.sqrt((self.coordinates**2 / (self.eigenvalues + ratio**2)).mean())
            return float(amplitude), float(ratio * amplitude)

        if not self.coordinates.any():
            return 0.0, 0.0
        return pair(self._least(pair, _LEAST, _MOST, 1))

    def amplitude_for(self, sigma: float) -> float:
        """The amplitude of the least L for a known sigma > 0."""

        def pair(log_amplitude: float) -> tuple[float, float]:
            return float(np.exp(log_amplitude)), sigma

        return pair(self._least(pair, *_AMPLITUDES, 0))[0]

    def _least(self, pair: Callable[[float], tuple[float, float]], least: float, most: float, by: int) -> float:
        """Where along a curve of pairs L is least: the best of a grid, then the root of the derivative beside it."""
        grid = np.linspace(np.log(least), np.log(most), _GRID)
        best = int(np.argmin([self.value_and_gradient(*pair(x))[0] for x in grid]))

        def slope(x: float) -> float:
            return float(self.value_and_gradient(*pair(x))[1][by])

        for low, high in ((best - 1, best), (best, best + 1)):
            if low >= 0 and high < _GRID and slope(grid[low]) < 0 < slope(grid[high]):
                return float(brentq(slope, grid[low], grid[high]))
        return float(grid[best])
