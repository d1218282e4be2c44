"""Alignment of the coarse face with its landmarks: what is reached, what folds, and what is foretold of hidden points.

usage: python benchmarks/alignment.py [--left-out] [FOLDER ...]   (pictures with .pts or .txt beside them; default: the
examples); with --left-out only the errors of the landmarks left out, by the parts of the face

For each picture: the greatest error of an anchor, the triangles of the face that intersect others, and the mean error
of every third landmark, left out of fit and alignment (mean of the three ways to do so); all errors in percent of the
outer-eye distance. "Plain" is the uniform Laplacian without the flow.
Then depth on exaggerated faces of the model, whose truth is known; mouths as wide as the face; seconds against ARAP.
"""

import os

for variable in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"):
    os.environ[variable] = "1"

import sys
import time
from collections.abc import Callable, Iterator

import igl
import numpy as np
from pictures import FOLDER, Picture, pictures, roles

from toongeo import LaplacianAligner, align_face, default_model, fit_3dmm, laplacian_align, read_landmarks
from toongeo.geometry.rotations.similarity import similarity
from toongeo.metrics import mesh_quality
from toongeo.model.anatomy.visible_contour import visible_contour
from toongeo.model.ibug68 import OUTER_EYES
from toongeo.model.ibug68 import PARTS as LANDMARK_PARTS
from toongeo.render import ScaledOrthographicCamera

PLAIN = {"flow": False, "slide": False}
PHASES = 3
# Landmarks about whose centre a part grows, how far behind them the centre lies (mm), its radius (mm), its growth.
MOUTHS = ((0, 0, 1.5, 1.5), (0, 0, 2, 2), (0, 0, 2.3, 1.2), (35, 0, 1.8, 1.8), (35, -25, 1.8, 1.8), (-50, -20, 1.6, 2))
PARTS = {
    "nose": ((range(30, 34), 20, 30, 1.5),),
    "eyes": ((range(36, 42), 8, 22, 1.4), (range(42, 48), 8, 22, 1.4)),
    "chin": ((range(8, 9), 0, 45, 1.4),),
    "mouth": ((range(48, 60), 0, 32, 1.4),),
}


def errors(face, landmarks: np.ndarray) -> np.ndarray:
    """Percent of the outer-eye distance, (68,)."""
    right, left = landmarks[list(OUTER_EYES)]
    found = face.project(face.vertices[face.landmark_vertices])
    return 100 * np.linalg.norm(found - landmarks, axis=1) / np.linalg.norm(left - right)


def crossing(face) -> float:
    front = face.faces[face.region("face")[face.faces].all(1)]
    return 100 * mesh_quality(face.vertices, front).intersecting_fraction


def held_out(landmarks: np.ndarray) -> np.ndarray:
    """Mean error of the landmarks left out: coarse, plain, aligned."""
    total = np.zeros(3)
    for phase in range(PHASES):
        hidden = np.arange(68) % PHASES == phase
        fewer = np.where(hidden[:, None], np.nan, landmarks)
        fit = fit_3dmm(None, fewer)
        faces = fit, align_face(fit, fewer, **PLAIN), align_face(fit, fewer)
        total += [errors(face, landmarks)[hidden].mean() for face in faces]
    return total / PHASES


