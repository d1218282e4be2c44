"""A mouth that is drawn open, closed.

Constants: see ``benchmarks/mouths.py``.
"""

import numpy as np
import scipy.sparse as sp
from scipy.spatial import cKDTree

from toongeo.geometry import cotangent_laplacian
from toongeo.geometry.operators.factor import factor_spd, solve
from toongeo.model import MorphableModel
from toongeo.model.anatomy.lip_line import LipLine, lip_line
from toongeo.model.anatomy.still_vertices import still_vertices
from toongeo.pipeline.rig.mouth.contact_line import contact_line
from toongeo.pipeline.rig.mouth.lower_face import crossing_count, crossings, strain, uncrossed
from toongeo.pipeline.rig.skin.affine_around import affine_around

__all__ = ["NEEDS", "closed_mouth"]

NEEDS = ("mouth_cavity", "jaw", "lip_upper", "lip_lower", "jawOpen")
# Nothing of these goes along: the nose would be drawn down with the upper lip.
_HELD = (
    "nose", "eye_left", "eye_right", "brow_left", "brow_right", "forehead", "ears",
    "socket_left", "socket_right",
)  # fmt: skip
_SHARES = (1.0, 0.9, 0.8, 0.7, 0.6)  # of the gap that are tried
_FEW = 70  # crossing triangles that smoothing is likely to mend; with more, less of the gap is closed
_PRESSED, _PRESSING = 12, (2, 3)  # so many of these at most; edges around them (:func:`affine_around`)
_STRAIN = 2.6  # to which all but one in a hundred triangles may be stretched
_TENSION = 2e-3  # 1/mm^2, of the plate
_CLAMP = 1e-2  # least weight of an edge, and least mass of a vertex in terms of the median
_TUBE, _CHIN = 10.0, 0.3  # stiffness, in terms of the plate's own, with which lips and chin move as a whole
_STRETCH = 0.25  # of the height of lower lip and chin: by so much the lip moves alone before the chin follows
_ALONG = 0.5  # of the jaw's way that is along the lip's, at least: a jaw cannot mend a lip that is drawn aside
_CHIN_SHARE = 0.8  # of the motion of the template's chin: what moves so much in `jawOpen` is chin
_BELOW_LIP_MM = 4.0  # on the template


def closed_mouth(model: MorphableModel, V: np.ndarray) -> np.ndarray:
    """Vertices (n, 3) of a face with its drawn lips brought together, as far as they go without harm.

    Both lips move to the line where they meet (:func:`contact_line`) as tubes, the chin, lower teeth and tongue follow
    the lower lip, and the skin between bends as a thin plate on the drawn mesh. That is done to the largest share that
    brings no crossings, after the skin around a few of them was smoothed, and no strain beyond 2.6; or else to the one
    with the fewest crossings, of these the one with the least strain.

    Parameters
    ----------
    model : MorphableModel
        With the parts ``NEEDS``.
    V : (n, 3) float64, mm
    """
    motion, drawn = _closing(model, V), crossing_count(model, V)
    harm, best = (np.inf, np.inf), V
    for share in _SHARES:
        closed = V + share * motion
        count = crossing_count(model, closed)
        if drawn < count <= drawn + _FEW:
            closed = _sound(model, V, uncrossed(model, closed))
            count = crossing_count(model, closed)
        here = max(count - drawn, 0), max(strain(model, V, closed) - _STRAIN, 0.0)
        if here < harm:
            harm, best = here, closed
        if here == (0, 0.0):
            return closed
    return uncrossed(model, best)


def _sound(model: MorphableModel, V: np.ndarray, closed: np.ndarray) -> np.ndarray:
    """A closed mouth (n, 3) with few crossings, at its corners say, without them where pressing the skin helps."""
    hit = crossings(model, closed)
    if not 0 < len(hit) <= _PRESSED:
        return closed
    tried = affine_around(model, V, closed, model.faces[hit], *_PRESSING)
    return tried if crossing_count(model, tried) < len(hit) else closed


