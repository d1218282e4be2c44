"""The deformation of a mesh as rotation vectors and scale/shear matrices of its one-rings."""

from __future__ import annotations

import numpy as np

from toongeo.arrays import Floats
from toongeo.geometry.operators.one_rings import OneRings
from toongeo.geometry.rotations.polar_decomposition import polar_decomposition
from toongeo.geometry.rotations.rotation_log import rotation_log

__all__ = ["deformation_representation", "full", "packed", "rotation_and_stretch"]

# A symmetric matrix as six numbers: xx, xy, xz, yy, yz, zz.
_ROW, _COLUMN = np.array([0, 0, 0, 1, 1, 2]), np.array([0, 1, 2, 1, 2, 2])
_PLACE = np.array([[0, 1, 2], [1, 3, 4], [2, 4, 5]])


def deformation_representation(rings: OneRings, P: Floats) -> tuple[Floats, Floats]:
    """``f = {log R_i; S_i - I}`` of a deformed mesh (Eq. 2-3); zero for no deformation.

    Parameters
    ----------
    rings : OneRings
        Of the reference.
    P : (n, 3) float
        Deformed vertices, aligned with the reference.

    Returns
    -------
    rotations : (3, n) float64
        Rotation vectors, radians, of the polar decomposition ``T_i = R_i S_i`` of Eq. 1's deformation gradients.
    stretches : (6, n) float64
        xx, xy, xz, yy, yz and zz of ``S_i - I``. Where a ring is turned inside out along its normal, ``S_i`` has a
        negative eigenvalue, and ``R_i`` is still a rotation.

    References
    ----------
    Wu et al. 2018, "Alive caricature from 2D to 3D", Eq. 2-3.
    """
    return rotation_and_stretch(rings.displacement_gradients(P), rings.normal)


def rotation_and_stretch(gradients: Floats, normal: Floats) -> tuple[Floats, Floats]:
    """Rotation vectors (3, n) and six numbers of ``S - I`` (6, n) of ``T - I`` (3, 3, n), by polar decomposition."""
    T = gradients.copy()
    T[[0, 1, 2], [0, 1, 2]] += 1.0
    R, S = polar_decomposition(T, normal)
    S[[0, 1, 2], [0, 1, 2]] -= 1.0
    return rotation_log(R), packed(S)


def packed(S: Floats) -> Floats:
    """Six numbers (6, n) of symmetric matrices (3, 3, n)."""
    return S[_ROW, _COLUMN]


def full(s: Floats) -> Floats:
    """Symmetric matrices (3, 3, n) of six numbers (6, n)."""
    return s[_PLACE]