def left_out_rows(found: list[Picture]) -> None:
    """Errors of the landmarks left out of alignment, every third in three ways, beside the middle of two neighbours."""
    table = []
    for picture in found:
        landmarks = read_landmarks(picture.landmarks)
        right, left = landmarks[list(OUTER_EYES)]
        middle = np.full((68, 2), np.nan)
        middle[1:16] = (landmarks[:15] + landmarks[2:17]) / 2
        aligned = np.full(68, np.nan)
        for phase in range(PHASES):
            hidden = np.arange(68) % PHASES == phase
            fewer = np.where(hidden[:, None], np.nan, landmarks)
            aligned[hidden] = errors(align_face(fit_3dmm(None, fewer), fewer), landmarks)[hidden]
        simple = 100 * np.linalg.norm(middle - landmarks, axis=1) / np.linalg.norm(left - right)
        table.append([aligned, simple])
        print(f"| {picture.name} | {aligned.mean():.2f} |", flush=True)
    aligned, simple = np.array(table).transpose(1, 0, 2)
    print("| part | left out, % of the outer-eye distance |\n|---|---|")
    for part, points in LANDMARK_PARTS.items():
        print(f"| {part} | {aligned[:, list(points)].mean():.2f} |")
    print(f"| points 1-15 of the jaw | {aligned[:, 1:16].mean():.2f} |")
    print(f"| the middle of their neighbours | {simple[:, 1:16].mean():.2f} |")
    print(f"| all | {aligned.mean():.2f} |")
    print(f"{(aligned.mean(axis=1) <= 3).sum()} of {len(aligned)} pictures at most 3 %.")
    print(roles("alignment", [picture.name for picture in found]))


def picture_rows(found: list[Picture]) -> None:
    print("| picture | anchors, max % | self-intersecting: coarse % | plain % | aligned % ", end="")
    print("| held out: coarse % | plain % | aligned % |")
    print("|---|---|---|---|---|---|---|---|")
    rows = []
    for picture in found:
        landmarks = read_landmarks(picture.landmarks)
        fit = fit_3dmm(None, landmarks)
        face = align_face(fit, landmarks)
        crossings = [crossing(shape) for shape in (fit, align_face(fit, landmarks, **PLAIN), face)]
        rows.append([errors(face, landmarks).max(), *crossings, *held_out(landmarks)])
        print(f"| {picture.name} | {row(rows[-1])} |", flush=True)
    print(f"| mean of {len(rows)} | {row(np.mean(rows, 0))} |")
    print(roles("alignment", [picture.name for picture in found]), "\n")


def row(values) -> str:
    return " | ".join(f"{value:.4f}" if k == 0 else f"{value:.3f}" for k, value in enumerate(values))


def exaggerated(n: int) -> Iterator[tuple[str, np.ndarray, ScaledOrthographicCamera]]:
    """Random faces with a part that has grown alike in all directions about its own centre."""
    model = default_model()
    for part, places in PARTS.items():
        for seed in range(n):
            rng = np.random.default_rng(seed)
            V = model.vertices(rng.normal(0, 0.8, len(model.identity)))
            for points, behind, radius, growth in places:
                centre = V[model.landmarks[list(points)]].mean(0) - [0, 0, behind]
                near = np.exp(-((np.linalg.norm(V - centre, axis=1) / radius) ** 4))
                V = V + (growth - 1) * near[:, None] * (V - centre)
            yield part, V, ScaledOrthographicCamera.look(rng.uniform(-30, 30), rng.uniform(-10, 10))


def known_depth(n: int = 3) -> None:
    model = default_model()
    front = model.region("face")
    forms = {"plain": PLAIN, "keep": {"depth": "keep"}, "scaled": {"depth": "scaled"}}
    found: dict[str, list[list[float]]] = {}
    for part, truth, camera in exaggerated(n):
        landmarks = camera.project(truth[visible_contour(model, camera, truth, model.landmarks)])
        fit = fit_3dmm(None, landmarks)
        shapes = [fit.vertices, *(align_face(fit, landmarks, **options).vertices for options in forms.values())]
        found.setdefault(part, []).append([distance(V[front], truth[front]) for V in shapes])
    print("| part that has grown | coarse mm |", " | ".join(f"{name} mm" for name in forms), "|")
    print("|---|---|---|---|---|")
    for part, rows in found.items():
        print(f"| {part} | " + " | ".join(f"{value:.2f}" for value in np.mean(rows, 0)) + " |")
    print("| mean | " + " | ".join(f"{value:.2f}" for value in np.mean(list(found.values()), (0, 1))) + " |\n")


