"""How much brighter or darker skin becomes as it turns in the light of the picture."""

import numpy as np

from toongeo.geometry import vertex_normals
from toongeo.geometry.one_thread import one_thread
from toongeo.render import sh_basis

RIDGE = 0.02  # on all but the ambient light, of the samples: a drawing without shading has none
LEAST, MOST = 0.6, 1.35  # of the ratio; nine harmonics of a drawn light say no more
FLOOR = 0.25  # of the mean light: what lies in deeper shadow is not brightened from it


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
        B = sh_basis(vertex_normals(V, F))
        weight = used.astype(float)
        penalty = np.full(9, RIDGE * max(weight.sum(), 1.0))
        penalty[0] = 0.0
        with one_thread():
            normal = B.T @ (weight[:, None] * B) + np.diag(penalty) + 1e-9 * np.eye(9)
            self.light = np.linalg.solve(normal, B.T @ (weight * lightness))

    def __call__(self, source: np.ndarray, target: np.ndarray) -> np.ndarray:
        """Factors (n,) on sRGB colours, for vertices (n, 3) that move from source to target."""
        with one_thread():
            old, new = (sh_basis(vertex_normals(V, self.faces)) @ self.light for V in (source, target))
        floor = FLOOR * max(float(self.light[0]) * 0.282, 1e-6)
        ratio = np.maximum(new, floor) / np.maximum(old, floor)
        return np.asarray(np.clip(ratio, LEAST, MOST) ** (1 / 2.2), np.float32)
