"""Eyeballs behind the lids of a face.

Constants were chosen on the seven examples and 15 caricatures (``benchmarks/contacts.py``).
"""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from toongeo._brief_repr import brief_repr
from toongeo._read_only import read_only, restored
from toongeo.model import EyeballTemplate, MorphableModel
from toongeo.model.anatomy.gaze import GAZE_NAMES, TURN, gaze_rotation
from toongeo.model.anatomy.lid_rings import lid_rings, lids_of, opening_height
from toongeo.model.anatomy.parts import SIDES
from toongeo.model.anatomy.rims import rim_path
from toongeo.pipeline.rig.rig import Rig

if TYPE_CHECKING:
    from toongeo.pipeline.align.align_face import AlignedFace  # whose imports a process that draws films does without

__all__ = ["Eyes", "LEAST", "MOST", "OFF", "WANDER", "fit_eyes"]

LEAST, _USUAL, MOST = 0.56, 0.72, 0.9  # radius / greatest width of the opening
_STEPS = 9  # radii that are tried from least to most
_PRIOR = np.array([0.12, 0.12, 0.3, 0.1])  # of the radius: s.d. of the centre about the opening's middle, of the radius
_RIM = 0.04  # of the radius: s.d. of the lids' edges about the sphere
_HUBER = 2.0  # s.d. beyond which a vertex pulls with constant force
_RIM_POINTS = 30  # a rim counts as so many independent ones
_FRONT = 0.9  # of the radius: how far from the line of sight the lids' edges may be
OFF = 0.035  # of the radius: how far off the eyeball the lids' edges lie, and other skin at least
WANDER = np.array([0.4, 0.35])  # of the opening's width and height: how far an iris moves from its middle
_NEAR = 1.6  # radii from where a centre is looked for: skin farther away does not come into the eyeball
_REACH = 2.0  # widths of the opening: skin farther away is not looked at


@dataclass(frozen=True, eq=False)
class Eyes:
    """Left and right eyeball of a face; of a model that has none, arrays of no rows.

    Attributes
    ----------
    centres : (2, 3) float64, mm, model frame
    radii : (2,) float64, mm
    templates : left and right EyeballTemplate
    turn : (2, 2) float64, degrees
        How far each eye turns sideways, and up or down, at weight 1: as a person's, but in an opening that is small for
        the eyeball only so far that the iris does not leave it.
    pose : (8,) float64
        Weights of ``GAZE_NAMES`` with which the eyes look as in the picture.
    seconds : float
        That finding them took.

    Examples
    --------
    >>> import toongeo as tg
    >>> from toongeo.model import data_path
    >>> landmarks = tg.read_landmarks(data_path("examples/portraits/moustache_man.pts"))
    >>> face = tg.align_face(tg.fit_3dmm(None, landmarks), landmarks)
    >>> rig, eyes = tg.fit_lids(face, tg.build_rig(face))
    >>> eyes.centres.shape, eyes.radii.shape
    ((2, 3), (2,))
    >>> bool(eyes.centres[0, 0] > 0 > eyes.centres[1, 0])  # left, then right: +X is the subject's left
    True
    """

    centres: np.ndarray
    radii: np.ndarray
    templates: tuple[EyeballTemplate, ...]
    turn: np.ndarray
    pose: np.ndarray
    seconds: float

    __repr__ = brief_repr
    __setstate__ = restored

    def __post_init__(self) -> None:
        read_only(self, "centres", "radii", "turn", "pose")

    def vertices(self, side: int, rotation: np.ndarray | None = None) -> np.ndarray:
        """Vertices (k, 3), mm, of eyeball 0 (left) or 1 (right), turned by a rotation (3, 3) of the gaze."""
        unit = self.templates[side].vertices
        turned = unit if rotation is None else unit @ rotation.T
        return self.centres[side] + self.radii[side] * turned

    def looking_as_drawn(self, side: int) -> np.ndarray:
        """Vertices (k, 3), mm, of an eyeball that looks as in the picture."""
        return self.looking(side, dict(zip(GAZE_NAMES, self.pose.tolist(), strict=True)))

    def looking(self, side: int, weights: dict[str, float]) -> np.ndarray:
        """Vertices (k, 3), mm, for ``eyeLook*`` weights, which turn the eyeball."""
        return self.vertices(side, gaze_rotation(SIDES[side], weights, self.turn[side]))


def fit_eyes(face: AlignedFace, rig: Rig) -> Eyes:
    """A sphere for each eye, robustly fitted to the edges of its lids (Pan et al. 2024, section 4.3).

    The paper moves a fitted sphere in until no lid touches it, which leaves the eyeballs of wide eyes deep in their
    sockets. Here spheres of several sizes are fitted, and the one is taken from which the edges of the lids differ
    least that neither comes out at the cheek or the temple nor has the lids beside it;
    :func:`~toongeo.pipeline.rig.eyes.seat_lids.seat_lids` then lays the lids onto it.

    Parameters
    ----------
    face : AlignedFace
    rig : Rig
        For its neutral face.

    Returns
    -------
    Eyes
        One for each eyeball of the model.

    Examples
    --------
    >>> import toongeo as tg
    >>> from toongeo.model import data_path
    >>> landmarks = tg.read_landmarks(data_path("examples/portraits/moustache_man.pts"))
    >>> face = tg.align_face(tg.fit_3dmm(None, landmarks), landmarks)
    >>> eyes = tg.fit_eyes(face, tg.build_rig(face))
    >>> eyes.centres.shape, bool((eyes.radii > 5).all())  # mm
    ((2, 3), True)
    """
    started = time.perf_counter()
    count = len(face.model.eyes)
    centres, radii, turn = np.empty((count, 3)), np.empty(count), np.empty((count, 2))
    axes = np.array([[0.0, 0.0, 1.0], _line_of_sight(face)])
    for side in range(count):
        edges, upper, lower = _edges(face.model, SIDES[side])
        skin = face.region("skin").copy()
        skin[edges] = False
        centres[side], radii[side] = _sphere(rig.neutral[edges], rig.neutral[skin], axes)
        turn[side] = _turn(rig.neutral[upper], rig.neutral[lower], radii[side])
    return Eyes(centres, radii, face.model.eyes, turn, np.zeros(len(GAZE_NAMES)), time.perf_counter() - started)


