"""Photometric fit of people whose shape and skin are outside the model: ICT-FaceKit subjects in random light.

usage: python benchmarks/photometric_scans.py SHARED [--seeds 4000-4099] [--focal known|none]

SHARED is that of ``truth3d.py``. The skin is the template's, carried over by closest points, with grain and, for the
blotched pictures, smooth blotches that no albedo mode has. Camera, expression and landmarks are those of
``bench/ict_truth.py``.
"""

import os

for variable in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"):
    os.environ[variable] = "1"

import argparse
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import igl
import numpy as np
from photometric import random_light
from scipy.spatial.transform import Rotation
from truth3d import Bench

from toongeo import fit_3dmm, photometric_fit
from toongeo.geometry.rotations.similarity import similarity
from toongeo.pipeline import PhotometricOptions
from toongeo.render import PerspectiveCamera, Surface, render_mesh

SIZE, FOCAL_PX, DISTANCE_MM = 640, 90 * 0.55 * 640 / 16, 900.0
# The picture counts five times as much as by default, which is meant for drawings too; blurred by a millimetre, it is
# met better, and grain less.
EVIDENCE = PhotometricOptions(independent_samples=100.0, passes=8, blur=1.0)
GRAIN = 0.03  # of the skin, a standard deviation of its brightness at each vertex
BLOTCH, BLOTCH_MM, WAVES = 0.12, 15.0, 200  # standard deviation and length of the blotches
TRIMMED, ITERATIONS, CLOSE = 0.9, 20, 5  # a fifth of the points until the last two


@dataclass(frozen=True, eq=False)
class Scenes:
    """Scenes of a `truth3d.Bench`."""

    bench: object

    def picture(self, seed: int, blotched: bool):
        """Subject and picture (H, W, 3) uint8."""
        truth, model = self.bench.truths["ICT"], self.bench.template
        subject, rng = truth.sample(seed), np.random.default_rng(90_000 + seed)
        R = posed(truth, seed)
        centre = truth.V0[truth.narrow].mean(0) * 10
        camera = PerspectiveCamera(FOCAL_PX, R, -R @ centre - [0, 0, DISTANCE_MM], [SIZE / 2, SIZE / 2])
        albedo = 0.7 * rng.standard_normal(len(model.albedo))
        colours = np.clip(model.albedo_mean + np.tensordot(albedo, model.albedo, 1), 0, 1)
        colours = self.on_scan(colours) * (1 + GRAIN * rng.standard_normal((len(self.weights), 1)))
        if blotched:
            colours = colours * (
                1 + BLOTCH * blotches(np.random.default_rng(5_000 + seed), truth.V0[: len(colours)] * 10)[:, None]
            )
        V = subject["V"][: len(colours)] * 10
        light, ground = random_light(rng), tuple(rng.uniform(0.2, 0.9, 3))
        surface = Surface(V, truth.F, colours=np.clip(colours, 0, 1))
        return subject, render_mesh(surface, camera, SIZE, light=light, background=ground)

    def on_scan(self, values):
        """Values (n, c) of the template's vertices at those of the scans."""
        return np.einsum("vc,vcd->vd", self.weights, values[self.corners])

    @property
    def corners(self):
        return self._correspondences[0]

    @property
    def weights(self):
        return self._correspondences[1]

    @cached_property
    def _correspondences(self):
        """Corners (v, 3) and their weights for the mean of the scans on the template."""
        truth, model = self.bench.truths["ICT"], self.bench.template
        coefficients = model.prior.mean.copy()
        coefficients[-1] /= 0.3  # all of the way to the mean of the scans
        V, F = model.vertices(coefficients), skin_faces(model)
        scan = truth.V0[: truth.F.max() + 1] * 10
        inner = slice(17, 68)
        found = similarity(scan[truth.lm[inner]], (V[model.landmarks] + model.prior.scan_offsets)[inner])
        for _ in range(ITERATIONS):
            placed = scan * found[0] @ found[1].T + found[2]
            squares, _, closest = igl.point_mesh_squared_distance(placed[truth.narrow], V, F)
            near = squares < np.quantile(squares, TRIMMED)
            found = similarity(scan[truth.narrow][near], closest[near])
        placed = scan * found[0] @ found[1].T + found[2]
        _, face, closest = igl.point_mesh_squared_distance(placed, V, F)
        corners = F[face]
        weights = igl.barycentric_coordinates(closest, *(np.ascontiguousarray(V[corners[:, i]]) for i in range(3)))
        return corners, weights


