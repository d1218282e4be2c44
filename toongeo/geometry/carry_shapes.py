"""Displacements of one mesh carried to another that lies on it.

Constants were judged on ICT-FaceKit's head and the template (``benchmarks/register.py``), on no picture.
"""

import numpy as np
import scipy.sparse as sp

from toongeo.geometry.facing_surface import FACING, FacingSurface
from toongeo.geometry.operators.cotangent_laplacian import cotangent_laplacian
from toongeo.geometry.operators.factor import factor_spd, solve
from toongeo.geometry.operators.vertex_normals import vertex_normals

__all__ = ["carry_shapes"]

_NEAR = 0.005  # of the carrying mesh's size: a partner farther away is no evidence
_PULL = 1e-3  # of a doubtful partner, against a plate's resistance to bending


def carry_shapes(
    V_carrier: np.ndarray, F_carrier: np.ndarray, outer: np.ndarray, shapes: np.ndarray, V: np.ndarray, F: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Move every vertex as its partner on a mesh that covers it.

    The partner of a vertex is the closest point of the carrier's outer surface that faces the same way. Vertices
    without one (of a mesh's inner parts, where the carrier has none or others) move with their neighbours.

    Parameters
    ----------
    V_carrier : (n, 3) float64
    F_carrier : (m, 3) int64
    outer : (n,) bool
        Vertices of the carrier that are known to lie on the other mesh.
    shapes : (k, n, 3) float
        Displacements of the carrier.
    V : (p, 3) float64
        Vertices to be moved, same frame.
    F : (q, 3) int64

    Returns
    -------
    shapes : (k, p, 3) float32
    partnered : (p,) bool
        Which of the vertices have a partner.
    """
    N = vertex_normals(V, F)
    size = float(np.linalg.norm(np.ptp(V_carrier, axis=0)))
    front = F_carrier[outer[F_carrier].all(1)]
    skin = FacingSurface(V_carrier, front)
    triangles, bary, cosines = skin.closest(V, N)
    far = np.linalg.norm(skin.points(triangles, bary) - V, axis=1) > _NEAR * size
    border = skin.at_border(triangles, bary)
    partnered = (cosines >= FACING) & ~far & ~border
    partners = front[triangles]
    # Deep inside, the carrier's own mouth is the best guide that there is.
    lost = np.flatnonzero(far)
    if len(lost):
        whole = FacingSurface(V_carrier, F_carrier)
        triangles, bary[lost], _ = whole.closest(V[lost], N[lost])
        partners[lost] = F_carrier[triangles]
    carried = np.empty((len(shapes), len(V), 3), np.float32)
    for k, shape in enumerate(shapes):
        carried[k] = np.einsum("pc,pcd->pd", bary, shape[partners])
    free = np.flatnonzero(~partnered)
    if len(free):
        carried[:, free] = _bent_along(V, F, free, carried)
    return carried, partnered


def _bent_along(V: np.ndarray, F: np.ndarray, free: np.ndarray, shapes: np.ndarray) -> np.ndarray:
    """Displacements (k, f, 3) of free vertices that continue those of the others with the least bending.

    A thin plate and not a membrane: behind a lip that turns outwards, its inner side has to turn as well.
    """
    L = cotangent_laplacian(V, F, clamp=0.05)
    corners = V[F]
    double = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    area = np.bincount(F.ravel(), np.repeat(double, 3), minlength=len(V))
    area = np.maximum(area / area.mean(), 0.1)
    rows = (L.T @ sp.diags_array(1 / area) @ L).tocsr()[free]
    held = np.setdiff1d(np.arange(len(V)), free)
    doubtful = sp.diags_array(_PULL * area[free])
    flat = shapes.transpose(1, 0, 2).reshape(len(V), -1).astype(np.float64)
    right = doubtful @ flat[free] - rows[:, held] @ flat[held]
    found = solve(factor_spd(rows[:, free] + doubtful), right)
    return np.asarray(found.reshape(len(free), -1, 3).transpose(1, 0, 2))
