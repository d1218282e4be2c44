"""Median error of the narrow face on subjects whose 3D shape is known, in mm, against the mean face.

usage: python benchmarks/truth3d.py SHARED [--seeds 1000-1029] [--noise 1.0] [--fits "default model"]

SHARED holds ``bench/ict_truth.py`` (the sampler and the measure) and ``data/models/{ict_facekit,sfm}``. Subjects are
drawn from ICT-FaceKit, and from the Surrey model, to which nothing here was calibrated. Only skin triangles count.
"""

import os

for variable in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"):
    os.environ[variable] = "1"

import argparse
import sys
from pathlib import Path

import igl
import numpy as np

from toongeo.model import default_model
from toongeo.model.ibug68 import INNER
from toongeo.model.loaders.load_eos import load_eos
from toongeo.model.loaders.load_ict_facekit import load_ict_facekit
from toongeo.pipeline.fit.fit_3dmm import fit_3dmm

OUTLIERS, OUTLIER_PX = 5, 60.0
NEAR_MM = 6.0
FITS = ("default model", "5 outliers of 68", "ICT-FaceKit's own model")


class Bench:
    """Truths of both kinds, the models, and the measure."""

    def __init__(self, shared):
        sys.path.insert(0, str(shared / "bench"))
        import ict_truth

        self.measure = ict_truth
        models = shared / "data" / "models"
        archive = models / "ict_facekit" / "ict_facekit_light.npz"
        self.template, self.ict = default_model(), load_ict_facekit(archive)
        self.truths = {
            "ICT": ict_truth.Truth(archive),
            "Surrey": surrey_truth(ict_truth.Truth, models / "sfm", self.ict),
        }

    def error(self, truth, subject, model, V):
        skin = model.faces[model.region("skin")[model.faces].all(axis=1)]
        seven = V[model.landmarks[self.measure.SEVEN]]
        return self.measure.error_mm(truth, subject, V, skin, seven)[0]


def surrey_truth(kind, folder, ict):
    """The same sampler on the Surrey model; its narrow face is what lies on that of ICT-FaceKit."""
    names = ("sfm_shape_3448.bin", "ibug_to_sfm.txt", "expression_blendshapes_3448.bin")
    surrey = load_eos(*(folder / name for name in names))
    truth = object.__new__(kind)
    truth.V0 = surrey.mean / 10  # the sampler works in centimetres
    modes = np.zeros((100, *surrey.mean.shape), np.float32)  # it draws 100 coefficients
    modes[: len(surrey.identity)] = surrey.identity / 10
    truth.I, truth.E = modes, surrey.expression / 10
    truth.names, truth.lm, truth.F = list(surrey.expression_names), surrey.landmarks, surrey.faces
    truth.narrow = narrow_face(surrey, ict)
    return truth


def narrow_face(model, ict):
    source, target = (m.mean[m.landmarks[INNER]] for m in (model, ict))
    a, b = source - source.mean(0), target - target.mean(0)
    U, _, Vt = np.linalg.svd(b.T @ a)
    moved = (model.mean - source.mean(0)) @ (U @ Vt).T * np.sqrt((b**2).sum() / (a**2).sum()) + target.mean(0)
    squares, face, _ = igl.point_mesh_squared_distance(moved, ict.mean, ict.faces)
    narrow = ict.region("narrow_face")[ict.faces].all(axis=1)
    return np.flatnonzero(narrow[face] & (squares < NEAR_MM**2))


def with_outliers(q, seed):
    """Five of the points thrown 60 px away."""
    rng = np.random.default_rng(seed)
    q, angle = q.copy(), rng.uniform(0, 2 * np.pi, OUTLIERS)
    q[rng.choice(68, OUTLIERS, replace=False)] += OUTLIER_PX * np.c_[np.cos(angle), np.sin(angle)]
    return q


def rows(bench, seeds, noise, wanted, populations):
    """Name -> errors (subjects,), of the mean face and the wanted fits."""
    table = {}
    for name in populations:
        truth = bench.truths[name]
        for seed in seeds:
            subject = truth.sample(seed, noise=noise)
            fits = {"mean face": bench.template.mean}
            if "default model" in wanted:
                fits["default model"] = fitted(subject["q"])
            if name == "ICT" and "5 outliers of 68" in wanted:
                fits["5 outliers of 68"] = fitted(with_outliers(subject["q"], seed))
            for fit, V in fits.items():
                table.setdefault((name, fit), []).append(bench.error(truth, subject, bench.template, V))
            if name == "ICT" and "ICT-FaceKit's own model" in wanted:
                own = bench.error(truth, subject, bench.ict, fitted(subject["q"], bench.ict))
                table.setdefault((name, "ICT-FaceKit's own model"), []).append(own)
    return {key: np.array(errors) for key, errors in table.items()}


def fitted(q, model=None):
    return fit_3dmm(None, q, model=model).vertices


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("shared", type=Path)
    parser.add_argument("--seeds", default="1000-1029")
    parser.add_argument("--noise", default=1.0, type=float)
    parser.add_argument("--fits", nargs="+", default=FITS, choices=FITS)
    parser.add_argument("--populations", nargs="+", default=["ICT", "Surrey"], choices=["ICT", "Surrey"])
    arguments = parser.parse_args()
    first, last = map(int, arguments.seeds.split("-"))
    table = rows(
        Bench(arguments.shared), range(first, last + 1), arguments.noise, arguments.fits, arguments.populations
    )
    print("| subjects | shape | median error mm, mean of subjects | of the mean face | better than the mean face |")
    print("|---|---|---|---|---|")
    for (name, fit), errors in table.items():
        mean = table[name, "mean face"]
        better = f"{(errors < mean).sum()} of {len(mean)}"
        print(f"| {name} | {fit} | {errors.mean():.2f} | {errors.mean() / mean.mean():.2f} | {better} |")


if __name__ == "__main__":
    main()
