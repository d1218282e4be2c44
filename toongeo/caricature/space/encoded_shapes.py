"""Shapes of one topology as rotations and stretches of one-rings."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toongeo._read_only import read_only, restored
from toongeo.arrays import Floats
from toongeo.caricature.space.deformation_representation import full, packed
from toongeo.geometry import validate_mesh, vertex_components
from toongeo.geometry.one_thread import one_thread
from toongeo.geometry.operators.one_rings import OneRings, one_rings
from toongeo.geometry.operators.small_matrices import product
from toongeo.geometry.rotations.rotation_exp import rotation_exp

__all__ = ["STORED", "EncodedShapes"]

STORED = ("reference", "faces", "rotations", "stretches", "bends", "offsets")  # the fields that a file holds


@dataclass(frozen=True, eq=False)
class EncodedShapes:
    """What the deformations of a reference mesh are made of (Wu et al. 2018, Eq. 4), and their blends (Eq. 5).

    Attributes
    ----------
    reference : (n, 3) float64
        Vertices at w = 0.
    faces : (m, 3) int64
    rotations : (l, 3, n) float32
        Rotation vectors of each shape, radians (Eq. 4).
    stretches : (l, 6, n) float32
        xx, xy, xz, yy, yz, zz of ``S - I``.
    bends : (l, n, 3) float32
        What the Laplacian of each shape's displacements has beyond that of its gradients (see `integrated`).
    offsets : (l, c, 3) float64
        Displacement of the mean vertex of each connected component, which the deformation gradients do not tell.
    """

    reference: Floats
    faces: NDArray[np.int64]
    rotations: NDArray[np.float32]
    stretches: NDArray[np.float32]
    bends: NDArray[np.float32]
    offsets: Floats
    _rings: OneRings | None = field(default=None, repr=False)

    __setstate__ = restored

    def __post_init__(self) -> None:
        V, F = validate_mesh(self.reference, self.faces, names=("reference", "faces"))
        object.__setattr__(self, "reference", V)
        object.__setattr__(self, "faces", F)
        count, n = len(self.rotations), len(V)
        components = int(vertex_components(F, n).max()) + 1
        for name, shape in (
            ("rotations", (3, n)),
            ("stretches", (6, n)),
            ("bends", (n, 3)),
            ("offsets", (components, 3)),
        ):
            array = getattr(self, name)
            if array.shape != (count, *shape):
                raise ValueError(f"{name}: expected shape {(count, *shape)}, got {array.shape}")
            if not np.isfinite(array).all():
                raise ValueError(f"{name}: expected finite numbers, got NaN or infinity")
        read_only(self, *STORED)

    @cached_property
    def rings(self) -> OneRings:
        """One-rings of the reference."""
        return self._rings or one_rings(self.reference, self.faces)

    @cached_property
    def stretch_gram(self) -> Floats:
        """``sum_i <S'_l C_i, S'_m>`` (l, l): the part of the Gauss-Newton matrix that does not depend on w."""
        weighted = np.empty_like(self.stretches)
        half = packed(np.full((3, 3, 1), 2.0) - np.eye(3)[:, :, None])  # off-diagonals stand for two entries
        for k, s in enumerate(self.stretches):
            SC = product(full(s.astype(np.float64)), self.rings.gram)
            weighted[k] = packed(0.5 * (SC + SC.transpose(1, 0, 2))) * half
        with one_thread():
            flat = self.stretches.reshape(len(self.stretches), -1)
            return (flat @ weighted.reshape(flat.shape).T).astype(np.float64)

    @cached_property
    def component(self) -> NDArray[np.int64]:
        """Number of the connected component of every vertex (n,)."""
        return vertex_components(self.faces, len(self.reference))

    def gradients(self, w: ArrayLike) -> Floats:
        """``T_i(w) - I`` (3, 3, n) of Eq. 5 for weights (l,) or (2, l)."""
        rotation, stretch = self.fields(self.checked_weights(w))
        S = full(stretch)
        S[[0, 1, 2], [0, 1, 2]] += 1.0
        T = product(rotation_exp(rotation), S)
        T[[0, 1, 2], [0, 1, 2]] -= 1.0
        return T

    def fields(self, w: Floats) -> tuple[Floats, Floats]:
        """Rotation vectors (3, n) and ``S - I`` (6, n) for weights (2, l): the sums of Eq. 5."""
        sums = []
        with one_thread():
            for weights, basis in zip(w, (self.rotations, self.stretches), strict=True):
                total = weights.astype(basis.dtype) @ basis.reshape(len(basis), -1)
                sums.append(total.reshape(basis.shape[1:]).astype(np.float64))
        return sums[0], sums[1]

    def checked_weights(self, w: ArrayLike, name: str = "w") -> Floats:
        """Weights (2, l) from (l,) or (2, l)."""
        weights = np.asarray(w, np.float64)
        count = len(self.rotations)
        if weights.shape not in ((count,), (2, count)):
            raise ValueError(f"{name}: expected shape ({count},) or (2, {count}), got {weights.shape}")
        if not np.isfinite(weights).all():
            raise ValueError(f"{name}: expected finite weights, got NaN or infinity")
        return np.array(np.broadcast_to(weights, (2, count)))
