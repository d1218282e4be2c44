"""Statistics of the identity modes and of the landmarks, from dense registrations to ICT-FaceKit subjects.

The template is registered to random neutral subjects by a similarity and its 80 coefficients: points of the narrow
face against the planes of their closest points. Two things keep the statistics from merely repeating that model. The
mean is what the mean likelihood of all subjects says when it counts a tenth of one subject against the artist's
N(0, I): all subjects share the same misfit, so their number is no evidence. The covariance is that of one step of
expectation-maximisation from N(0, I), so that what a registration does not determine (the back of the head, say) stays
as uncertain as the artist has it, and is shrunk towards N(0, I) as if some subjects more were of that kind.
"""

from __future__ import annotations

from dataclasses import dataclass

import igl
import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from toongeo.geometry import vertex_normals
from toongeo.geometry.rotations.similarity import similarity
from toongeo.model import MorphableModel
from toongeo.model.anatomy.landmark_basis import LandmarkBasis, landmark_basis
from toongeo.model.anatomy.visible_landmarks import visible_landmarks
from toongeo.model.ibug68 import INNER, MIRROR, PARTS

Floats = NDArray[np.float64]

SEED = 7
ITERATIONS = 14
SURFACE_MM, LANDMARK_MM = 0.5, 4.0  # standard deviations of a surface point and of a landmark
LOG_SCALE = 0.03  # about the scale of the landmarks: a shrunken subject is nearer to everything
N_INDEPENDENT = 200  # neighbouring points of a surface err alike: all together count as so many
SLIDING = 0.05  # weight of an error along the surface against one across it
TRIMMED = 0.05  # share of the points, the farthest ones, that have no counterpart
SKULL_MM, N_SKULL = 3.0, 60  # the scalp, which no landmark shows, stays near the template's; count as N_INDEPENDENT
MEAN_EVIDENCE = 0.1  # of one subject
ARTIST_SUBJECTS = 20  # how many subjects the artist's N(0, I) is worth
# How far annotators are taken to follow this model's line of the jaw rather than the template's. Inner points keep the
# template's definition: offsets of these made faces no truer, and landmarks of photographs are nearer to it.
JAW_TRUST = 0.7
POSES = 6  # of each subject, for the landmarks
FLIP = np.array([-1.0, 1.0, 1.0])


@dataclass(frozen=True, eq=False)
class Registration:
    """Similarity ``x = scale * y @ turn.T + shift`` from the subject to the template, and the likelihood
    ``a^T H a / 2 - g^T a`` of the coefficients, pose eliminated."""

    scale: float
    turn: Floats
    shift: Floats
    H: Floats
    g: Floats

    def __call__(self, points: Floats) -> Floats:
        return self.scale * points @ self.turn.T + self.shift


def prior_statistics(template: MorphableModel, scans: MorphableModel, n_subjects: int) -> dict[str, Floats]:
    """Principal axes of the coefficients and the mean along them, offsets and covariances of the landmarks."""
    rng = np.random.default_rng(SEED)
    subjects = [scans.vertices(rng.standard_normal(len(scans.identity))) for _ in range(n_subjects)]
    registrations = [register(template, scans, V) for V in subjects]
    signs = mirror_signs(template)
    mean, covariance, coefficients = coefficient_statistics(registrations, skull_precision(template), signs)
    axes = principal_axes(template, covariance, signs)
    offsets, scatter = landmark_statistics(template, scans, subjects, registrations, coefficients, rng)
    return {
        "mean": np.linalg.solve(axes, mean),
        "axes": axes,
        "landmark_offsets": offsets,
        "landmark_covariance": scatter,
    }


def mirror_signs(template: MorphableModel) -> Floats:
    """+1 for the symmetric, -1 for the antisymmetric identity modes."""
    mirrored = template.identity[:, template.mirror] * FLIP
    return np.sign((mirrored * template.identity).sum(axis=(1, 2)))


