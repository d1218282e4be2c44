"""The mesh that lies between a deformation space and landmarks in a picture (Wu et al. 2018, Eq. 13-15)."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from toongeo.arrays import Floats
from toongeo.caricature.space.deformation_space import DeformationSpace
from toongeo.geometry.one_thread import one_thread
from toongeo.geometry.operators.factor import factor_spd, solve
from toongeo.render.camera import ScaledOrthographicCamera

__all__ = ["LandmarkMesh"]

_FLIP = np.array([1.0, -1.0])


class LandmarkMesh:
    """The P'-step, with everything kept that depends neither on the gradients nor on the pose.

    Let ``r`` be what landmarks add to the face. ``E_def`` grows by ``2 tr(r^T L r)``, whose minimum
    under point loads is a spike at each landmark; ``2 smoothness tr(r^T L^2 r)`` spreads the loads.

    In the camera's frame the coordinates are independent: a scaled orthographic camera sees x and y, and leaves
    depth free. So no direction of any landmark needs a made-up weight, and one factor of ``K = L + smoothness L^2``,
    one vertex pinned, serves all coordinates, poses and weights: with ``Z = K^-1 S^T``, the forces f of the
    landmarks follow from a system as large as their number,

        (diag(2 / lambda) + S Z) f + 1 a = q - S u0,   1^T f = 0,

    where u0 are the displacements without landmarks and a moves the whole. It is well conditioned for every lambda;
    an infinite one interpolates.

    Parameters
    ----------
    space : DeformationSpace
    smoothness : float >= 0
        0 is the P'-step of the paper.
    """

    def __init__(self, space: DeformationSpace, smoothness: float) -> None:
        self._space = space
        L = space.rings.laplacian
        self._free = np.setdiff1d(np.arange(len(space.reference)), np.unique(space.component, return_index=True)[1])
        K = sp.csr_matrix(L + smoothness * (L @ L)) if smoothness else L
        self._factor = factor_spd(K[self._free][:, self._free])
        self._known: dict[int, Floats] = {}

    def displacements(
        self, u0: Floats, camera: ScaledOrthographicCamera, vertices: NDArray[np.int64], q: Floats, weights: Floats
    ) -> Floats:
        """Displacements (n, 3) of the reference, mm, model frame.

        Parameters
        ----------
        u0 : (n, 3) float
            Displacements without the landmarks.
        camera : ScaledOrthographicCamera
        vertices : (k,) int
            Of the space, each once.
        q : (k, 2) float, px
        weights : (k,) float > 0
            Lambda of each; E_lan is measured in (px / s)^2, that is mm^2, as E_def is.
        """
        rotation, space = camera.rotation, self._space
        wanted = (q - camera.translation) * _FLIP / camera.scale
        wanted -= (space.reference[vertices] + u0[vertices]) @ rotation[:2].T
        pulls = self._pulls(vertices)
        held = np.unique(space.component[vertices])
        member = (space.component[vertices][:, None] == held).astype(float)
        corner = np.zeros((len(held), len(held)))
        system = np.block([[np.diag(2 / weights) + pulls[vertices], member], [member.T, corner]])
        with one_thread():
            forces = np.linalg.solve(system, np.vstack([wanted, np.zeros((len(held), 2))]))
            k = len(vertices)
            moved = pulls @ forces[:k] + (space.component[:, None] == held) @ forces[k:]
            return u0 + moved @ rotation[:2]

    def _pulls(self, vertices: NDArray[np.int64]) -> Floats:
        """``K^-1 S^T`` (n, k); each column is solved for when first asked for."""
        for v in vertices.tolist():
            if v in self._known:
                continue
            # One by one: the digits of a column would otherwise depend on its company, that is on earlier calls.
            unit = np.zeros((len(self._space.reference), 1))
            unit[v] = 1.0
            column = np.zeros(len(unit))
            column[self._free] = solve(self._factor, unit[self._free])[:, 0]
            # A load on a pinned vertex is taken by the pin: its column is zero, and the free motion makes up for it.
            self._known[v] = column
        return np.stack([self._known[v] for v in vertices.tolist()], axis=1)