def posed(truth, seed):
    """The rotation that `Truth.sample` gives a subject: the same draws again."""
    rng = np.random.default_rng(seed)
    rng.normal(0, 1, 100)
    if seed % 2:
        names = [name for name in truth.names if not name.startswith(("Pupil", "eyeLook"))]
        for _ in rng.choice(names, 4, replace=False):
            rng.uniform(0, 0.7)
    angles = [rng.uniform(-30, 30), rng.uniform(-12, 12), rng.uniform(-10, 10)]
    return Rotation.from_euler("yxz", angles, degrees=True).as_matrix()


def blotches(rng, V):
    """A smooth random field (n,) of unit variance at points (n, 3) mm."""
    waves, phases = rng.normal(size=(WAVES, 3)) / BLOTCH_MM, rng.uniform(0, 2 * np.pi, WAVES)
    return np.sqrt(2 / WAVES) * np.cos(V @ waves.T + phases).sum(1)


def skin_faces(model):
    return np.ascontiguousarray(model.faces[model.region("skin")[model.faces].all(axis=1)])


def quick_error(bench, truth, subject, V):
    """Median error in mm as `truth3d.Bench.error` has it to about a hundredth: the points move instead of the mesh."""
    measure, model = bench.measure, bench.template
    V, F = np.ascontiguousarray(V, float), skin_faces(model)
    tree = igl.AABB()
    tree.init(V, F)
    points = subject["V"][truth.narrow]
    scale, turn, shift = measure.similarity(V[model.landmarks[measure.SEVEN]], subject["V"][truth.lm[measure.SEVEN]])
    for iteration in range(ITERATIONS + 3):
        p = points[::CLOSE] if iteration < ITERATIONS else points
        squares, _, closest = tree.squared_distance(V, F, np.ascontiguousarray((p - shift) @ turn / scale))
        if iteration < ITERATIONS + 2:
            near = squares < np.quantile(squares, TRIMMED)
            scale, turn, shift = measure.similarity(closest[near], p[near])
    return float(np.median(np.sqrt(squares)) * scale * 10)


def rows(bench, seeds, lens):
    """Errors (subjects, 4), mm: mean face, landmarks, with the picture, with the blotched picture."""
    truth, scenes, model = bench.truths["ICT"], Scenes(bench), bench.template
    table = []
    for seed in seeds:
        subject, clean = scenes.picture(seed, blotched=False)
        fit = fit_3dmm(clean, subject["q"], **lens)
        pictures = (clean, scenes.picture(seed, blotched=True)[1])
        refined = [photometric_fit(picture, fit, subject["q"], options=EVIDENCE).vertices for picture in pictures]
        table.append([quick_error(bench, truth, subject, V) for V in (model.mean, fit.vertices, *refined)])
        if len(table) % 20 == 0:
            report(np.array(table))
    return np.array(table)


def report(table):
    share = table.mean(axis=0) / table[:, 0].mean()
    gain = table[:, 1:2] - table[:, 2:]
    mean, error = gain.mean(axis=0), gain.std(axis=0) / np.sqrt(len(gain))
    print(
        f"| {len(table)} | {share[1]:.3f} | {share[2]:.3f} | {mean[0]:+.3f} ± {error[0]:.3f} "
        f"| {share[3]:.3f} | {mean[1]:+.3f} ± {error[1]:.3f} |",
        flush=True,
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("shared", type=Path)
    parser.add_argument("--seeds", default="4000-4099")
    parser.add_argument("--focal", default="known", choices=["known", "none"], help="none: the camera is orthographic")
    arguments = parser.parse_args()
    first, last = map(int, arguments.seeds.split("-"))
    known = {"camera": "perspective", "focal_px": FOCAL_PX, "principal_point": (SIZE / 2, SIZE / 2)}
    print("| subjects | landmarks, of the mean face | with the picture | gain mm | blotched | gain mm |")
    print("|---|---|---|---|---|---|")
    rows(Bench(arguments.shared), range(first, last + 1), known if arguments.focal == "known" else {})


if __name__ == "__main__":
    main()