def _closing(model: MorphableModel, V: np.ndarray) -> np.ndarray:
    """Displacements (n, 3) that close the mouth wholly."""
    line = lip_line(model)
    jaw = model.expression[model.expression_index("jawOpen")].astype(float)
    nose, upper, lower, tip = V[model.landmarks[[33, 62, 66, 8]]]
    to_upper, to_lower = contact_line(line, V, _up(line, V), float(np.linalg.norm(nose - upper)))
    middle = to_lower[np.abs(np.linspace(0, 1, len(to_lower)) - 0.5).argmin()]
    way = float(np.linalg.norm(middle))
    follows = max(0.0, way - _STRETCH * float(np.linalg.norm(lower - tip)))
    # The chin goes up as it hangs on the template, so far that the lip goes that way.
    lip = jaw[model.landmarks[66]]
    along = -float(lip @ middle) / max(way, 1e-9)
    swing = -follows / max(along, _ALONG * float(np.linalg.norm(lip))) * jaw
    D = np.zeros(V.shape)
    D[line.upper], D[line.lower[1:-1]] = to_upper, to_lower[1:-1]
    _bend(model, V, line, swing, D)
    for part in ("teeth_lower", "tongue"):
        D[model.region(part)] = swing[model.region(part)]
    return D


def _bend(model: MorphableModel, V: np.ndarray, line: LipLine, swing: np.ndarray, D: np.ndarray) -> None:
    """Let the skin follow the displacements of the line, in place."""
    soft = model.region("skin") | model.region("mouth_cavity") | model.region("neck")
    used, local = np.unique(model.faces[soft[model.faces].all(1)], return_inverse=True)
    X, F = V[used], local.reshape(-1, 3)
    K = cotangent_laplacian(X, F, clamp=_CLAMP)
    area = np.linalg.norm(np.cross(X[F[:, 1]] - X[F[:, 0]], X[F[:, 2]] - X[F[:, 0]]), axis=1)
    mass = np.bincount(F.ravel(), np.repeat(area, 3), minlength=len(X)) / 6
    mass = np.maximum(mass, _CLAMP * np.median(mass))
    plate = sp.csr_matrix(K @ sp.diags_array(1 / mass) @ K + _TENSION * K)
    known = np.any([model.region(name) for name in _HELD], axis=0)
    known[still_vertices(model)] = known[line.vertices] = True
    want, pull = _tubes_and_chin(model, V, line, swing, D, known)
    free, given = np.flatnonzero(~known[used]), np.flatnonzero(known[used])
    spring = (pull[used] * mass * np.median(plate.diagonal() / mass) * 1e-2)[free]
    right = spring[:, None] * want[used[free]] - plate[free][:, given] @ D[used[given]]
    D[used[free]] = solve(factor_spd(plate[free][:, free] + sp.diags_array(spring)), right)


def _tubes_and_chin(
    model: MorphableModel, V: np.ndarray, line: LipLine, swing: np.ndarray, D: np.ndarray, known: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Displacements (n, 3) that lips and chin should have, and how strongly (n,)."""
    want, pull, up = np.zeros_like(D), np.zeros(len(D)), _up(line, V)
    for name, path, side in (("lip_upper", line.upper, up), ("lip_lower", line.lower, -up)):
        red = np.flatnonzero(model.region(name) & ~known)
        edge = path[cKDTree(model.mean[path]).query(model.mean[red])[1]]
        past = (V[edge] - V[red]) @ side  # a lip that is drawn as a line may have its red beyond its edge
        want[red] = D[edge] + np.maximum(past, 0)[:, None] * side
        pull[red] = _TUBE
    motion = np.linalg.norm(model.expression[model.expression_index("jawOpen")], axis=1)
    below = model.mean[:, 1] < model.mean[model.landmarks[57], 1] - _BELOW_LIP_MM
    chin = model.region("skin") & below & (motion > _CHIN_SHARE * motion[model.landmarks[8]]) & ~known
    want[chin], pull[chin] = swing[chin], _CHIN
    return want, pull


def _up(line: LipLine, V: np.ndarray) -> np.ndarray:
    """Unit vector (3,) across the mouth, as upright as can be."""
    axis = V[line.upper[-1]] - V[line.upper[0]]
    up = np.array([0.0, 1.0, 0.0]) - axis[1] / (axis @ axis) * axis
    return np.asarray(up / np.linalg.norm(up))
