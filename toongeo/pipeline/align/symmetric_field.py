"""Smooth displacement fields of a face that are likely when left and right move alike.

Constants were chosen on the seven examples and 15 caricatures (``benchmarks/alignment.py``).
"""

from dataclasses import dataclass

import numpy as np
from scipy.spatial.distance import cdist

from toongeo.geometry.one_thread import one_thread

__all__ = ["FieldPrior", "MIRROR", "field_covariance", "most_likely_field", "observed_covariance"]

MIRROR = np.array([-1.0, 1.0, 1.0])  # the sagittal plane of the model frame is x = 0


@dataclass(frozen=True)
class FieldPrior:
    """Gaussian process over displacement fields of a face; lengths are in outer-eye distances.

    Attributes
    ----------
    reach : float
        Correlation length.
    linear : float
        Variance of the affine part, per unit of squared length.
    asymmetry : float in [0, 1]
        Variance of the part that moves left and right unlike, as a share of that which moves them alike.
    growth : float in [0, 1)
        0: the three components are independent. 1: fields without curl, which swell and shrink alike in all
        directions. In between, what grows in the picture plane also grows in depth.
    noise : float
        Variance by which an observation may be missed.
    """

    reach: float = 0.5
    linear: float = 4.0
    asymmetry: float = 0.07
    growth: float = 0.3
    noise: float = 1e-3


def most_likely_field(
    at: np.ndarray, points: np.ndarray, jacobians: np.ndarray, observed: np.ndarray, prior: FieldPrior
) -> np.ndarray:
    """Displacements of points (n, 3) when those at k places were seen in projection.

    The posterior mean of a Gaussian process (kriging) with the kernel of :func:`field_covariance`.

    Parameters
    ----------
    at : (n, 3) float, outer-eye distances, model frame
    points : (k, 3) float
        Where the field was observed.
    jacobians : (k, 2, 3) float
        What is seen of a displacement u: ``jacobians @ u``. Rows of about unit length.
    observed : (k, 2) float
    prior : FieldPrior

    Returns
    -------
    (n, 3) float64
    """
    k = len(points)
    with one_thread():
        seen = observed_covariance(points, jacobians, prior)
        forces = np.linalg.solve(seen + prior.noise * np.eye(2 * k), observed.ravel()).reshape(k, 2)
        pushes = np.einsum("iac,ia->ic", jacobians, forces)
        alike, unlike = _shares(prior)
        return _push(at, points, alike * pushes, prior) + _push(at, points * MIRROR, unlike * pushes * MIRROR, prior)


def observed_covariance(points: np.ndarray, jacobians: np.ndarray, prior: FieldPrior) -> np.ndarray:
    """Covariance (2 k, 2 k) of what is seen of the field at k places, without noise."""
    size = 2 * len(points)
    K = field_covariance(points, points, prior)
    return np.einsum("iac,ijcd,jbd->iajb", jacobians, K, jacobians, optimize=True).reshape(size, size)


def field_covariance(X: np.ndarray, Y: np.ndarray, prior: FieldPrior) -> np.ndarray:
    """Covariance (n, k, 3, 3) of the displacements at points X (n, 3) and Y (k, 3).

    With ``r = x - y`` and ``a = sqrt(3) / reach``,
    ``K(x, y) = (1 + a r) exp(-a r) I - growth a^2 exp(-a r) r r^T`` plus that of a random affine map. For ``growth``
    0 this is Matern's kernel of smoothness 3/2 in each component, for 1 the Hessian of that of 5/2. The field
    u(x) + M u(M x), with M the mirror, is symmetric and has the covariance ``2 K(x, y) + 2 K(x, M y) M``.
    """
    alike, unlike = _shares(prior)
    return alike * _covariance(X, Y, prior) + unlike * _covariance(X, Y * MIRROR, prior) * MIRROR


def _shares(prior: FieldPrior) -> tuple[float, float]:
    return (1 + prior.asymmetry) / 2, (1 - prior.asymmetry) / 2


def _covariance(X: np.ndarray, Y: np.ndarray, prior: FieldPrior) -> np.ndarray:
    a, c = np.sqrt(3) / prior.reach, prior.growth
    r = X[:, None] - Y
    scaled = a * np.linalg.norm(r, axis=2)
    fade = np.exp(-scaled)
    isotropic = (1 + scaled) * fade + prior.linear * (1 + (1 - 2 * c / 3) * (X @ Y.T))
    outer = -(a**2) * fade[..., None, None] * r[..., :, None] * r[..., None, :]
    both = Y[None, :, :, None] * X[:, None, None, :] + X[:, None, :, None] * Y[None, :, None, :]
    return isotropic[..., None, None] * np.eye(3) + c * (outer + prior.linear / 3 * both)


def _push(X: np.ndarray, Y: np.ndarray, W: np.ndarray, prior: FieldPrior) -> np.ndarray:
    """``sum_j K(x_i, y_j) w_j`` (n, 3) without the 3x3 blocks."""
    a, c = np.sqrt(3) / prior.reach, prior.growth
    scaled = cdist(X, Y)  # large, so it is worked on where it lies
    scaled *= a
    fade = np.negative(scaled)
    np.exp(fade, out=fade)
    scaled += 1
    scaled *= fade
    pushed = scaled @ W
    along = X @ W.T
    along -= (Y * W).sum(1)
    along *= fade
    pushed -= c * a**2 * (X * along.sum(1)[:, None] - along @ Y)
    pushed += prior.linear * (W.sum(0) + (1 - 2 * c / 3) * (X @ (Y.T @ W)))
    return pushed + prior.linear * c / 3 * (X @ (W.T @ Y) + X * (Y * W).sum())
