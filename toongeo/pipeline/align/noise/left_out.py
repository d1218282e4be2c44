"""What a Gaussian process foretells of each point from all others."""

import numpy as np

from toongeo.arrays import Floats
from toongeo.geometry.one_thread import one_thread

__all__ = ["left_out"]


def left_out(covariance: Floats, observed: Floats) -> tuple[Floats, Floats]:
    """How far each point lies from where the others put it, and how odd that is.

    With ``B = C^-1``, the part of B that belongs to point i, ``B_ii``, and ``f = B y``, what the others foretell misses
    the observation by ``B_ii^-1 f_i``, with the covariance ``B_ii^-1``: no system is solved anew for any point.

    Parameters
    ----------
    covariance : (2 k, 2 k) float
        C, of field and noise together.
    observed : (k, 2) float

    Returns
    -------
    missed : (k, 2) float64
        Observed less foretold.
    z : (k,) float64
        Length of that in standard deviations, by its covariance (Mahalanobis).

    References
    ----------
    C. Rasmussen, C. Williams, "Gaussian Processes for Machine Learning", 2006, section 5.4.2.
    """
    k = len(observed)
    with one_thread():
        inverse = np.linalg.inv(covariance)
        forces = (inverse @ observed.ravel()).reshape(k, 2)
    own = inverse.reshape(k, 2, k, 2)[np.arange(k), :, np.arange(k)]
    missed = np.linalg.solve(own, forces[..., None])[..., 0]
    return missed, np.sqrt(np.einsum("ka,ka->k", forces, missed))
