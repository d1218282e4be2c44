"""Caricature expressions against their rivals (Chen et al. 2020, section 3.2), on one BLAS thread.

usage: python benchmarks/caricature_expressions.py [--subjects N] [--sheets OUT] [FILE.pts ...]
Landmark files give the tables of structure and identity; pictures are not opened.
"""

import os

for variable in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"):
    os.environ[variable] = "1"

import argparse
import time
from functools import cache
from pathlib import Path

import numpy as np
import scipy.sparse as sp
from pictures import roles
from scipy.interpolate import RBFInterpolator

from toongeo import ScaledOrthographicCamera, align_face, default_model, fit_3dmm, read_landmarks, render_mesh
from toongeo.caricature import PartMapper, caricature_rig, face_space, fit_caricature, initial_blendshapes
from toongeo.caricature import optimize_blendshapes as optimize
from toongeo.caricature.blendshapes.initial_blendshapes import InitialBlendshapes
from toongeo.caricature.blendshapes.optimize_blendshapes import (
    BlendshapeWeights,
    displacement_masks,
    expression_similarities,
    signed_graph,
    squared_laplacian,
)
from toongeo.caricature.blendshapes.sparse_expression import sparse_expression
from toongeo.geometry.operators.factor import factor_spd, solve
from toongeo.io import write_image
from toongeo.model.anatomy.landmark_basis import landmark_basis
from toongeo.model.anatomy.visible_landmarks import landmarks_seen
from toongeo.pipeline import build_rig
from toongeo.render import Surface

model, space = default_model(), face_space()
AT, F = space.vertices, space.space.faces
NORMAL = model.expression[: model.n_named, AT].astype(float)
MASKS = displacement_masks(NORMAL)
ACTING = MASKS.max(axis=1) > 0
BLINK = model.expression_index("eyeBlinkLeft")
EYE = np.any([model.region(f"{name}_left") for name in ("eye", "eyelid_upper", "eyelid_lower", "socket")], axis=0)[AT]


def mixture(**weights: float) -> np.ndarray:
    """Coefficients of an expression; a name without its side stands for both."""
    e = np.zeros(len(model.expression))
    for name, weight in weights.items():
        for side in ("", "Left", "Right"):
            if name + side in model.expression_names:
                e[model.expression_index(name + side)] = weight
    return e


SOURCES = {
    "neutral": mixture(),
    "smile": mixture(mouthSmile=0.6),
    "open": mixture(jawOpen=0.4),
    "frown": mixture(browDown=0.8, mouthFrown=0.7),
}
TARGETS = [
    mixture(jawOpen=1), mixture(mouthSmile=1), mixture(mouthPucker=1), mixture(eyeBlink=1),
    mixture(browInnerUp=1, browOuterUp=1, eyeWide=1, jawOpen=0.6), mixture(mouthFrown=1, browDown=1),
    mixture(mouthLeft=1), mixture(noseSneer=1, mouthUpperUp=1), mixture(mouthStretch=1, mouthLowerDown=1),
    mixture(jawRight=1, browOuterUp=1),
]  # fmt: skip


def exaggerated(identity: np.ndarray, amount: float):
    """``vertices(expression)`` of a known subject, exaggerated in the deformation space as `exaggerate` does."""
    face = model.vertices(identity)[AT]
    own = space.space.fit(face, ridge=1e-2, iterations=10).w
    left = face - space.space.vertices(own)

    def vertices(expression: np.ndarray) -> np.ndarray:
        w = own + expression_weights(expression.tobytes())
        moved = space.space.vertices(w + amount * own) - space.space.vertices(w)
        return model.vertices(identity, expression)[AT] + moved + amount * (left - left.mean(0))

    return vertices


@cache
def expression_weights(expression: bytes) -> np.ndarray:
    """Weights in the space of an expression of the mean face."""
    shape = model.vertices(None, np.frombuffer(expression))[AT]
    return space.space.fit(shape, ridge=1e-3, iterations=5).w


def edited(fit, expression: np.ndarray) -> np.ndarray:
    """Displacements (68, 2) px of a fit's landmarks when it takes another expression."""
    faces = [model.vertices(fit.identity, e)[fit.landmark_vertices] for e in (expression, fit.expression)]
    return fit.project(faces[0]) - fit.project(faces[1])


def size(points: np.ndarray) -> float:
    return float(np.sqrt(((points - points.mean(0)) ** 2).sum()))


