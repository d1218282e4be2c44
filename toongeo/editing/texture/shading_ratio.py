"""How much brighter or darker skin becomes as it turns in the light of the picture.

Constants were judged on the seven examples (``benchmarks/editing.py``).
"""

import numpy as np

from toongeo.geometry import vertex_normals
from toongeo.geometry.one_thread import one_thread
from toongeo.render import sh_basis

__all__ = ["LEAST", "MOST", "ShadingRatio"]

_RIDGE = 0.01  # on all but the ambient light, of the samples: a drawing without shading has none
LEAST, MOST = 0.6, 1.35  # of the ratio; nine harmonics of a drawn light say no more
_SH_MEAN = 0.282095  # the constant harmonic
_FLOOR = 0.25  # of the mean light: what lies in deeper shadow is not brightened from it


class ShadingRatio:
    """The light that explains the lightness of a face best, and ratio images under it (Liu et al. 2001).

    Second-order harmonics are fitted to the lightness of the vertices by ridge regression, so that a flat drawing
    gets ambient light and its ratios are 1.

    Parameters
    ----------
    lightness : (n,) float, linear
    V : (n, 3) float
    F : (m, 3) int
    used : (n,) bool
        Vertices whose lightness is skin's.
    """

    def __init__(self, lightness: np.ndarray, V: np.ndarray, F: np.ndarray, used: np.ndarray) -> None:
        self.faces = F
        self._source: tuple[np.ndarray, np.ndarray] | None = None  # the last source and its light: it seldom changes
        B = sh_basis(vertex_normals(V, F))
        weight = used.astype(float)
        penalty = np.full(9, _RIDGE * max(weight.sum(), 1.0))
        penalty[0] = 0.0
        with one_thread():
            normal = B.T @ (weight[:, None] * B) + np.diag(penalty) + 1e-9 * np.eye(9)
            self.light = np.linalg.solve(normal, B.T @ (weight * lightness))

    def __call__(self, source: np.ndarray, target: np.ndarray) -> np.ndarray:
        """Factors (n,) on sRGB colours, for vertices (n, 3) that move from source to target."""
        if self._source is None or not np.array_equal(self._source[0], source):
            self._source = np.array(source), self._light_at(source)
        return np.asarray(np.clip(self._light_at(target) / self._source[1], LEAST, MOST) ** (1 / 2.2), np.float32)

    def _light_at(self, V: np.ndarray) -> np.ndarray:
        with one_thread():
            lit = sh_basis(vertex_normals(V, self.faces)) @ self.light
        return np.asarray(np.maximum(lit, _FLOOR * max(float(self.light[0]) * _SH_MEAN, 1e-6)))