def wide_mouths() -> None:
    """Heads of the model whose open mouth is twice as wide and high as the model has it, from several sides."""
    model = default_model()
    expression = np.zeros(len(model.expression))
    expression[model.expression_names.index("jawOpen")] = 1.0
    print("| yaw, pitch, width, height | self-intersecting triangles: coarse | aligned | error of the mouth, mm |")
    print("|---|---|---|---|")
    for yaw, pitch, width, height in MOUTHS:
        V = model.vertices(np.random.default_rng(0).normal(0, 0.5, len(model.identity)), expression)
        away = V - V[model.landmarks[48:]].mean(0)
        near = np.exp(-((np.linalg.norm(away / [width, height, 1], axis=1) / 30) ** 2))
        truth = V + near[:, None] * away * [width - 1, height - 1, 0]
        camera = ScaledOrthographicCamera.look(yaw, pitch)
        landmarks = camera.project(truth[visible_contour(model, camera, truth, model.landmarks)])
        fit = fit_3dmm(None, landmarks)
        face = align_face(fit, landmarks)
        crossings = [
            round(crossing(shape) * model.region("face")[model.faces].all(1).sum() / 100) for shape in (fit, face)
        ]
        lips = model.region("lips")
        print(f"| {yaw}, {pitch}, {width}, {height} | {crossings[0]} | {crossings[1]} ", end="")
        print(f"| {distance(face.vertices[lips], truth[lips]):.2f} |")


def distance(V: np.ndarray, truth: np.ndarray) -> float:
    """Mean distance of partners, mm, after the best similarity."""
    scale, rotation, shift = similarity(V, truth)
    return float(np.linalg.norm(scale * V @ rotation.T + shift - truth, axis=1).mean())


def best(run: Callable[[], object], times: int) -> float:
    seconds = []
    for _ in range(times):
        started = time.perf_counter()
        run()
        seconds.append(time.perf_counter() - started)
    return min(seconds)


def times() -> None:
    landmarks = read_landmarks(FOLDER / "blue_girl.pts")
    fit = fit_3dmm(None, landmarks)
    # Without teeth and tongue: ARAP wants an anchor in every component.
    loose = np.any([fit.region(name) for name in ("teeth_upper", "teeth_lower", "tongue")], axis=0)
    kept = np.flatnonzero(~loose)
    V, F = fit.vertices[kept], np.searchsorted(kept, fit.faces[~loose[fit.faces].any(1)])
    vertices, first = np.unique(fit.landmark_vertices, return_index=True)
    targets = fit.camera.unproject(landmarks[first], fit.camera.depth(fit.vertices[vertices]))
    anchors = np.searchsorted(kept, vertices)

    def arap() -> None:
        data = igl.ARAPData()
        data.max_iter = 100
        igl.arap_precomputation(V, F, 3, anchors.astype(np.int32), data)
        igl.arap_solve(targets, data, V)

    aligner = LaplacianAligner(V, F, anchors)
    rows = {
        "ARAP (libigl, 100 iterations)": best(arap, 1),
        "laplacian_align, new mesh": best(lambda: laplacian_align(V, F, anchors, targets), 5),
        "the same, 5 rotations": best(lambda: laplacian_align(V, F, anchors, targets, rotations=5), 2),
        "LaplacianAligner, again": best(lambda: aligner.align(targets), 30),
        "align_face": best(lambda: align_face(fit, landmarks), 3),
    }
    print(f"| {len(V)} vertices | ms |\n|---|---|")
    for name, seconds in rows.items():
        print(f"| {name} | {1000 * seconds:.2f} |")


def main() -> None:
    if "--left-out" in sys.argv:
        left_out_rows(pictures([argument for argument in sys.argv[1:] if argument != "--left-out"]))
        return
    picture_rows(pictures(sys.argv[1:]))
    known_depth()
    wide_mouths()
    times()


if __name__ == "__main__":
    main()