def landmark_errors(seed: int, amount: float) -> dict[str, float]:
    """Mean error, px of 512, of the landmarks of ten expressions predicted from one picture."""
    rng = np.random.default_rng(seed)
    identity = model.prior.mean + rng.standard_normal(len(model.identity))
    camera = ScaledOrthographicCamera.look(rng.uniform(-20, 20), rng.uniform(-5, 5), size=512)
    vertices, mapper = exaggerated(identity, amount), PartMapper(model)
    basis, whole = landmark_basis(model), model.mean.copy()
    whole[AT] = vertices(SOURCES["neutral"])
    at = landmarks_seen(basis, whole[basis.vertices], camera.rotation)  # the jaw where an annotator sees it
    seen = [camera.project(vertices(e)[space.rows(at)]) for e in TARGETS]
    errors: dict[str, list[float]] = {}
    for source in SOURCES.values():
        drawn = camera.project(vertices(source)[space.rows(at)])
        plain = fit_3dmm(None, drawn)
        scale = size(drawn) / size(plain.project(plain.vertices[plain.landmark_vertices]))
        points, context = mapper.to_normal(drawn)
        normal = sparse_expression(fit_3dmm(None, points, prior_weight=1e-6), points)
        subject = camera.project(model.vertices(identity, source)[at])
        for expression, truth in zip(TARGETS, seen, strict=True):
            own = camera.project(model.vertices(identity, expression)[at]) - subject
            for name, found in {
                "not moved": drawn,
                "copied from the fitted face": drawn + scale * edited(plain, expression),
                "F-": mapper.to_caricature(points + edited(normal, expression), context),
                "copied from the true subject": drawn + size(drawn) / size(subject) * own,
            }.items():
                errors.setdefault(name, []).append(np.linalg.norm(found - truth, axis=1).mean())
    return {name: float(np.mean(values)) for name, values in errors.items()}


def landmark_table(subjects: int) -> None:
    print(f"Landmarks of 10 expressions from one of 4, {subjects} subjects, mean error in px of 512\n")
    print(
        "| exaggeration | not moved | copied from the fitted face, scaled | F- "
        "| closer | copied from the true subject |"
    )
    print("|---|---|---|---|---|---|")
    for amount in (0.5, 1.0, 1.5):
        rows = [landmark_errors(1000 + seed, amount) for seed in range(subjects)]
        mean = {name: np.mean([row[name] for row in rows]) for name in rows[0]}
        closer = 100 * (1 - mean["F-"] / mean["copied from the fitted face"])
        still, copied, ours, true = mean.values()
        print(f"| {1 + amount:.1f} | {still:.2f} | {copied:.2f} | {ours:.2f} | {closer:.0f} % | {true:.2f} |")


def normal_table() -> None:
    """How far D* of a normal face is from M D, and the time of it."""
    D = np.concatenate([np.zeros_like(NORMAL[:1]), NORMAL])
    wanted = MASKS[ACTING][..., None] * NORMAL[ACTING]
    best = optimize(NORMAL, NORMAL, model.mean[AT], F)[ACTING]
    off = np.linalg.norm(best - wanted, axis=(1, 2)) / np.linalg.norm(wanted, axis=(1, 2))
    peak = np.linalg.norm(best, axis=2).max(axis=1) / np.linalg.norm(wanted, axis=2).max(axis=1)
    print("\n| a normal face as input | mean | worst |\n|---|---|---|")
    print(f"| D* off M D, % | {100 * off.mean():.1f} | {100 * off.max():.1f} |")
    print(f"| peak motion kept, % | {100 * peak.mean():.1f} | {100 * peak.min():.1f} |\n")
    ours, rival = [], []
    for _ in range(2):
        started = time.process_time()
        optimize(D, D, model.mean[AT], F)
        ours.append(time.process_time() - started)
        started = time.process_time()
        factorizations(D)
        rival.append(time.process_time() - started)
    print(f"47 shapes x {len(AT)} vertices: {min(ours):.2f} s; 47 factorizations {min(rival):.2f} s")


def factorizations(D: np.ndarray) -> None:
    """The rival: one factor for each eigenvector of the graph."""
    weights = BlendshapeWeights()
    moving = MASKS.max(axis=0) > 0
    K = squared_laplacian(model.mean[AT], F, weights.reach)[moving][:, moving]
    values, turn = np.linalg.eigh(weights.structure * signed_graph(expression_similarities(D)))
    right = np.einsum("knc,kl->nlc", D[:, moving], turn)
    for k, value in enumerate(values):
        shifted = (weights.deformation + weights.smoothness) * K + (max(value, 0) + 1e-9) * sp.eye_array(K.shape[0])
        solve(factor_spd(shifted), np.ascontiguousarray(right[:, k]))


