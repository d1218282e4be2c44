"""The landmark fit beside eos-py: the same Surrey model, the same landmarks, one thread, one run.

usage: python benchmarks/eos.py SHARED [--seeds 1000-1009] [--repeats 15]     (needs pip install eos-py==1.5.0)

SHARED holds ``data/models/sfm`` and ``data/models/ict_facekit``, ``data/portraits`` and ``bench/ict_truth.py``.

Accuracy. Both get the 50 points that eos's table maps to vertices, each with weight 1, and the same vertices. A smaller
error is easy with stranger faces, so the weight of our prior is bisected until the length of the shape coefficients, in
standard deviations, is that of eos; the expressions have no prior in eos and next to none here. Three pairs of runs:
without the outline; and with eos's own, which adds the other 16 jaw points to what eos minimises: ours still sees only
the 50. The root mean square error is always that of the 50 points.

Speed. ``fit_3dmm(None, landmarks, model=surrey)`` with its defaults against ``fit_shape_and_pose`` with its own, with
contours; for both the best of several.
"""

import os

for variable in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"):
    os.environ[variable] = "1"

import argparse
import sys
import time
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np

from toongeo import read_image, read_landmarks
from toongeo.model.load_eos import load_eos
from toongeo.pipeline.fit.fit_3dmm import fit_3dmm
from toongeo.pipeline.fit.fit_options import FitOptions

HERE = Path(__file__).parent
EXAMPLES = HERE.parent / "examples" / "portraits"
SHAPE, TABLE, EXPRESSION = "sfm_shape_3448.bin", "ibug_to_sfm.txt", "expression_blendshapes_3448.bin"
# One pass, since no jaw point slides; a box that is never reached; every point alike; all but no prior on expressions.
SAME_PROBLEM = FitOptions(
    robust=None, max_passes=1, jaw_weight=1.0, jaw_tangent=1.0, max_deviation=50.0, expression_weight=1e-4,
    tolerance=1e-12,
)  # fmt: skip
LEAST_WEIGHT, GREATEST_WEIGHT = 1e-10, 1.0


class Eos:
    """The rival: its model and what its fits need."""

    def __init__(self, folder):
        sys.path[:] = [path for path in sys.path if Path(path).resolve() != HERE]  # else this file would import itself
        try:
            import eos
        except ImportError:
            raise SystemExit("eos-py is not installed: pip install eos-py==1.5.0") from None
        self.fitting, self.landmark = eos.fitting, eos.core.Landmark
        shape = eos.morphablemodel.load_model(str(folder / SHAPE))
        self.model = eos.morphablemodel.MorphableModel(
            shape.get_shape_model(),
            eos.morphablemodel.load_blendshapes(str(folder / EXPRESSION)),
            color_model=eos.morphablemodel.PcaModel(),
        )
        self.mapper = eos.core.LandmarkMapper(str(folder / TABLE))
        self.contour = (
            eos.morphablemodel.load_edge_topology(str(folder / "sfm_3448_edge_topology.json")),
            eos.fitting.ContourLandmarks.load(str(folder / TABLE)),
            eos.fitting.ModelContour.load(str(folder / "sfm_model_contours.json")),
        )
        numbers = {int(name): int(vertex) for name, vertex in self.mapper.get_mappings().items()}
        self.points = np.array(sorted(numbers)) - 1
        self.vertices = np.array([numbers[k + 1] for k in self.points])

    def fit(self, pixels, size, contour):
        there = np.flatnonzero(np.isfinite(pixels).all(axis=1))
        landmarks = [self.landmark(str(k + 1), pixels[k].astype(np.float32)) for k in there]
        extra = self.contour if contour else ()
        return self.fitting.fit_shape_and_pose(self.model, landmarks, self.mapper, *size, *extra)

    def errors(self, found, pixels, size):
        """Errors (50,) px of a fit at the points of the table, and the length of its shape coefficients."""
        mesh, rendering, shape, _ = found
        vertices = np.asarray(mesh.vertices)[self.vertices, :3]
        clip = np.c_[vertices, np.ones(len(vertices))]
        clip = clip @ (rendering.get_projection() @ rendering.get_modelview()).T
        ndc = clip[:, :2] / clip[:, 3:]
        drawn = (np.array([1, -1]) * ndc + 1) / 2 * size
        return np.linalg.norm(drawn - pixels[self.points], axis=1), float(np.linalg.norm(shape))