def register(template: MorphableModel, scans: MorphableModel, V: Floats) -> Registration:
    """The template laid on the narrow face of a subject with vertices V."""
    narrow = V[scans.region("narrow_face")][::3]
    targets = V[scans.landmarks[INNER]]
    triangles = template.faces[template.region("face")[template.faces].all(axis=1)]
    scale, turn, shift = similarity(targets, template.mean[template.landmarks[INNER]])
    scale0, a = scale, np.zeros(len(template.identity))
    for _ in range(ITERATIONS):
        X = template.vertices(a)
        x = scale * narrow @ turn.T + shift
        squares, face, closest = igl.point_mesh_squared_distance(x, X, triangles)
        kept = squares < np.quantile(squares, 1 - TRIMMED)
        A, r = surface_rows(template, a, X, x[kept], triangles[face[kept]], closest[kept])
        rows = landmark_rows(template, a, X, scale * targets @ turn.T + shift)
        A, r = np.vstack([A, rows[0]]), np.concatenate([r, rows[1]])
        normal, right = A.T @ A, A.T @ r
        k = len(a)
        normal[:k, :k] += np.eye(k)
        normal[k + 6, k + 6] += LOG_SCALE**-2
        right[k + 6] += np.log(scale / scale0) / LOG_SCALE**2
        step = np.linalg.solve(normal, right)
        a = step[:k]
        small = Rotation.from_rotvec(-step[k : k + 3]).as_matrix()
        grow = np.exp(-step[k + 6])
        scale, turn, shift = scale * grow, small @ turn, grow * small @ shift - step[k + 3 : k + 6]
    normal[:k, :k] -= np.eye(k)
    pose = normal[k:, k:]
    return Registration(
        scale=scale,
        turn=turn,
        shift=shift,
        H=normal[:k, :k] - normal[:k, k:] @ np.linalg.solve(pose, normal[k:, :k]),
        g=right[:k] - normal[:k, k:] @ np.linalg.solve(pose, right[k:]),
    )


def surface_rows(
    template: MorphableModel, a: Floats, X: Floats, x: Floats, corners: NDArray[np.int64], closest: Floats
) -> tuple[Floats, Floats]:
    """Rows of the linear system for points x and their closest points: across and along the surface."""
    bary = barycentric(closest, X[corners])
    modes = np.einsum("pc,kpcd->pdk", bary, template.identity[:, corners])
    normals = np.cross(X[corners[:, 1]] - X[corners[:, 0]], X[corners[:, 2]] - X[corners[:, 0]])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    across = normals[:, :, None] * normals[:, None, :]
    weight = across + np.sqrt(SLIDING) * (np.eye(3) - across)
    weight *= np.sqrt(N_INDEPENDENT / len(x)) / SURFACE_MM
    return linear_rows(modes, a, x, closest, weight)


def landmark_rows(
    template: MorphableModel, a: Floats, X: Floats, x: Floats, deviation: float = LANDMARK_MM
) -> tuple[Floats, Floats]:
    """Rows for the inner landmarks x, which start the registration."""
    vertices = template.landmarks[INNER]
    modes = template.identity[:, vertices].transpose(1, 2, 0).astype(float)
    weight = np.tile(np.eye(3) / deviation, (len(x), 1, 1))
    return linear_rows(modes, a, x, X[vertices], weight)


def linear_rows(modes: Floats, a: Floats, x: Floats, p: Floats, weight: Floats) -> tuple[Floats, Floats]:
    """``weight * (modes a' + pose motion of the template - (x - p + modes a))`` for points p of the template at a."""
    turn = np.zeros((len(x), 3, 3))  # the motion w x p, as a matrix on w
    turn[:, 0, 1], turn[:, 0, 2], turn[:, 1, 2] = p[:, 2], -p[:, 1], p[:, 0]
    turn -= turn.transpose(0, 2, 1)
    shift = np.tile(np.eye(3), (len(x), 1, 1))
    A = np.concatenate([modes, turn, shift, p[:, :, None]], axis=2)
    r = x - p + modes @ a
    return (weight @ A).reshape(-1, A.shape[2]), (weight @ r[:, :, None]).ravel()


def barycentric(points: Floats, corners: Floats) -> Floats:
    """Barycentric coordinates (p, 3) of points (p, 3) in triangles (p, 3, 3)."""
    return np.asarray(igl.barycentric_coordinates(points, *(np.ascontiguousarray(corners[:, i]) for i in range(3))))


def skull_precision(template: MorphableModel) -> Floats:
    """Precision (k, k) of the coefficients when the scalp is known to stay where it is."""
    scalp = template.identity[:, template.region("scalp")].astype(float).reshape(len(template.identity), -1)
    return N_SKULL / (scalp.shape[1] / 3) / SKULL_MM**2 * scalp @ scalp.T


