"""Caricatures against the baselines of Wu et al. 2018, section 5.2, on a folder of pictures (one BLAS thread).

usage: python benchmarks/caricature.py [--sheets OUT] FOLDER ...   (pictures are not opened; X.pts or X.txt are)
"""

import os

for variable in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"):
    os.environ[variable] = "1"

import argparse
import time
from collections import defaultdict
from pathlib import Path

import igl
import numpy as np

from toongeo import ScaledOrthographicCamera, align_face, default_model, fit_3dmm, read_landmarks, render_mesh
from toongeo.caricature.bilinear_model import BilinearModel, bilinear_fit
from toongeo.caricature.caricatured_modes import caricatured_modes
from toongeo.caricature.face_space import face_space
from toongeo.caricature.fit_caricature import fit_caricature
from toongeo.caricature.linear_fit import LinearFit, linear_fit
from toongeo.io import write_image
from toongeo.metrics import mesh_quality
from toongeo.render import Surface

HELD = 23
PREDICT = "fit_3dmm", "fit_3dmm + ARAP", "fine stage", "fit_caricature"  # whose held-out error is measured
model = default_model()
FACE = model.region("face")[model.faces].all(1)
LOOSE = np.any([model.region(name) for name in ("teeth_upper", "teeth_lower", "tongue")], axis=0)


def arap(fit, landmarks: np.ndarray) -> LinearFit:
    """ARAP (libigl) from a fit to the landmarks, at the fit's depth. Teeth and tongue stay: it wants an anchor each."""
    kept, seen = np.flatnonzero(~LOOSE), np.isfinite(landmarks).all(1)
    V, F = fit.vertices[kept], np.searchsorted(kept, model.faces[~LOOSE[model.faces].any(1)])
    vertices, first = np.unique(fit.landmark_vertices[seen], return_index=True)
    targets = fit.camera.unproject(landmarks[seen][first], fit.camera.depth(fit.vertices[vertices]))
    data = igl.ARAPData()
    data.max_iter = 20
    igl.arap_precomputation(V, F, 3, np.searchsorted(kept, vertices).astype(np.int32), data)
    deformed = fit.vertices.copy()
    deformed[kept] = igl.arap_solve(targets, data, V)
    return LinearFit(deformed, fit.camera, fit.landmark_vertices)


def bending(V: np.ndarray) -> float:
    """Squared differences of the normals across the edges of the face."""
    F = model.faces[FACE]
    normals = np.cross(V[F[:, 1]] - V[F[:, 0]], V[F[:, 2]] - V[F[:, 0]])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True) + 1e-30
    edges = np.sort(np.stack([F, np.roll(F, -1, 1)], 2).reshape(-1, 2), 1)
    key = edges[:, 0] * len(V) + edges[:, 1]
    order = np.argsort(key, kind="stable")
    pair = np.flatnonzero(key[order][1:] == key[order][:-1])
    a, b = order[pair] // 3, order[pair + 1] // 3
    return float(((normals[a] - normals[b]) ** 2).sum())


def error_px(fit, landmarks: np.ndarray, rows=slice(None)) -> float:
    left = fit.camera.project(fit.vertices[fit.landmark_vertices]) - landmarks
    return float(np.sqrt((left[rows] ** 2).sum(1).mean()))


def methods():
    linear = np.concatenate([model.identity, model.expression])
    bilinear = BilinearModel.from_model(model, np.random.default_rng(0))
    caricatured = caricatured_modes(model, np.random.default_rng(0))
    plain = {
        "3DMM (3000)": lambda q: linear_fit(q, model, model.mean, linear, 3000.0),
        "3DMM (0)": lambda q: linear_fit(q, model, model.mean, linear, 0.0),
        "bilinear": lambda q: bilinear_fit(q, model, bilinear),
        "caricatured 3DMM": lambda q: linear_fit(q, model, *caricatured, 3000.0),
        "fit_3dmm": lambda q: fit_3dmm(None, q),
    }
    bent = {f"{name} + ARAP": lambda q, fit=fit: arap(fit(q), q) for name, fit in plain.items() if name != "3DMM (0)"}
    ours = {
        "fine stage": lambda q: align_face(fit_3dmm(None, q), q),
        "fit_caricature": lambda q: fit_caricature(None, q),
    }
    return plain | bent | ours


def measured(fit, landmarks: np.ndarray, predict: bool):
    started = time.perf_counter()
    found = fit(landmarks)
    seconds = time.perf_counter() - started
    quality = mesh_quality(found.vertices, model.faces, selection=FACE)
    outer_eyes = np.linalg.norm(landmarks[36] - landmarks[45])
    held_out = np.nan
    if predict:
        held = np.random.default_rng(0).permutation(68)[:HELD]
        fewer = landmarks.copy()
        fewer[held] = np.nan
        held_out = 100 * error_px(fit(fewer), landmarks, held) / outer_eyes
    row = [
        error_px(found, landmarks),
        held_out,
        100 * quality.intersecting_fraction,
        len(quality.intersecting) == 0,
        quality.folded_count,
        bending(found.vertices),
        seconds,
    ]
    return found, row


def clay(V: np.ndarray, size: int = 256) -> np.ndarray:
    skin = V[model.region("skin")]
    low, high = skin.min(0), skin.max(0)
    views = [
        ScaledOrthographicCamera.look(yaw, size=size, centre=(low + high) / 2, extent=1.1 * (high - low).max())
        for yaw in (0, 40)
    ]
    return np.vstack([render_mesh([Surface(V, model.faces)], camera, size, shading="clay") for camera in views])


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folders", nargs="+", type=Path)
    parser.add_argument("--sheets", type=Path, help="folder for a clay picture of each face")
    arguments = parser.parse_args()
    started = time.perf_counter()
    face_space()
    print(f"deformation space of 98 shapes: {time.perf_counter() - started:.2f} s")
    files = [p for folder in arguments.folders for p in sorted(folder.glob("*")) if p.suffix in (".txt", ".pts")]
    rows, all_methods = defaultdict(list), methods()
    for path in files:
        landmarks = read_landmarks(path)
        results = {name: measured(fit, landmarks, name in PREDICT) for name, fit in all_methods.items()}
        for name, (_, row) in results.items():
            rows[name].append(row)
        if arguments.sheets:
            shown = ("3DMM (3000)", "fit_3dmm + ARAP", "caricatured 3DMM + ARAP", "fine stage", "fit_caricature")
            sheet = np.hstack([clay(results[name][0].vertices) for name in shown])
            write_image(arguments.sheets / f"{path.stem}.png", sheet)
    print(f"{len(files)} pictures; E_error of Eq. 20; held out: {HELD} of 68 landmarks\n")
    print("| method | E_error px | held out, % of the eyes | intersecting % | none | folds | bending | median s |")
    print("|---|---|---|---|---|---|---|---|")
    for name, values in rows.items():
        error, held, share, none, folds, bend, seconds = np.array(values, float).T
        print(
            f"| {name} | {error.mean():.3f} | {held.mean():.2f} | {share.mean():.3f} | {100 * none.mean():.0f} % "
            f"| {folds.mean():.1f} | {bend.mean():.0f} | {np.median(seconds):.2f} |"
        )


if __name__ == "__main__":
    main()
