"""Eyeballs, teeth and what else hangs on nothing, in the rig of a foreign head."""

import numpy as np

from toongeo.geometry.similarity import similarity
from toongeo.geometry.vertex_components import vertex_components
from toongeo.model.ibug68 import PARTS

ROUND = 0.1  # of the radius: how far a ball's vertices may be off the sphere, root mean square
BALL = 0.25, 0.75  # least and greatest radius of an eyeball, in widths of the eye
NEAR = 1.0  # widths of the eye from the middle of its landmarks to the middle of the ball


def settle_loose_parts(
    V: np.ndarray, F: np.ndarray, points: np.ndarray, shapes: np.ndarray, partnered: np.ndarray
) -> np.ndarray:
    """Hold eyeballs still and move other parts without a partner as rigid bodies.

    Parameters
    ----------
    V : (n, 3) float64
    F : (m, 3) int64
    points : (68, 3) float64
        Landmarks; NaN rows are missing.
    shapes : (k, n, 3) float
        Displacements carried from a model.
    partnered : (n,) bool
        Vertices that lie on the model's skin: a component most of which does so bends with it.

    Returns
    -------
    (k, n, 3) of the dtype of ``shapes``
    """
    settled = shapes.copy()
    part = vertex_components(F, len(V))
    sizes = np.bincount(part)
    for number in np.flatnonzero(sizes < sizes.max()):
        inside = np.flatnonzero(part == number)
        if _is_eyeball(V[inside], points):
            settled[:, inside] = 0
        elif partnered[inside].mean() < 0.5 and len(inside) > 3:
            for k, shape in enumerate(shapes):
                settled[k, inside] = _rigid(V[inside], shape[inside].astype(np.float64))
    return settled


def _is_eyeball(part: np.ndarray, points: np.ndarray) -> bool:
    if len(part) < 10:
        return False
    # |x|^2 = 2 x.c + (r^2 - |c|^2), about the middle of the part
    middle = part.mean(0)
    x = part - middle
    solution, *_ = np.linalg.lstsq(np.column_stack([2 * x, np.ones(len(x))]), (x**2).sum(1), rcond=None)
    centre = solution[:3]
    radius = np.sqrt(max(solution[3] + centre @ centre, 0.0))
    off = np.linalg.norm(x - centre, axis=1) - radius
    if not np.sqrt((off**2).mean()) < ROUND * radius:
        return False
    for eye in ("eye_left", "eye_right"):
        corners = points[PARTS[eye][[0, 3]]]
        width = np.linalg.norm(corners[1] - corners[0])
        far = np.linalg.norm(centre + middle - corners.mean(0))
        if BALL[0] * width < radius < BALL[1] * width and far < NEAR * width:
            return True
    return False


def _rigid(part: np.ndarray, moved: np.ndarray) -> np.ndarray:
    """The displacements (n, 3) of the rigid motion nearest to given ones."""
    if not moved.any():
        return moved
    _, rotation, _ = similarity(part, part + moved)
    middle = part.mean(0)
    return np.asarray((part - middle) @ rotation.T + middle + moved.mean(0) - part)
