"""A space of deformations that extrapolates."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toongeo._brief_repr import brief_repr
from toongeo.arrays import Floats
from toongeo.caricature.space.encode_shapes import component_means, encode_shapes
from toongeo.caricature.space.encoded_shapes import STORED, EncodedShapes
from toongeo.caricature.space.fit_weights import WeightFit, WeightProblem
from toongeo.caricature.space.space_file import read_arrays, write_arrays
from toongeo.geometry.one_thread import one_thread
from toongeo.geometry.operators.factor import SpdFactor, factor_spd, solve
from toongeo.geometry.validate_mesh import validate_vertices

__all__ = ["DeformationSpace"]


@dataclass(frozen=True, eq=False)
class DeformationSpace(EncodedShapes):
    """Deformations of a reference mesh that blend and extrapolate (Wu et al. 2018).

    With weights ``w = (w_R, w_S)`` the one-ring of vertex i is deformed by
    ``T_i(w) = exp(sum_l w_R,l log R_l,i) (I + sum_l w_S,l (S_l,i - I))`` (Eq. 5): rotations turn on, where a sum of
    displacements would swell and shear. Make it with `from_meshes`.

    Attributes
    ----------
    reference : (n, 3) float64
        Vertices at w = 0, any unit.
    faces : (m, 3) int64
    rotations : (l, 3, n) float32
        Rotation vectors of each shape, radians (Eq. 4).
    stretches : (l, 6, n) float32
        xx, xy, xz, yy, yz, zz of ``S - I``.
    bends : (l, n, 3) float32
        What the Laplacian of each shape's displacements has beyond that of its gradients.
    offsets : (l, c, 3) float64
        Displacement of the mean vertex of each connected component, which the gradients do not tell.

    Examples
    --------
    >>> V = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    >>> F = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]
    >>> space = DeformationSpace.from_meshes(V, F, [V * [2, 1, 1], V * [1, 1, 3]], align=False)
    >>> np.ptp(space.vertices([2.0, 0.5]), axis=0).round(5)
    array([3., 1., 2.])
    """

    __repr__ = brief_repr

    @classmethod
    def from_meshes(
        cls, V: ArrayLike, F: ArrayLike, shapes: Sequence[ArrayLike] | NDArray, *, align: bool = True
    ) -> DeformationSpace:
        """Space spanned by shapes of one topology.

        Parameters
        ----------
        V : (n, 3) float
            Vertices of the reference, any unit.
        F : (m, 3) int
            Triangles of all.
        shapes : (l, n, 3) float
            Vertices of the deformed meshes, l >= 2.
        align : bool
            First bring every shape onto the reference by a rigid motion (least squares over the vertices), so that
            motions of the whole do not count as deformation. False if the shapes share a frame.

        Raises
        ------
        ValueError
            If a mesh is malformed, has another number of vertices than the reference or they are fewer than two; if
            the reference has a triangle without area or a vertex whose edges do not span a plane.
        """
        return cls(*encode_shapes(V, F, shapes, align=align))

    def vertices(self, w: ArrayLike) -> Floats:
        """Mesh of weights: the vertices (n, 3) whose one-rings are deformed most nearly by T(w) (Eq. 6-8).

        A ring has more edges than a gradient can take to their places, so the mesh of Eq. 8 with w = e_l misses shape
        l: by 1e-4 of a head in the mean, 1e-3 at worst. What is missing on the right side of Eq. 8 is known for each
        shape and added in proportion to its weight (the mean of its two): nothing at w = 0, and all of it at e_l,
        whose mesh then is shape l.

        Parameters
        ----------
        w : (l,) or (2, l) float
            Weights of rotation and of scale/shear; one row serves for both. 1 is the shape, 2 twice its deformation.

        Raises
        ------
        ValueError
            If the number of weights is not that of the shapes, or one is not finite.
        """
        w = self.checked_weights(w)
        return self.reference + self.placed(self.integrated(self.gradients(w), self._bend(w)), w)

    def integrated(self, gradients: Floats, bend: Floats | float = 0.0) -> Floats:
        """Displacements (n, 3) whose ring gradients come nearest to ``T - I`` (3, 3, n); one vertex a component is 0.

        It solves Eq. 8, ``2 L u = sum_j c_ij (T_i + T_j - 2 I) e_ij``, for displacements. A ``bend`` (n, 3) adds to
        their Laplacian what no gradient of a ring can tell.
        """
        return self.pinned_solve(0.5 * self.rings.spread(gradients) + bend)

    def _bend(self, w: Floats) -> Floats:
        with one_thread():
            total = w.mean(axis=0).astype(self.bends.dtype) @ self.bends.reshape(len(self.bends), -1)
        return total.reshape(-1, 3).astype(np.float64)

    def pinned_solve(self, b: Floats) -> Floats:
        """``L x = b`` (n, k) with x = 0 at the first vertex of every component."""
        x = np.zeros(b.shape)
        x[self._free] = solve(self._factor, b[self._free])
        return x

    @cached_property
    def _free(self) -> NDArray[np.int64]:
        return np.setdiff1d(np.arange(len(self.reference)), np.unique(self.component, return_index=True)[1])

    @cached_property
    def _factor(self) -> SpdFactor:
        return factor_spd(self.rings.laplacian[self._free][:, self._free])

    def placed(self, displacement: Floats, w: Floats) -> Floats:
        """Displacements (n, 3) with the mean of each component where the shapes have it, weighted by ``w`` (2, l)."""
        wanted = np.tensordot(w.mean(axis=0), self.offsets, 1)
        return displacement + (wanted - component_means(displacement, self.component))[self.component]

    def fit(
        self,
        P: ArrayLike,
        *,
        start: ArrayLike | None = None,
        ridge: float = 0.0,
        centre: ArrayLike | None = None,
        iterations: int = 50,
    ) -> WeightFit:
        """Weights whose deformation gradients come nearest to those of a mesh (Eq. 9).

        Parameters
        ----------
        P : (n, 3) float
            Vertices, in the frame of the reference.
        start : (l,) or (2, l) float, optional
            Zeros if None.
        ridge : float
            Weight of ``|w - centre|^2``, as a fraction of the mean diagonal of the Gauss-Newton matrix at w = 0.
        centre : (l,) or (2, l) float, optional
            Zeros if None.
        iterations : int
            At most so many steps of Levenberg-Marquardt.

        Returns
        -------
        WeightFit

        Raises
        ------
        ValueError
            If `P`, `start` or `centre` do not fit, or `ridge` or `iterations` are negative.
        """
        P = validate_vertices(P, name="P")
        if P.shape != self.reference.shape:
            raise ValueError(f"P: expected shape {self.reference.shape}, got {P.shape}")
        w = np.zeros((2, len(self.rotations))) if start is None else self.checked_weights(start, "start")
        middle = 0.0 if centre is None else self.checked_weights(centre, "centre")
        return WeightProblem(self, P).solve(w, ridge=ridge, centre=middle, iterations=iterations)

    def energy(self, P: ArrayLike, w: ArrayLike) -> float:
        """``E_def`` of Eq. 6: what deformation gradients T(w) leave of the edges of a mesh; unit of P, squared."""
        return WeightProblem(self, validate_vertices(P, name="P")).energy(self.checked_weights(w))

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write an ``.npz`` file without pickles; whole, or not at all.

        Raises
        ------
        OSError
            If it cannot be written.
        """
        write_arrays(path, {name: getattr(self, name) for name in STORED})

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> DeformationSpace:
        """Read what `save` wrote.

        Raises
        ------
        OSError
            If the file cannot be read.
        ValueError
            If it holds something else.
        """
        reference, faces, rotations, stretches, bends, offsets = read_arrays(path, STORED).values()
        return cls(reference, faces, rotations, stretches, bends, offsets)