def _edges(model: MorphableModel, side: str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Vertices of the lids' edges, and of their upper and lower rims; the rims alone where the lids are no rings."""
    if model.has(*lids_of(side)):
        rings = lid_rings(model, side)
        return rings.vertices, rings.upper[0], rings.lower[0]
    upper, lower = (rim_path(model, f"lid_{lid}_{side}") for lid in ("upper", "lower"))
    return np.union1d(upper, lower), upper, lower


def _turn(upper: np.ndarray, lower: np.ndarray, radius: float) -> np.ndarray:
    """Degrees (2,) that an eye turns sideways, and up or down, between rims (k, 3) and (m, 3)."""
    opening = np.array([np.linalg.norm(upper[-1] - upper[0]), opening_height(upper, lower)])
    return np.minimum(TURN, np.rad2deg(np.arcsin(np.minimum(1, WANDER * opening / radius))))


def _line_of_sight(face: AlignedFace) -> np.ndarray:
    """Unit vector (3,), model frame, from the eyes to the camera."""
    px = face.project(np.zeros((1, 3)))
    near, far = face.camera.unproject(np.vstack([px, px]), np.array([1.0, 0.0]))
    return np.asarray((near - far) / np.linalg.norm(near - far))


def _sphere(points: np.ndarray, skin: np.ndarray, axes: np.ndarray) -> tuple[np.ndarray, float]:
    """Centre (3,) and radius of the sphere for edges of lids (k, 3); skin (m, 3) stays outside where that is possible.

    ``axes`` (a, 3) are directions from which the edges should be seen before the sphere, not beside it.
    """
    size = float(np.linalg.norm(points[:, None] - points, axis=2).max())
    skin = skin[np.linalg.norm(skin - points.mean(0), axis=1) < _REACH * size]
    wanted = _robust_sphere(points, _behind(points, _USUAL * size), _USUAL * size)[1]
    best, least = (points.mean(0), size), np.inf
    for radius in np.linspace(LEAST, MOST, _STEPS) * size:
        behind = _behind(points, radius)
        near = skin[np.linalg.norm(skin - behind, axis=1) < _NEAR * radius]
        centre, _ = _robust_sphere(points, behind, radius, near)
        offset = points - centre
        beside = np.sqrt(((offset[:, None] - (offset @ axes.T)[..., None] * axes) ** 2).sum(-1)).max() / radius
        through = 1 - np.linalg.norm(skin - centre, axis=1).min(initial=np.inf) / radius
        cost = max(0.0, beside - _FRONT) + max(0.0, through) + 0.1 * abs(np.log(radius / wanted))
        if cost < least:
            best, least = (centre, float(radius)), cost
    return best


def _behind(points: np.ndarray, radius: float) -> np.ndarray:
    """Centre (3,) of a sphere on which points (k, 3) lie about, behind the middle of them."""
    middle = (points[:, :2].min(0) + points[:, :2].max(0)) / 2
    beside = ((points[:, :2] - middle) ** 2).sum(1)
    return np.r_[middle, (points[:, 2] - np.sqrt(np.maximum(radius**2 - beside, 0))).mean()]


def _robust_sphere(
    points: np.ndarray, centre: np.ndarray, radius: float, skin: np.ndarray | None = None
) -> tuple[np.ndarray, float]:
    """Sphere off which points (k, 3) lie by ``OFF`` of its radius, held near a given centre and radius.

    With ``skin`` (m, 3), that shall be outside, the radius is as given.

    Gauss-Newton with Huber weights. The edges of lids are nearly flat, and those of shut eyes a line, so that spheres
    of very different size and place suit them; the prior decides among these.
    """
    start = np.r_[centre, radius]
    x = start.copy()
    precision = 1.0 / (_PRIOR * radius) ** 2
    free = np.arange(4 if skin is None else 3)
    count = len(points)
    if skin is not None:
        points = np.vstack([points, skin])
    for _ in range(10):
        offset = points - x[:3]
        distance = np.linalg.norm(offset, axis=1)
        residual = (distance - (1 + OFF) * x[3]) / (_RIM * radius)
        residual[count:] = np.minimum(residual[count:], 0.0)
        weight = np.minimum(1.0, _HUBER / np.maximum(np.abs(residual), 1e-12)) * (_RIM_POINTS / count)
        weight[count:] *= residual[count:] < 0
        J = np.column_stack([-offset / distance[:, None], np.full(len(points), -1 - OFF)]) / (_RIM * radius)
        H = J.T @ (weight[:, None] * J) + np.diag(precision)
        step = J.T @ (weight * residual) + precision * (x - start)
        x[free] -= np.linalg.solve(H[np.ix_(free, free)], step[free])
    return x[:3], float(x[3])
