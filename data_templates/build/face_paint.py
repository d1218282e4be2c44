"""Where the colours of the face go: weights per vertex for cheeks, lips, lids, brows, beard and the rest."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline
from scipy.spatial import cKDTree

Array = NDArray[np.float64]
Index = NDArray[np.int64]

# every distance below is in millimetres on a head whose pupils are 60 mm apart, and was chosen by eye


def mirror_map(vertices: Array, normals: Array, part: Index) -> Index:
    """The vertex on the other side of x = 0 for each vertex; itself where there is none within 0.1 mm.

    Position, normal and part are matched together, since the lips and the lids of a closed face touch.
    """
    swap = np.array([0, 1, 2, 4, 3, 5, 6, 7])  # left and right socket change places
    here = np.column_stack([vertices, normals, 1e3 * part])
    there = np.column_stack([vertices * [-1, 1, 1], normals * [-1, 1, 1], 1e3 * swap[part]])
    distance, other = cKDTree(here).query(there)
    own = np.arange(len(vertices))
    good = (distance < 0.1) & (other[other] == own)
    return np.where(good, other, own)


def smoothing(faces: Index, n: int) -> sp.csr_matrix:
    """(n, n) operator that moves every value half way to the mean of its neighbours."""
    i, j = faces[:, [0, 1, 2]].ravel(), faces[:, [1, 2, 0]].ravel()
    links = sp.coo_matrix((np.ones(2 * len(i)), (np.r_[i, j], np.r_[j, i])), shape=(n, n)).tocsr()
    links.data[:] = 1.0
    degree = np.asarray(links.sum(1)).ravel()
    share = np.divide(0.5, degree, out=np.zeros(n), where=degree > 0)
    return (sp.diags(1 - share * degree) + sp.diags(share) @ links).tocsr()


class FacePaint:
    """Weights (n,) in [0, 1] on the skin of a face, from its landmarks and regions; zero off skin and neck.

    `points` (68, 3) are the landmarks in mm. Only those of the subject's left and of the midline are used and
    every distance is taken from ``(|x|, y, z)``, so the weights are as symmetric as the vertices and regions.
    """

    def __init__(self, vertices: Array, normals: Array, points: Array, skin: NDArray[np.bool_]) -> None:
        self._v = np.column_stack([np.abs(vertices[:, :1]), vertices[:, 1:]])
        self._normals, self._p = normals, points
        self._skin = skin.astype(float)

    def blob(self, centre: Array, size: tuple[float, float, float]) -> Array:
        """Gaussian about `centre` with standard deviations `size`, and its mirror image."""
        return np.exp(-0.5 * (((self._v - centre) / size) ** 2).sum(1)) * self._skin

    def line(self, points: Array) -> tuple[Array, Array]:
        """Distance (n,) to the polyline `points` (k, 3), and the nearest place along it (0 to 1)."""
        best, where = np.full(len(self._v), np.inf), np.zeros(len(self._v))
        for k, (a, b) in enumerate(pairwise(points)):
            t = np.clip((self._v - a) @ (b - a) / ((b - a) @ (b - a)), 0, 1)
            d = np.linalg.norm(self._v - a - t[:, None] * (b - a), axis=1)
            where = np.where(d < best, (k + t) / (len(points) - 1), where)
            best = np.minimum(best, d)
        return best, where

    def flush(self) -> dict[str, Array]:
        """Where blood shows: cheek, nose, chin; and the forehead and the skin under the eyes."""
        p = self._p
        eye, wing = p[42:48].mean(0), p[35] + np.array([1.0, 5.0, 0.0])
        cheek = np.array([1.12 * eye[0], 0.55 * p[46, 1] + 0.45 * p[54, 1], 0.0])
        flat = ((self._v - cheek)[:, :2] ** 2).sum(1) + 1e3 * ((self._v[:, 2] < 0) | (self._skin == 0))
        cheek[2] = self._v[np.argmin(flat), 2]
        return {
            "cheek": self.blob(cheek, (13.0, 11.0, 16.0)),
            "nose": np.maximum(self.blob(p[30], (9.0, 8.0, 11.0)), 0.7 * self.blob(wing, (4.5, 5.0, 7.0))),
            "chin": self.blob(np.array([0.0, p[8, 1] + 13, p[57, 2]]), (12.0, 8.0, 14.0)),
            "forehead": self.blob(np.array([0.0, p[24, 1] + 24, p[24, 2]]), (36.0, 17.0, 30.0)),
            "under_eye": self.blob(eye - np.array([0.0, 10.5, -3.0]), (11.0, 4.5, 9.0)),
        }

    def brow(self) -> Array:
        """The brows: thick near the nose, thin at the temple, softer than the 2.2 mm between two vertices."""
        distance, where = self.line(self._p[22:27] - np.array([0.0, 1.8, 0.0]))
        width = np.interp(where, [0, 0.2, 0.6, 1], [3.4, 3.9, 3.2, 1.9])
        density = np.interp(where, [0, 0.15, 0.7, 1], [0.55, 0.95, 1.0, 0.7])
        return density * np.exp(-((distance / width) ** 3)) * self._skin

    def lash(self) -> Array:
        """The line of the lashes: strong on the upper lid, faint on the lower one."""
        upper, where = self.line(_rounded(self._p[42:46]))
        lower, _ = self.line(_rounded(self._p[[45, 46, 47, 42]]))
        strength = np.interp(where, [0, 0.25, 0.9, 1], [0.25, 0.9, 1.0, 0.6])  # few at the inner corner
        above = strength * np.exp(-((upper / 1.7) ** 2))
        return np.maximum(above, 0.3 * np.exp(-((lower / 1.4) ** 2))) * self._skin

    def nostril(self) -> Array:
        """The openings of the nose, on skin that faces down or inwards."""
        opening = 0.5 * (self._p[34] + self._p[35]) + np.array([-1.0, 2.0, -1.0])
        return self.blob(opening, (3.0, 3.0, 5.0)) * np.clip(-self._normals[:, 1] - 0.25, 0, 0.5) * 2

    def beard(self, lips: Array) -> Array:
        """Moustache, chin and jaw below a line from the ear over the corner of the mouth to the nose."""
        p, v = self._p, self._v
        out = [0, p[35, 0], p[54, 0] + 3, p[14, 0]]
        limit = np.interp(v[:, 0], out, [p[33, 1] - 2, p[33, 1] - 3, p[54, 1] + 4, p[14, 1]])
        below = np.clip((limit - v[:, 1]) / 13, 0, 1)
        above = np.clip((v[:, 1] - (p[8, 1] - 14)) / 12, 0, 1)
        front = np.clip((v[:, 2] - (p[15, 2] + 6)) / 22, 0, 1)
        hairy = _smoothstep(below) * _smoothstep(above) * _smoothstep(front)
        return hairy * np.clip(1 - 1.8 * lips, 0, 1) * self._skin


def _rounded(points: Array) -> Array:
    """A smooth curve through `points`, as a polyline of 17 points: lids are no chords."""
    return CubicSpline(np.arange(len(points)), points)(np.linspace(0, len(points) - 1, 17))


def _smoothstep(t: Array) -> Array:
    return t * t * (3 - 2 * t)
