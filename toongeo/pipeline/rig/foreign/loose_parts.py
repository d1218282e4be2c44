"""Eyeballs, teeth and what else hangs on nothing, in the rig of a foreign head.

Constants were judged on ICT-FaceKit's head and the template (``benchmarks/register.py``), on no picture.
"""

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from scipy.spatial import cKDTree

from toongeo.geometry import vertex_normals
from toongeo.geometry.facing_surface import FACING, FacingSurface
from toongeo.geometry.operators.adjacency import adjacency
from toongeo.geometry.operators.vertex_components import vertex_components
from toongeo.geometry.rotations.similarity import similarity
from toongeo.model.ibug68 import PARTS

__all__ = ["MouthParts", "settle_loose_parts"]

_ROUND = 0.1  # of the radius: how far a ball's vertices may be off the sphere, root mean square
_BALL = 0.25, 0.75  # least and greatest radius of an eyeball, in widths of the eye
_ONE_PART = 0.7  # share of a part's vertices by which it belongs to one row of teeth, or to the tongue
_ROOTS = 0.25  # share of a part's vertices
_CLOSE = 0.015  # of the head's size, some 4 mm: how thick the wall of a mesh may be
_NEAR = 1.0  # widths of the eye from the middle of its landmarks to the middle of the ball


@dataclass(frozen=True, eq=False)
class MouthParts:
    """What the model has in its mouth, laid into the head: places and displacements.

    Attributes
    ----------
    vertices : (n, 3) float64
        Of the whole model, in the frame of the head.
    shapes : (k, n, 3) float
    mouth : (n,) bool
        The inside of the mouth with all that is in it.
    parts : tuple of (n,) bool
        What moves of its own in there: rows of teeth, tongue. Empty if the model has none.
    """

    vertices: np.ndarray
    shapes: np.ndarray
    mouth: np.ndarray
    parts: tuple[np.ndarray, ...]


def settle_loose_parts(
    V: np.ndarray, F: np.ndarray, points: np.ndarray, shapes: np.ndarray, partnered: np.ndarray, within: MouthParts
) -> np.ndarray:
    """Hold eyeballs still, let teeth move as the model's and lashes as the skin on which they grow.

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
    within : MouthParts

    Returns
    -------
    (k, n, 3) of the dtype of ``shapes``
    """
    settled = shapes.copy()
    part = vertex_components(F, len(V))
    sizes = np.bincount(part)
    whole = cKDTree(within.vertices)
    largest = np.bincount(part, partnered).argmax()
    body = np.flatnonzero(part == largest)
    outer = _OuterWall(V, F[part[F[:, 0]] == largest])
    normals = vertex_normals(V, F)
    for number in np.flatnonzero((np.arange(len(sizes)) != largest) & (sizes > 1)):
        inside = np.flatnonzero(part == number)
        if _is_eyeball(V[inside], points):
            settled[:, inside] = 0
        elif partnered[inside].mean() < 0.5:
            corners, bary, share = outer.before(V[inside], normals[inside])
            if share > 0.5:
                moved = np.einsum("pc,kpcd->kpd", bary, shapes[:, corners])
                settled[:, inside] = _with_neighbours(moved, adjacency(F, len(V))[inside][:, inside], outer.close)
                continue
            nearest = whole.query(V[inside])[1]
            if within.parts and within.mouth[nearest].mean() > 0.5:
                settled[:, inside] = _in_the_mouth(V[inside], within)
            else:
                settled[:, inside] = shapes[:, body[_holders(V[inside], V[body])]]
    return settled


class _OuterWall:
    """The skin of a head, behind which a thick mesh has an inner wall that faces the other way.

    ``close`` is how thick the wall may be, in units of the head.
    """

    def __init__(self, V: np.ndarray, F: np.ndarray) -> None:
        self.close = _CLOSE * float(np.ptp(V[np.unique(F)], axis=0).max())
        self._F, self._surface = F, FacingSurface(V, F)

    def before(self, part: np.ndarray, normals: np.ndarray) -> tuple[np.ndarray, np.ndarray, float]:
        """Corners (n, 3) and weights of the place before each vertex, and for what share of them it is a wall."""
        triangles, bary, cosines = self._surface.closest(part, -normals)
        distance = np.linalg.norm(self._surface.points(triangles, bary) - part, axis=1)
        return self._F[triangles], bary, float(((distance <= self.close) & (cosines >= FACING)).mean())


def _with_neighbours(moved: np.ndarray, around: sp.csr_matrix, most: float) -> np.ndarray:
    """Displacements (k, n, 3), those that part by more from their neighbours taken from these.

    In a fold of the skin the wrong side of it may be the nearest.
    """
    moved = moved.copy()
    count = np.maximum(np.diff(around.indptr), 1)[:, None]
    mean = (around @ moved.swapaxes(0, 1).reshape(len(count), -1) / count).reshape(len(count), -1, 3).swapaxes(0, 1)
    lost = np.linalg.norm(moved - mean, axis=2).max(axis=0) > most
    for row in np.flatnonzero(lost):
        others = around[[row]].indices
        others = others[~lost[others]]
        if len(others):
            moved[:, row] = np.median(moved[:, others], axis=1)
    return moved


def _holders(part: np.ndarray, body: np.ndarray) -> np.ndarray:
    """Vertex of the body (n,) that holds each vertex of a part: the one nearest to its nearest root.

    Roots are the quarter of the part's vertices that is closest to the body: a lash follows the lid from which it
    grows, not the brow to which its tip is near.
    """
    distance, nearest = cKDTree(body).query(part)
    roots = np.flatnonzero(distance <= np.quantile(distance, _ROOTS))
    return np.asarray(nearest[roots[cKDTree(part[roots]).query(part)[1]]])


def _in_the_mouth(part: np.ndarray, within: MouthParts) -> np.ndarray:
    """Displacements (k, n, 3) of a part in the mouth.

    A tooth moves with the row to which most of it is nearest, as a rigid body; what belongs to several, like gums that
    are one with the tongue, bends.
    """
    found = [cKDTree(within.vertices[mask]).query(part) for mask in within.parts]
    nearest = np.argmin([distance for distance, _ in found], axis=0)
    share = np.bincount(nearest, minlength=len(found)) / len(part)
    if share.max() > _ONE_PART:
        nearest[:] = share.argmax()
    moved = np.zeros((len(within.shapes), len(part), 3))
    for k, (mask, (_, index)) in enumerate(zip(within.parts, found, strict=True)):
        chosen = nearest == k
        moved[:, chosen] = within.shapes[:, np.flatnonzero(mask)[index[chosen]]]
    if share.max() > _ONE_PART and len(part) > 3:
        moved = np.stack([_rigid(part, shape) for shape in moved])
    return moved


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
    if not np.sqrt((off**2).mean()) < _ROUND * radius:
        return False
    for eye in ("eye_left", "eye_right"):
        corners = points[PARTS[eye][[0, 3]]]
        width = np.linalg.norm(corners[1] - corners[0])
        far = np.linalg.norm(centre + middle - corners.mean(0))
        if _BALL[0] * width < radius < _BALL[1] * width and far < _NEAR * width:
            return True
    return False


def _rigid(part: np.ndarray, moved: np.ndarray) -> np.ndarray:
    """The displacements (n, 3) of the rigid motion nearest to given ones."""
    if not moved.any():
        return moved
    _, rotation, _ = similarity(part, part + moved)
    middle = part.mean(0)
    return np.asarray((part - middle) @ rotation.T + middle + moved.mean(0) - part)
