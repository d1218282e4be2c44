"""The rig against named rivals in one run: transfer, frames, pose, gains, and the seconds of the whole stage.

usage: python benchmarks/rig.py [ICT_FACEKIT_NPZ]

The file, `ict_facekit_light.npz`, gives the 11,248 vertices of face, head and neck for the first rows; without it only
the default template is measured. CPU seconds, one BLAS thread, best of several runs.
"""

import os

for variable in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"):
    os.environ[variable] = "1"

import gc
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace

import numpy as np
from pictures import Picture, pictures, roles

from toongeo import (
    Animator,
    DeformationTransfer,
    Rig,
    align_face,
    build_rig,
    default_model,
    deformation_transfer,
    fit_3dmm,
    fit_lids,
    fit_mouth,
    neutral_face,
    read_image,
    read_landmarks,
)
from toongeo.geometry.source_motion import source_motion
from toongeo.model import MorphableModel, load_ict_facekit
from toongeo.model.anatomy.gaze import GAZE_NAMES
from toongeo.pipeline.rig.build_rig import AT_ONCE
from toongeo.pipeline.rig.fit_pose import fit_pose

MOVES_MM = 0.05
Mesh = tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]


def best(run: Callable[[], object], times: int) -> float:
    """Least CPU seconds of several runs."""
    seconds = []
    for _ in range(times):
        started = time.process_time()
        run()
        seconds.append(time.process_time() - started)
    return min(seconds)


def mesh_of(model: MorphableModel) -> Mesh:
    """Rest, faces, 46 shapes, and another face as target."""
    coefficients = np.random.default_rng(0).normal(size=len(model.identity))
    return model.mean, model.faces, model.expression[:46], model.vertices(0.5 * coefficients)


def transfer_rows(name: str, mesh: Mesh) -> None:
    V, F, shapes, target = mesh
    still = np.flatnonzero(np.abs(shapes).max(axis=(0, 2)) < MOVES_MM)

    corners = np.ascontiguousarray(F.T)
    motions = [source_motion(V, corners, shape) for shape in shapes]  # once a model, whatever the number of targets

    def ours() -> None:
        transfer = DeformationTransfer(V, F, target, pinned=still, align=True)
        deltas = np.empty(shapes.shape, np.float32)
        for start in range(0, len(shapes), AT_ONCE):
            deltas[start : start + AT_ONCE] = transfer.displacements(motions[start : start + AT_ONCE])

    def one_by_one() -> None:
        for shape in shapes[:6]:
            deformation_transfer(V, V + shape, F, target, pinned=still)

    mine, rival = best(ours, 3), best(one_by_one, 1) * len(shapes) / 6
    print(
        f"| transfer of 46, {name} ({len(V):,} vertices) | {1000 * mine:.0f} ms | 46 factorizations (6 measured)"
        f" {1000 * rival:.0f} ms | {rival / mine:.1f} |"
    )


def frame_rows(name: str, mesh: Mesh) -> None:
    V, _, shapes, _ = mesh
    rig = Rig(
        tuple(map(str, range(46))), V, shapes.astype(np.float32), np.zeros((8, *V.shape), np.float32), np.zeros(46), {}
    )
    animator = Animator(SimpleNamespace(rig=rig, eyes=None, faces=None), limits=None)
    out, rng = np.empty(V.shape, np.float32), np.random.default_rng(0)
    for active in (46, 12, 3):
        weights = np.zeros(46 + len(GAZE_NAMES))
        weights[rng.choice(46, active, replace=False)] = rng.random(active)
        frame = best(lambda weights=weights: [animator.frame(weights, out=out) for _ in range(100)], 5) / 100
        naive = best(lambda weights=weights: V + np.tensordot(weights[:46], shapes, 1), 5)
        print(
            f"| frame, {active} of 46 active, {name} | {1000 * frame:.3f} ms ({1 / frame:,.0f} a second) |"
            f" float64 tensordot {1000 * naive:.2f} ms | {naive / frame:.1f} |"
        )


def memory(path: str | None) -> None:
    """Peak memory that a transfer of 46 adds, in a process of its own."""
    code = "import sys; sys.path.insert(0, sys.argv[1]); import rig; rig.peak(*sys.argv[2:])"
    command = [sys.executable, "-c", code, str(Path(__file__).parent), *([path] if path else [])]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    print(f"| peak memory of the transfer of 46, float32 results included | {done.stdout.strip()} MB | | |")


def peak(path: str | None = None) -> None:
    V, F, shapes, target = mesh_of(load_ict_facekit(path) if path else default_model())
    gc.collect()
    Path("/proc/self/clear_refs").write_text("5")  # resets the peak to what is held now (Linux)
    before = resource_mb()
    transfer = DeformationTransfer(V, F, target, align=True)
    deltas = np.empty(shapes.shape, np.float32)
    for delta, shape in zip(deltas, shapes, strict=True):
        delta[:] = transfer(V + shape) - target
    print(resource_mb() - before)


def resource_mb() -> int:
    """Peak resident memory of this process."""
    line = next(line for line in Path("/proc/self/status").read_text().splitlines() if line.startswith("VmHWM"))
    return int(line.split()[1]) // 1024


def picture_row(picture: Picture) -> None:
    """One picture: how well its pose comes back, gains, and the whole stage."""
    landmarks = read_landmarks(picture.landmarks)
    face = align_face(fit_3dmm(read_image(picture.image), landmarks), landmarks)

    def stage() -> tuple[Rig, np.ndarray, np.ndarray]:
        neutral = neutral_face(face)
        rig, _ = fit_lids(neutral, fit_mouth(neutral, build_rig(neutral)))
        shown = rig.neutral + face.vertices - neutral.vertices
        return rig, shown, np.asarray(fit_pose(rig, shown, face.region("skin")))

    stage()  # what is cached once a process
    started = time.process_time()
    rig, shown, pose = stage()
    seconds = time.process_time() - started
    skin = face.region("face")
    moved, left = (np.sqrt(((V - shown)[skin] ** 2).sum(1).mean()) for V in (rig.neutral, rig.vertices(pose)))
    plain, auto = build_rig(neutral_face(face)), build_rig(neutral_face(face), gain="auto")
    gains = [float(np.linalg.norm(a) / np.linalg.norm(b)) for a, b in zip(auto.deltas, plain.deltas, strict=True)]
    opened, wide = (gains[plain.names.index(expression)] for expression in ("jawOpen", "eyeWideLeft"))
    print(
        f"| {picture.name} | {seconds:.2f} | {moved:.2f} | {left:.2f} |"
        f" {min(gains):.2f} .. {max(gains):.2f} | {opened:.2f} | {wide:.2f} |",
        flush=True,
    )


def main() -> None:
    path = sys.argv[1] if len(sys.argv) > 1 else None
    models = {"ICT-FaceKit": load_ict_facekit(path)} if path else {}
    print("| step | ours | rival | ratio |\n|---|---|---|---|")
    for name, model in {**models, "template": default_model()}.items():
        mesh = mesh_of(model)
        transfer_rows(name, mesh)
        frame_rows(name, mesh)
    memory(path)
    print("\n| picture | whole rig s | removed mm | pose misses mm | gains | jawOpen | eyeWideLeft |")
    print("|---|---|---|---|---|---|---|")
    found = pictures()
    for picture in found:
        picture_row(picture)
    print(roles("rig", [picture.name for picture in found]))


if __name__ == "__main__":
    main()
