"""Speed and memory of the deformation space, with `scipy.optimize.least_squares` as rival (one BLAS thread).

usage: python benchmarks/caricature.py FOLDER      (pictures are not opened; landmarks are)

The comparison with the paper's baselines is `toongeo bench caricature FOLDER`.
"""

import os

for variable in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"):
    os.environ[variable] = "1"

import argparse
import resource
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
from pictures import pictures, roles
from scipy.optimize import least_squares

from toongeo import align_face, default_model, fit_3dmm, read_landmarks
from toongeo.caricature import CaricatureOptions, DeformationSpace, face_space, fit_caricature
from toongeo.caricature.space.face_space import _face_space
from toongeo.caricature.space.fit_weights import WeightProblem

SMALL = 10  # shapes of the rival's case: with all of them its Jacobian takes gigabytes


def seconds(work: Callable[[], object], times: int = 3) -> float:
    """CPU seconds, the best of several."""
    taken = []
    for _ in range(times):
        started = time.process_time()
        work()
        taken.append(time.process_time() - started)
    return min(taken)


def edges_residual(space: DeformationSpace, P: np.ndarray) -> Callable[[np.ndarray], np.ndarray]:
    """Residuals of Eq. 9, an edge at a time."""
    L, V = space.rings.laplacian.tocoo(), space.reference
    i, j, c = (a[L.row != L.col] for a in (L.row, L.col, -L.data))
    e, moved, root = V[i] - V[j], P[i] - P[j], np.sqrt(c)[:, None]

    def residual(w: np.ndarray) -> np.ndarray:
        T = space.gradients(w.reshape(2, -1)) + np.eye(3)[:, :, None]
        return (root * (moved - np.einsum("abe,eb->ea", T[:, :, i], e))).ravel()

    return residual


def rival() -> None:
    """The w-step on a space of few shapes, by finite differences and by ours."""
    full, rng = face_space().space, np.random.default_rng(0)
    kept = slice(0, SMALL)
    small = DeformationSpace(
        full.reference,
        full.faces,
        full.rotations[kept],
        full.stretches[kept],
        full.bends[kept],
        full.offsets[kept],
        full.rings,
    )
    P = small.vertices(rng.normal(size=(2, SMALL)))
    started = time.process_time()
    found = least_squares(edges_residual(small, P), np.zeros(2 * SMALL), method="trf", xtol=1e-6, ftol=1e-6)
    theirs = time.process_time() - started
    ours = small.fit(P)
    taken = seconds(lambda: small.fit(P))
    energy = WeightProblem(small, P).energy(found.x.reshape(2, -1))
    print(
        f"w-step, {SMALL} shapes: least_squares {theirs:.2f} s, E {energy:.3f}; ours {taken:.3f} s, E {ours.energy:.3f}"
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    found = pictures([parser.parse_args().folder])
    landmarks = [read_landmarks(picture.landmarks) for picture in found]
    space = face_space().space
    model = default_model()
    print("| step | CPU s |\n|---|---|")
    print(f"| space of 98 shapes | {seconds(lambda: _face_space.__wrapped__(model)):.2f} |")
    first = fit_caricature(None, landmarks[0])
    P, options = first.vertices[first.space.vertices], CaricatureOptions()
    used = seconds(lambda: space.fit(P, ridge=options.ridge, iterations=options.steps))
    steps = len(space.fit(P, ridge=options.ridge).energies) - 1
    whole = seconds(lambda: space.fit(P, ridge=options.ridge))
    print(f"| w-step as used, {options.steps} steps | {used:.2f} |")
    print(f"| w-step to convergence, {steps} steps | {whole:.2f} |", flush=True)
    rows = []
    for q in landmarks:
        ordinary = fit_3dmm(None, q)
        aligned = seconds(lambda q=q, ordinary=ordinary: align_face(ordinary, q))
        cold = seconds(lambda q=q: fit_caricature(None, q))
        face, opened = fit_caricature(None, q), q + np.where(np.arange(68)[:, None] > 54, [0.0, 3.0], 0.0)
        quick = CaricatureOptions(tuck=False)
        warm = seconds(lambda: fit_caricature(None, opened, start=face, iterations=1, options=quick))  # noqa: B023
        rows.append([aligned, cold, warm])
    for name, middle in zip(("`align_face`", "whole fit", "warm start"), np.median(rows, axis=0), strict=True):
        print(f"| {name}, median | {middle:.2f} |", flush=True)
    print(roles("caricature", [picture.name for picture in found]), "\n")
    print(f"largest memory before the rival: {resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024:.0f} MB")
    rival()
    print(f"largest memory: {resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024:.0f} MB")


if __name__ == "__main__":
    main()
