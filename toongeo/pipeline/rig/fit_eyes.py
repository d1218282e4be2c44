"""Eyeballs in the sockets of a face."""

import time
from dataclasses import dataclass

import numpy as np

from toongeo._read_only import read_only
from toongeo.model import EyeballTemplate
from toongeo.pipeline.align.align_face import AlignedFace
from toongeo.pipeline.align.carry_inner_parts import opening_rim
from toongeo.pipeline.align.similarity import similarity
from toongeo.pipeline.rig.gaze import gaze_rotation
from toongeo.pipeline.rig.rig import Rig

SIDES = ("left", "right")
GAZE = np.array([0.0, 0.0, 1.0])  # where a resting eye looks, model frame
CLEARANCE = 0.02  # of the radius: how far lids stay off the eyeball
# Of the radius: s.d. of centre and radius about the template's eyeball, carried along with the lids.
PRIOR = np.array([0.15, 0.15, 0.15, 0.03])
BLINK_WEIGHTS = np.array([0.0, 0.25, 0.5, 0.75])  # at 1 the lids are put onto the eyeball
LEAST_RADIUS = 0.8  # of the fitted radius: how far an eyeball shrinks at most to stay within a narrow head
RIM = 0.04  # of the radius: s.d. of the lid rim about the sphere, at least
HUBER = 2.0  # s.d. beyond which a rim vertex pulls with constant force


@dataclass(frozen=True, eq=False)
class Eyes:
    """Left and right eyeball of a face.

    Attributes
    ----------
    centres : (2, 3) float64, mm, model frame
    radii : (2,) float64, mm
    templates : left and right EyeballTemplate
    report : dict
        ``inset_left_mm``, ``inset_right_mm`` (how far each sphere was moved in, the Delta of Pan et al.), ``seconds``.
    """

    centres: np.ndarray
    radii: np.ndarray
    templates: tuple[EyeballTemplate, ...]
    report: dict[str, float]

    def __post_init__(self) -> None:
        read_only(self, "centres", "radii")

    def vertices(self, side: int, rotation: np.ndarray | None = None) -> np.ndarray:
        """Vertices (k, 3), mm, of eyeball 0 (left) or 1 (right), turned by a rotation (3, 3) of the gaze."""
        unit = self.templates[side].vertices
        turned = unit if rotation is None else unit @ rotation.T
        return self.centres[side] + self.radii[side] * turned

    def looking(self, side: int, weights: dict[str, float]) -> np.ndarray:
        """Vertices (k, 3), mm, for ``eyeLook*`` weights, which turn the eyeball."""
        return self.vertices(side, gaze_rotation(SIDES[side], weights))


def fit_eyes(face: AlignedFace, rig: Rig) -> Eyes:
    """A sphere for each socket, moved in until no lid touches it (Pan et al. 2024, section 4.3).

    The template's eyeball is carried along by the similarity that best explains how the rim of the lids moved, refined
    by a robust fit of the sphere to that rim, and made smaller where it would come out at the temple. It is then moved
    back along the resting gaze until every lid vertex is outside: in the neutral face, and all the way while the eye
    closes. A blendshape moves lids on straight lines, which cut the corner that a real lid goes around.

    Parameters
    ----------
    face : AlignedFace
    rig : Rig
        For its blinks.

    Returns
    -------
    Eyes
    """
    started = time.perf_counter()
    model = face.model
    centres, radii, report = np.empty((2, 3)), np.empty(2), {}
    for side, name in enumerate(SIDES):
        rim = opening_rim(model, f"socket_{name}")
        coarse = face.fit.vertices[rim]
        centre, radius = model.eyes[side].placed(face.fit.identity)
        ratios = np.linalg.norm(coarse - centre, axis=1) / radius
        scale, rotation, shift = similarity(coarse, face.vertices[rim])
        carried = scale * coarse @ rotation.T + shift
        misfit = np.sqrt(((carried - face.vertices[rim]) ** 2).sum(axis=1).mean())
        centre, radius = scale * rotation @ centre + shift, scale * radius
        centre, radius = _robust_sphere(face.vertices[rim], ratios, centre, radius, max(RIM, misfit / radius))
        around = face.vertices[model.region("skin") & ~model.region(f"eye_{name}")]
        radius, shrunk_from = _radius_within(around - centre, radius), radius
        centre = centre + (shrunk_from - radius) * GAZE
        lids = np.flatnonzero(model.region(f"eyelid_upper_{name}") | model.region(f"eyelid_lower_{name}"))
        lids = np.union1d(lids, rim)
        blink = rig.deltas[rig.names.index(f"eyeBlink{name.capitalize()}"), lids]
        path = face.vertices[lids] + BLINK_WEIGHTS[:, None, None] * blink
        points = np.vstack([path.reshape(-1, 3), around])
        inset = _inset(points - centre, radius * (1 + CLEARANCE))
        centres[side], radii[side] = centre - inset * GAZE, radius
        report[f"inset_{name}_mm"] = inset
    report["seconds"] = time.perf_counter() - started
    return Eyes(centres, radii, model.eyes, report)


def _robust_sphere(
    points: np.ndarray, ratios: np.ndarray, centre: np.ndarray, radius: float, spread: float
) -> tuple[np.ndarray, float]:
    """Sphere from which points (k, 3) lie at ``ratios`` (k,) of its radius, held near a given centre and radius.

    Gauss-Newton with Huber weights. The ratios are those of the template, whose lids do not touch its eyeball;
    ``spread``, in radii, is their deviation: a round opening says little where the template's is an almond. A lid rim
    is nearly flat, so that spheres of very different size suit it; the prior decides among them.
    """
    start = np.r_[centre, radius]
    x = start.copy()
    precision = 1.0 / (PRIOR * radius) ** 2
    for _ in range(10):
        offset = points - x[:3]
        distance = np.linalg.norm(offset, axis=1)
        residual = (distance - ratios * x[3]) / (spread * radius)
        weight = np.minimum(1.0, HUBER / np.maximum(np.abs(residual), 1e-12))
        J = np.column_stack([-offset / distance[:, None], -ratios]) / (spread * radius)
        H = J.T @ (weight[:, None] * J) + np.diag(precision)
        x = x - np.linalg.solve(H, J.T @ (weight * residual) + precision * (x - start))
    return x[:3], float(x[3])


def _radius_within(points: np.ndarray, radius: float) -> float:
    """Radius of the largest sphere, at most ``radius``, that leaves points (k, 3) outside and keeps its front.

    The given sphere is about the origin; all spheres considered touch it at the front pole. With p seen from there,
    p is outside a sphere of radius r if |p|^2 + 2 r p.GAZE >= 0.
    """
    from_pole = points - radius * GAZE
    ahead = from_pole @ GAZE
    behind = ahead < 0
    limits = (from_pole[behind] ** 2).sum(1) / (-2 * ahead[behind])
    return float(max(LEAST_RADIUS * radius, min(radius, limits.min(initial=np.inf))))


def _inset(points: np.ndarray, radius: float) -> float:
    """How far a sphere about the origin must move along -GAZE until all points (k, 3) before it are outside.

    A point at p leaves the sphere when |p + d GAZE| = radius.
    """
    ahead = points @ GAZE
    beside = (points**2).sum(1) - ahead**2
    near = (ahead > 0) & (beside < radius**2)
    if not near.any():
        return 0.0
    return float(max(0.0, (np.sqrt(radius**2 - beside[near]) - ahead[near]).max()))