def coefficient_statistics(
    registrations: list[Registration], skull: Floats, signs: Floats
) -> tuple[Floats, Floats, Floats]:
    """Mean (k,), covariance (k, k) and every subject's coefficients; mirror images are subjects too."""
    k = len(signs)
    H, g = (MEAN_EVIDENCE * np.mean([getattr(r, name) for r in registrations], axis=0) for name in ("H", "g"))
    artist = skull + np.eye(k)
    mean = np.where(signs > 0, np.linalg.solve(H + artist, g), 0.0)
    spread = [np.linalg.inv(r.H + artist) for r in registrations]
    a = np.array([V @ (r.g + artist @ mean) for V, r in zip(spread, registrations, strict=True)])
    around = a - a.mean(axis=0)
    found = around.T @ around / len(a) + np.mean(spread, axis=0)
    found = (found + signs[:, None] * found * signs) / 2
    return mean, (len(a) * found + ARTIST_SUBJECTS * np.linalg.inv(artist)) / (len(a) + ARTIST_SUBJECTS), a


def principal_axes(template: MorphableModel, covariance: Floats, signs: Floats) -> Floats:
    """Axes A (k, k), the largest motion of the surface first: ``A A^T`` is the covariance, the motions are orthogonal.

    They are symmetric or antisymmetric, as the modes are, and of definite sign.
    """
    modes = template.identity.reshape(len(signs), -1).astype(float)
    axes, motion = np.zeros((0, len(signs))), np.zeros(0)
    for sign in (1, -1):
        kind = np.flatnonzero(signs == sign)
        variances, U = np.linalg.eigh(covariance[np.ix_(kind, kind)])
        root = U * np.sqrt(variances)
        squares, turn = np.linalg.eigh(root.T @ modes[kind] @ modes[kind].T @ root)
        found = np.zeros((len(kind), len(signs)))
        found[:, kind] = (root @ turn).T
        axes, motion = np.vstack([axes, found]), np.r_[motion, squares]
    axes = axes[np.argsort(-motion)]
    largest = np.abs(axes).argmax(axis=1)
    return (axes * np.sign(axes[np.arange(len(axes)), largest])[:, None]).T


def landmark_statistics(
    template: MorphableModel,
    scans: MorphableModel,
    subjects: list[Floats],
    registrations: list[Registration],
    coefficients: Floats,
    rng: np.random.Generator,
) -> tuple[Floats, Floats]:
    """Mean (68, 3) and covariance (68, 3, 3) of the annotated point minus the visible point of the template, mm."""
    basis = landmark_basis(template)
    found = []
    for V, r, a in zip(subjects, registrations, coefficients, strict=True):
        x = r(V)
        shape = np.concatenate([a, np.zeros(len(template.expression))])
        found += landmark_displacements(scans, basis, x, template.vertices(a), shape, rng, POSES)
    moved = np.array(found)
    offsets = moved.mean(axis=0)
    scatter = np.einsum("sli,slj->lij", moved - offsets, moved - offsets) / len(moved)
    offsets[INNER] = 0.0
    return JAW_TRUST * offsets, scatter


def landmark_displacements(
    scans: MorphableModel,
    basis: LandmarkBasis,
    x: Floats,
    X: Floats,
    shape: Floats,
    rng: np.random.Generator,
    poses: int,
) -> list[Floats]:
    """(68, 3) of a subject x laid on the template X at random poses, and of its mirror image, mm."""
    found = []
    for _ in range(poses):
        angles = rng.uniform(-1, 1, 3) * [30, 12, 10]
        R = Rotation.from_euler("yxz", angles, degrees=True).as_matrix()
        moved = annotated(scans, x, R) - X[visible_landmarks(basis, shape, R)]
        found += [moved, moved[MIRROR] * FLIP]
    return found


def annotated(scans: MorphableModel, x: Floats, R: Floats) -> Floats:
    """The 68 points (68, 3) of a posed subject: a jaw point on the far side moves to the outline of the cheek."""
    points = x[scans.landmarks]
    hidden = (vertex_normals(x, scans.faces) @ R[2])[scans.landmarks] <= 0
    seen = x @ R.T
    narrow = np.flatnonzero(scans.region("narrow_face"))
    centre = seen[scans.landmarks[PARTS["nose"][:4]], :2].mean(axis=0)
    away = seen[narrow, :2] - centre
    angle, radius = np.arctan2(away[:, 1], away[:, 0]), np.hypot(*away.T)
    for k in PARTS["jaw"]:
        if not hidden[k] or k == 8:
            continue
        direction = np.arctan2(*(seen[scans.landmarks[k], :2] - centre)[::-1])
        near = np.abs((angle - direction + np.pi) % (2 * np.pi) - np.pi) < np.radians(3)
        if near.any():
            points[k] = x[narrow[near][np.argmax(radius[near])]]
    return points