def warped(initial: InitialBlendshapes) -> np.ndarray:
    """The paper's baseline: a thin-plate warp of the picture by its landmarks, as displacements (k, v, 3), mm."""
    camera, P = initial.source.camera, initial.source.vertices[AT]
    across = camera.jacobian(np.zeros((1, 3)))[0]
    back = np.linalg.pinv(across)
    points, unique = np.unique(initial.landmarks[0], axis=0, return_index=True)
    move = (initial.landmarks[1:] - initial.landmarks[0])[:, unique].transpose(1, 0, 2).reshape(len(points), -1)
    shift = RBFInterpolator(points, move, kernel="thin_plate_spline")(camera.project(P))
    return shift.reshape(len(P), -1, 2).transpose(1, 0, 2) @ back.T


def deviation(D: np.ndarray) -> float:
    """Of the correlation matrix from the normal face's (Eq. 8), root mean square over the pairs."""
    off = (expression_similarities(D) - expression_similarities(NORMAL))[np.ix_(ACTING, ACTING)]
    return float(np.sqrt((off[~np.eye(len(off), dtype=bool)] ** 2).mean()))


def identity_errors(D: np.ndarray, face: float) -> tuple[float, float]:
    """Largest motion outside the eye for a blink, % of the face; mean motion outside the masks, % of that inside."""
    motion = np.linalg.norm(D, axis=2)
    outside = [motion[k][MASKS[k] < 0.05].mean() / motion[k][MASKS[k] >= 0.05].mean() for k in np.flatnonzero(ACTING)]
    return 100 * motion[BLINK][~EYE].max() / face, 100 * float(np.mean(outside))


def clay(V: np.ndarray) -> np.ndarray:
    skin = V[model.region("face")]
    low, high = skin.min(0), skin.max(0)
    camera = ScaledOrthographicCamera.look(15, size=200, centre=(low + high) / 2, extent=1.3 * (high - low).max())
    return render_mesh([Surface(V, model.faces)], camera, 200, shading="clay")


def picture_table(files: list[Path], sheets: Path | None) -> None:
    rows: dict[str, list[list[float]]] = {}
    for path in files:
        landmarks = read_landmarks(path)
        face = align_face(fit_3dmm(None, landmarks), landmarks)
        started = time.process_time()
        rig = caricature_rig(face, landmarks)
        seconds = time.process_time() - started
        initial = initial_blendshapes(fit_caricature(None, landmarks), landmarks)
        transferred = build_rig(face)
        found = {
            "not optimized": initial.vertices[1:] - initial.vertices[0],
            "thin-plate warp": warped(initial),
            "deformation transfer": transferred.deltas[:, AT].astype(float),
            "optimized (Eq. 11)": optimize(initial.vertices[1:] - initial.vertices[0], NORMAL, face.vertices[AT], F),
            "caricature_rig": rig.deltas[:, AT].astype(float),
        }
        size_mm = float(np.ptp(face.vertices[model.region("face")], axis=0).max())
        for name, D in found.items():
            rows.setdefault(name, []).append([deviation(D), *identity_errors(D, size_mm), seconds])
        if sheets:
            pairs = [[clay(each.vertices(dict(w))) for w in SHEET] for each in (rig, transferred)]
            write_image(sheets / f"{path.stem}_expressions.png", np.vstack([np.hstack(pair) for pair in pairs]))
    base = np.mean(rows["not optimized"], axis=0)[0]
    print(f"\n{len(files)} drawings: correlation matrix against the normal face's, and what moves that should not\n")
    print("| method | deviation of the cosines, % of the unoptimized ", end="")
    print("| blink outside the eye, % of the face | outside / inside the mask, % |\n|---|---|---|---|")
    for name, values in rows.items():
        cosines, blink, outside, _ = np.mean(values, axis=0)
        print(f"| {name} | {100 * cosines / base:.0f} | {blink:.2f} | {outside:.1f} |")
    print(roles("caricature_expressions", [path.stem for path in files]))
    print(f"\nshape stage: {np.median([row[3] for row in rows['caricature_rig']]):.1f} s (median)")


SHEET = [
    {},
    {"jawOpen": 1.0},
    {"mouthSmileLeft": 1.0, "mouthSmileRight": 1.0},
    {"mouthPucker": 1.0},
    {"eyeBlinkLeft": 1.0, "eyeBlinkRight": 1.0},
    {"browInnerUpLeft": 1.0, "browInnerUpRight": 1.0, "browOuterUpLeft": 1.0, "browOuterUpRight": 1.0, "jawOpen": 0.6},
    {"mouthDimpleLeft": 1.0, "mouthSmileLeft": 0.5, "noseSneerLeft": 0.6},
]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("files", nargs="*", type=Path)
    parser.add_argument("--subjects", type=int, default=4)
    parser.add_argument("--sheets", type=Path, help="folder for clay pictures: ours above deformation transfer")
    arguments = parser.parse_args()
    if arguments.subjects:
        landmark_table(arguments.subjects)
    normal_table()
    if arguments.files:
        picture_table(arguments.files, arguments.sheets)


if __name__ == "__main__":
    main()
