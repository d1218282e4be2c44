"""One more identity mode: from the likeliest face of the artist's modes to the mean of people, which they do not span.

Neutral subjects of ICT-FaceKit are registered closely, with the identity modes and smooth ones together. The mean of
what they take is a face; the mode leads there from the likeliest face that the identity modes alone can make. The same
registrations tell where the 68 points of that model lie on the template: its own definition of the landmarks, which is
not that of people who annotate pictures.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import face_statistics
import igl
import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation
from smooth_modes import smooth_modes

from toongeo.geometry import catmull_clark
from toongeo.geometry.rotations.similarity import similarity
from toongeo.model import MorphableModel
from toongeo.model.anatomy.landmark_basis import landmark_basis
from toongeo.model.artist_model import artist_model, recombined
from toongeo.model.data_path import data_path
from toongeo.model.ibug68 import INNER

Floats = NDArray[np.float64]

N_SUBJECTS = 40
SPREAD = 0.8  # standard deviations of ICT-FaceKit: faces near its mean are registered best
ITERATIONS, LOOSE_AFTER = 9, 4
N_INDEPENDENT = (
    1500  # points of a surface that err independently, at `face_statistics.SURFACE_MM`: a close registration
)
LANDMARK_MM = (4.0, 30.0)  # they start a registration; then the surface alone tells where they lie
LOG_SCALE = 0.03
POSES = 4
DEVIATION = 0.2  # of the mode's own length, from person to person
# How far the likeliest face goes towards the mean of these scans. Chosen on subjects of two models (ICT-FaceKit gains
# up to half of the way, Surrey loses from there) such that photographs are fitted as well as without it.
SHARE = 0.3


@dataclass(frozen=True, eq=False)
class Close:
    """A close registration: coefficients (c,), and ``x = scale * y @ turn.T + shift`` from the subject."""

    coefficients: Floats
    scale: float
    turn: Floats
    shift: Floats


def mean_mode(axes: Floats, likely: Floats, scans: MorphableModel) -> dict[str, Floats]:
    """The mode on the control cage and at the eyeballs, its mean, and the landmarks of the scans.

    Parameters
    ----------
    axes : (80, k) float
        Of the identity modes that ship, in those of the artist.
    likely : (k,) float
        The mean along them.
    scans : MorphableModel
        ICT-FaceKit.
    """
    template = artist_model(axes)
    cage = Cage.of(template)
    rich = replace(template, identity=np.concatenate([template.identity, cage.refined]), eyes=())
    rng = np.random.default_rng(face_statistics.SEED)
    subjects = [scans.vertices(SPREAD * rng.standard_normal(len(scans.identity))) for _ in range(N_SUBJECTS)]
    held = face_statistics.skull_precision(template)
    found = [close_registration(rich, scans, V, held) for V in subjects]
    mean = np.mean([each.coefficients for each in found], axis=0)
    mean[: len(likely)] -= likely
    return {
        **cage.mode(axes, template, DEVIATION * mean),
        "scan_offsets": scan_offsets(rich, scans, subjects, found, rng),
        "mean_mode_share": np.array(SHARE / DEVIATION),
    }


@dataclass(frozen=True, eq=False)
class Cage:
    """Smooth modes at the control cage and both eyeballs (c, n0 + 2, 3), and these refined (c, n1, 3).

    ``mirrored`` (n0,) is the cage vertex on the other side.
    """

    smooth: Floats
    refined: NDArray[np.float32]
    mirrored: NDArray[np.int64]

    @classmethod
    def of(cls, template: MorphableModel) -> Cage:
        with np.load(data_path("data_templates/head.npz"), allow_pickle=False) as z:
            points, quads = z["mean"].astype(float), z["quads"].astype(np.int64)
        S, _ = catmull_clark(quads, len(points))
        face = points[template.region("face")[: len(points)]]  # a refined mesh begins with the vertices of its cage
        smooth = smooth_modes(np.vstack([points, [eye.centre for eye in template.eyes]]), face)
        refined = np.stack([S @ mode[: len(points)] for mode in smooth]).astype(np.float32)
        return cls(smooth, refined, cKDTree(points).query(points * face_statistics.FLIP)[1])

    def mode(self, axes: Floats, template: MorphableModel, coefficients: Floats) -> dict[str, Floats]:
        """The displacement of coefficients of identity modes along axes and of smooth ones, the same on both sides."""
        with np.load(data_path("data_templates/head.npz"), allow_pickle=False) as z:
            identity = recombined(z["identity"], axes)
        own, more = np.split(coefficients, [len(identity)])
        moved = np.tensordot(more, self.smooth, 1)
        cage = np.tensordot(own, identity, 1) + moved[: len(self.mirrored)]
        eyes = moved[len(self.mirrored) :] + [own @ eye.centre_modes for eye in template.eyes]
        radii = np.array([own @ eye.radius_modes for eye in template.eyes])
        return {
            "mean_mode": (cage + cage[self.mirrored] * face_statistics.FLIP) / 2,
            "mean_mode_eyes": (eyes + eyes[::-1] * face_statistics.FLIP) / 2,
            "mean_mode_radius": np.array(radii.mean()),
        }


def close_registration(rich: MorphableModel, scans: MorphableModel, V: Floats, held: Floats) -> Close:
    """The template with all modes (c, n, 3) laid on the narrow face of a subject, across its surface."""
    narrow, targets = V[scans.region("narrow_face")][::4], V[scans.landmarks[INNER]]
    triangles = rich.faces[rich.region("face")[rich.faces].all(axis=1)]
    scale, turn, shift = similarity(targets, rich.mean[rich.landmarks[INNER]])
    a, k = np.zeros(len(rich.identity)), len(rich.identity)
    precision = np.eye(k)
    precision[: len(held), : len(held)] += held
    for iteration in range(ITERATIONS):
        X = rich.vertices(a)
        x = scale * narrow @ turn.T + shift
        squares, face, closest = igl.point_mesh_squared_distance(x, X, triangles)
        kept = squares < np.quantile(squares, 1 - face_statistics.TRIMMED)
        rows = across_rows(rich, a, X, x[kept], triangles[face[kept]], closest[kept])
        softly = LANDMARK_MM[iteration >= LOOSE_AFTER]
        start = face_statistics.landmark_rows(rich, a, X, scale * targets @ turn.T + shift, softly)
        A, r = np.vstack([rows[0], start[0]]), np.concatenate([rows[1], start[1]])
        normal = A.T @ A
        normal[:k, :k] += precision
        normal[-1, -1] += LOG_SCALE**-2
        step = np.linalg.solve(normal, A.T @ r)
        a = step[:k]
        small, grow = Rotation.from_rotvec(-step[k : k + 3]).as_matrix(), np.exp(-step[k + 6])
        scale, turn, shift = scale * grow, small @ turn, grow * small @ shift - step[k + 3 : k + 6]
    return Close(a, scale, turn, shift)


def across_rows(
    rich: MorphableModel, a: Floats, X: Floats, x: Floats, corners: NDArray[np.int64], closest: Floats
) -> tuple[Floats, Floats]:
    """Rows of the linear system for points x and the planes of their closest points."""
    bary = face_statistics.barycentric(closest, X[corners])
    n = np.cross(X[corners[:, 1]] - X[corners[:, 0]], X[corners[:, 2]] - X[corners[:, 0]])
    n /= np.linalg.norm(n, axis=1, keepdims=True)
    along = (bary[:, i, None] * np.einsum("kpd,pd->pk", rich.identity[:, corners[:, i]], n) for i in range(3))
    modes = sum(along)
    weight = np.sqrt(N_INDEPENDENT / len(x)) / face_statistics.SURFACE_MM
    A = np.column_stack([modes, np.cross(closest, n), n, (closest * n).sum(axis=1)])
    return weight * A, weight * (((x - closest) * n).sum(axis=1) + modes @ a)


def scan_offsets(
    rich: MorphableModel, scans: MorphableModel, subjects: list[Floats], found: list[Close], rng: np.random.Generator
) -> Floats:
    """Mean (68, 3) of the point of the scans minus the visible point of the template, mm."""
    basis, moved = landmark_basis(rich), []
    for V, each in zip(subjects, found, strict=True):
        x = each.scale * V @ each.turn.T + each.shift
        shape = np.concatenate([each.coefficients, np.zeros(len(rich.expression))])
        X = rich.vertices(each.coefficients)
        moved += face_statistics.landmark_displacements(scans, basis, x, X, shape, rng, POSES)
    return np.mean(moved, axis=0)
