"""The weights of a deformation space that explain a mesh (Wu et al. 2018, Eq. 9-10)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import cho_factor, cho_solve

from toongeo._read_only import read_only, restored
from toongeo.arrays import Floats
from toongeo.caricature.space.deformation_representation import full, packed
from toongeo.caricature.space.encoded_shapes import EncodedShapes
from toongeo.geometry.one_thread import one_thread
from toongeo.geometry.operators.small_matrices import product
from toongeo.geometry.rotations.rotation_exp import right_jacobian, rotation_exp

__all__ = ["WeightFit", "WeightProblem"]

_TOLERANCE = 1e-6  # relative fall of the energy below which a step was the last
_FIRST_DAMPING = 1e-4  # of the diagonal of the Gauss-Newton matrix
_MOST_DAMPING = 1e8  # where a step no longer moves anything
_TWICE = packed(np.full((3, 3, 1), 2.0) - np.eye(3)[:, :, None])  # how often each of the six numbers stands in S


@dataclass(frozen=True, eq=False)
class WeightFit:
    """What fitting weights gave.

    Attributes
    ----------
    w : (2, l) float64
        Weights of rotation and of scale/shear.
    energy : float
        E_def (Eq. 9), without the ridge.
    energies : tuple of float
        What was minimized, at the start and after each step.
    converged : bool
        Whether the last step changed it by less than a millionth.
    """

    w: Floats
    energy: float
    energies: tuple[float, ...]
    converged: bool

    __setstate__ = restored

    def __post_init__(self) -> None:
        read_only(self, "w")


class WeightProblem:
    """Eq. 9 for one mesh.

    The residuals of all edges are never formed. With ring Grams ``C_i = sum_j c_ij e_ij e_ij^T`` and moments
    ``M_i = sum_j c_ij (u_i - u_j) e_ij^T`` of the displacements u, and ``D_i = T_i(w) - I``,

        E(w) = 2 tr(u^T L u) - 2 sum_i <D_i, M_i> + sum_i <D_i C_i, D_i>

    which is exact, and keeps its digits as it is made of displacements.

    Parameters
    ----------
    space : EncodedShapes
        For example a `DeformationSpace`.
    P : (n, 3) float64, checked
    """

    def __init__(self, space: EncodedShapes, P: Floats) -> None:
        u = P - space.reference
        self._space = space
        self._gram = space.rings.gram
        self._moments = space.rings.moments(u)
        self._constant = float(2 * (u * (space.rings.laplacian @ u)).sum())

    def energy(self, w: Floats) -> float:
        """E_def for weights (2, l)."""
        D = self._space.gradients(w)
        return self._energy(D, product(D, self._gram))

    def _energy(self, D: Floats, DC: Floats) -> float:
        return self._constant + float((D * (DC - 2 * self._moments)).sum())

    def gradient(self, w: Floats) -> tuple[float, Floats, Floats]:
        """E_def, half its gradient (2, l), and the Gauss-Newton matrix (2 l, 2 l) of half of it.

        The derivative of ``R = exp([phi]x)`` along ``dphi`` is ``R [J(phi) dphi]x`` with the right Jacobian J. (Eq. 10
        as printed, ``R [dphi]x``, holds only where the logarithms of all shapes commute.)
        """
        space = self._space
        phi, sigma = space.fields(w)
        R, J, S = rotation_exp(phi), right_jacobian(phi), full(sigma)
        S[[0, 1, 2], [0, 1, 2]] += 1.0
        D = product(R, S)
        D[[0, 1, 2], [0, 1, 2]] -= 1.0
        DC = product(D, self._gram)
        inside = product(R.transpose(1, 0, 2), DC - self._moments)  # R^T dE/dT / 2
        by_stretch = _TWICE * packed(0.5 * (inside + inside.transpose(1, 0, 2)))
        turning = product(inside, S)
        axial = np.stack([turning[2, 1] - turning[1, 2], turning[0, 2] - turning[2, 0], turning[1, 0] - turning[0, 1]])
        by_rotation = (J * axial[:, None]).sum(axis=0)
        half = np.stack([_rows(space.rotations, by_rotation), _rows(space.stretches, by_stretch)])
        return self._energy(D, DC), half, self._gauss_newton(J, S)

    def _gauss_newton(self, J: Floats, S: Floats) -> Floats:
        """Gauss-Newton matrix: ``T`` moves by ``R ([J phi]x S + dS)``, measured by the Grams; R drops out."""
        space, Jt = self._space, J.transpose(1, 0, 2)
        CS = product(self._gram, S)
        W = product(S, CS)
        inertia = -W  # <[a]x S C, [b]x S> = a . (tr(S C S) I - S C S) b
        inertia[[0, 1, 2], [0, 1, 2]] += W[0, 0] + W[1, 1] + W[2, 2]
        rotation = product(Jt, product(inertia, J))
        mixed = product(Jt, _turn_of_stretch(CS))
        flat = space.rotations.reshape(len(space.rotations), -1)
        with one_thread():
            RR = flat @ _applied(rotation, space.rotations).T
            RS = flat @ _applied(mixed, space.stretches).T
        return np.block([[RR, RS], [RS.T, space.stretch_gram]]).astype(np.float64)

    def solve(self, w: Floats, *, ridge: float = 0.0, centre: Floats | float = 0.0, iterations: int = 50) -> WeightFit:
        """Levenberg-Marquardt from weights (2, l), with a ridge around ``centre``."""
        if not (np.isfinite(ridge) and ridge >= 0):
            raise ValueError(f"ridge: expected a finite number >= 0, got {ridge}")
        if iterations < 0:
            raise ValueError(f"iterations: expected a number >= 0, got {iterations}")
        bound = ridge * self._ridge_unit()

        def ridged(w: Floats) -> float:
            return self.energy(w) + bound * float(((w - centre) ** 2).sum())

        energies = [ridged(w)]
        damping, converged = _FIRST_DAMPING, False
        for _ in range(iterations):
            _, half, H = self.gradient(w)
            slope = (half + bound * (w - centre)).ravel()
            H[np.diag_indices_from(H)] += bound
            w, energy, damping = _step(ridged, w, energies[-1], slope, H, damping)
            energies.append(energy)
            if energies[-2] - energy <= _TOLERANCE * energies[-2]:
                converged = True
                break
        return WeightFit(w, energies[-1] - bound * float(((w - centre) ** 2).sum()), tuple(energies), converged)

    def _ridge_unit(self) -> float:
        """Mean diagonal entry of the stretch part, which no weights change."""
        return float(self._space.stretch_gram.diagonal().mean())


def _step(
    ridged: Callable[[Floats], float], w: Floats, energy: float, slope: Floats, H: Floats, damping: float
) -> tuple[Floats, float, float]:
    """One damped step that does not raise the energy; the same weights if there is none."""
    diagonal = H.diagonal()
    # A shape that does not deform has no row in H; it keeps its weight.
    floor = np.finfo(np.float32).eps * diagonal.max() or 1.0
    while damping <= _MOST_DAMPING:
        A = H.copy()
        A[np.diag_indices_from(A)] += np.maximum(damping * diagonal, floor)
        with one_thread():
            new = w - cho_solve(cho_factor(A, lower=True), slope).reshape(w.shape)
        reached = ridged(new)
        if reached <= energy:
            return new, reached, max(damping / 10, 1e-9)
        damping *= 10
    return w, energy, damping


def _rows(basis: NDArray[np.float32], field: Floats) -> Floats:
    """Inner products (l,) of shapes (l, k, n) with a field (k, n)."""
    with one_thread():
        return (basis.reshape(len(basis), -1) @ field.ravel().astype(basis.dtype)).astype(np.float64)


def _applied(M: Floats, basis: NDArray[np.float32]) -> NDArray[np.float32]:
    """Matrices (a, k, n) times the vectors of every shape (l, k, n), as rows (l, a n)."""
    M = M.astype(basis.dtype)
    out = np.empty((len(basis), len(M), basis.shape[2]), basis.dtype)
    for shape, target in zip(basis, out, strict=True):
        np.multiply(M[:, 0], shape[0], out=target)
        for k in range(1, M.shape[1]):
            target += M[:, k] * shape[k]
    return out.reshape(len(basis), -1)


def _turn_of_stretch(CS: Floats) -> Floats:
    """Matrices A (3, 6, n) with ``a . A s = <[a]x S, dS C>`` for the six numbers s of dS."""
    A = np.zeros((3, 6, CS.shape[2]))
    for k, (row, column) in enumerate(zip(*np.triu_indices(3), strict=True)):
        for p, q in {(row, column), (column, row)}:  # dS has a one at [p, q]: row p of dS C S is row q of C S
            for b in range(3):
                if b == p:
                    continue
                axis = 3 - p - b
                sign = 1.0 if (axis, p, b) in ((0, 2, 1), (1, 0, 2), (2, 1, 0)) else -1.0
                A[axis, k] += sign * CS[q, b]
    return A