def errors_at(fit, pixels, eos):
    drawn = fit.project(fit.vertices[eos.vertices])
    return np.linalg.norm(drawn - pixels[eos.points], axis=1), float(np.linalg.norm(fit.identity))


def of_equal_norm(pixels, model, eos, norm):
    """Our errors (50,) and norm, with the prior as strong as gives the norm of eos."""
    only = np.full((68, 2), np.nan)
    only[eos.points] = pixels[eos.points]
    low, high = np.log([LEAST_WEIGHT, GREATEST_WEIGHT])
    for _ in range(40):
        middle = (low + high) / 2
        fit = fit_3dmm(None, only, model=model, options=replace(SAME_PROBLEM, prior_weight=float(np.exp(middle))))
        errors, reached = errors_at(fit, pixels, eos)
        if abs(reached / norm - 1) < 1e-3:
            break
        low, high = (middle, high) if reached > norm else (low, middle)
    return errors, reached


def rms(errors):
    return float(np.sqrt((errors**2).mean()))


def best_ms(calls, repeats):
    """Shortest times, ms, of calls that take turns, so that a busy machine slows them alike."""
    times = np.empty((repeats, len(calls)))
    for row in times:
        for k, call in enumerate(calls):
            started = time.perf_counter()
            call()
            row[k] = 1e3 * (time.perf_counter() - started)
    return times.min(axis=0)


def subjects(shared, seeds):
    """Name, landmarks, (width, height)."""
    for folder in (EXAMPLES, shared / "data" / "portraits"):
        for points in sorted(folder.glob("*.pts")):
            picture = next(path for path in sorted(folder.glob(f"{points.stem}.*")) if path.suffix != ".pts")
            height, width = read_image(picture).shape[:2]
            yield points.stem, read_landmarks(points), (width, height)
    sys.path.insert(0, str(shared / "bench"))
    import ict_truth

    truth = ict_truth.Truth(shared / "data" / "models" / "ict_facekit" / "ict_facekit_light.npz")
    for seed in seeds:
        subject = truth.sample(seed)
        yield f"ICT {seed}", subject["q"], (subject["w"], subject["h"])


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("shared", type=Path)
    parser.add_argument("--seeds", default="1000-1009")
    parser.add_argument("--repeats", default=15, type=int)
    arguments = parser.parse_args()
    first, last = map(int, arguments.seeds.split("-"))
    folder = arguments.shared / "data" / "models" / "sfm"
    eos, surrey = Eos(folder), load_eos(folder / SHAPE, folder / TABLE, folder / EXPRESSION)
    print(
        "| subject | sd | eos RMS px | ours | sd, contours | eos RMS px | ours | eos, contours ms | ours ms | ratio |\n"
        "|---|---|---|---|---|---|---|---|---|---|"
    )
    table = []
    for name, pixels, size in subjects(arguments.shared, range(first, last + 1)):
        row = []
        for contour in (False, True):
            theirs, norm = eos.errors(eos.fit(pixels, size, contour), pixels, size)
            row += [norm, rms(theirs), rms(of_equal_norm(pixels, surrey, eos, norm)[0])]
        calls = (partial(eos.fit, pixels, size, contour=True), partial(fit_3dmm, None, pixels, model=surrey))
        theirs_ms, ours_ms = best_ms(calls, arguments.repeats)
        table.append([*row, theirs_ms, ours_ms, theirs_ms / ours_ms])
        print(f"| {name} | " + " | ".join(f"{value:.2f}" for value in table[-1]) + " |", flush=True)
    table = np.array(table)
    met = [(table[:, k + 1] <= table[:, k]).sum() for k in (1, 4)]
    print(f"\nRMS at equal norm not larger than that of eos: {met[0]} of {len(table)} without contours, {met[1]} with;")
    ratios = table[:, -1]
    print(f"times as fast as eos with contours: {ratios.min():.1f} at least, {np.median(ratios):.1f} in the median.")


if __name__ == "__main__":
    main()
