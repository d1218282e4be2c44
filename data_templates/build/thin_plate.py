"""Smooth interpolation over the surface of the cage."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from cage import Cage
from scipy.sparse.linalg import splu
from source import Floats, Ints


def bending_energy(cage: Cage) -> sp.csc_matrix:
    """The matrix (n, n) of the squared graph Laplacian: a thin plate made of the soft parts."""
    edges = cage.edges("skin", "mouth_cavity", "neck", "socket_left", "socket_right")
    n = len(cage.rest)
    links = sp.coo_matrix((np.ones(len(edges)), edges.T), shape=(n, n)).tocsr()
    links = links + links.T
    degree = np.asarray(links.sum(1)).ravel()
    laplacian = sp.identity(n) - sp.diags(1 / np.maximum(degree, 1)) @ links
    return (laplacian.T @ laplacian).tocsc()


class Spread:
    """Carries displacements given at the vertices `fixed` to those of a `domain` (ids), as smoothly as a thin
    plate does; all others stay at rest."""

    def __init__(self, cage: Cage, fixed: Ints, domain: Ints) -> None:
        bending = bending_energy(cage)
        self.n, self.fixed, self.free = len(cage.rest), fixed, np.setdiff1d(domain, fixed)
        self._coupling = bending[self.free][:, fixed]
        self._solve = splu(bending[self.free][:, self.free].tocsc())

    def __call__(self, at_fixed: Floats) -> Floats:
        """Displacements (n, 3) from those of the fixed vertices (len(fixed), 3)."""
        out = np.zeros((self.n, 3))
        out[self.fixed] = at_fixed
        out[self.free] = -self._solve.solve(self._coupling @ at_fixed)
        return out


def filled(cage: Cage, delta: Floats, patch: Ints) -> Floats:
    """Displacements (n, 3) with those of the vertices `patch` replaced by a thin plate through the others."""
    bending = bending_energy(cage)
    rest = delta.copy()
    rest[patch] = 0
    out = delta.copy()
    out[patch] = -splu(bending[patch][:, patch].tocsc()).solve(bending[patch] @ rest)
    return out


def softened(cage: Cage, delta: Floats, zone: Floats, stiffness: float) -> Floats:
    """Displacements (n, 3) smoothed where `zone` (n,) is 1 and kept where it is 0; `stiffness` to the power
    1/4 is the length, in edges, of what goes."""
    hold = sp.diags(1000.0 ** (1 - zone))
    return splu((hold + stiffness * bending_energy(cage)).tocsc()).solve(hold @ delta)
