"""Weights of the lid model from annotated pictures; prints how it does on pictures it has not seen.

usage: python benchmarks/train_lids.py FOLDER ... [--write]

The eyes of each picture are shrunken, shifted, both, or left as they are; grey copies of the pictures are used too. The
weights minimise the expected error of the candidates under their probabilities, in units of the picture's error
before snapping, with a ridge penalty. ``--write`` puts them into ``toongeo/pipeline/parse/lid_weights.csv``.
"""

import os

for variable in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"):
    os.environ[variable] = "1"

import sys
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
from scipy.optimize import minimize
from snapping import EYES, disturbed, lid_distance, outer_eyes, pictures

from toongeo import read_image, read_landmarks
from toongeo.pipeline.parse.lids.lid_candidates import lid_candidates, lid_contour
from toongeo.pipeline.parse.lids.lid_features import lid_features
from toongeo.pipeline.parse.lids.lid_patch import eye_points, lid_patch

OUT = Path(__file__).parents[1] / "toongeo" / "pipeline" / "parse" / "lid_weights.csv"
SEEDS = 3
RIDGE = 1e-3
POWER = 2  # of the error
SLIDING = 0.3  # weight of the distance from point to point, besides that from point to lid
FOLDS = 5
STEPS = 60
HEADER = """\
# The lid model: log-probability of a candidate = sum of weight * (feature - mean) / deviation.
# Made by benchmarks/train_lids.py from annotated caricatures, cartoons and portraits; features: see lid_features.py.
"""


@dataclass
class Case:
    picture: str
    disturbed: bool
    features: np.ndarray  # (k, f)
    places: np.ndarray  # (k, 6, 2), the landmarks moved with each candidate
    truth: np.ndarray  # (6, 2)
    given: np.ndarray  # (6, 2)
    unit: float  # px of the patch per percent of the outer-eye distance

    def error(self, points: np.ndarray) -> float:
        return float(lid_distance(points, self.truth).mean()) / self.unit


def cases(img: np.ndarray, truth: np.ndarray, name: str) -> tuple[list[Case], tuple[str, ...]]:
    grey = cv2.cvtColor(cv2.cvtColor(img, cv2.COLOR_RGB2GRAY), cv2.COLOR_GRAY2RGB)
    pairs = [(img, truth)]
    for seed in range(SEEDS):
        shrunk, shifted = (disturbed(truth, kind, np.random.default_rng([seed, 101])) for kind in ("shrink", "shift"))
        pairs += [(img, shrunk), (img, shifted)]
        if seed == 0:
            both = disturbed(shrunk, "shift", np.random.default_rng([seed, 102]))
            flat = flattened(truth)
            pairs += [(img, both), (grey, shrunk), (grey, shifted), (grey, both), (img, flat)]
            pairs += [(img, disturbed(flat, "shift", np.random.default_rng([seed, 103])))]
    found = [one_case(picture, given, truth, side, name) for picture, given in pairs for side in ("right", "left")]
    return [case for case, _ in found], found[0][1]


def flattened(landmarks: np.ndarray) -> np.ndarray:
    """Eyes of two thirds of their height."""
    moved = landmarks.copy()
    for eye in EYES:
        middle = landmarks[eye].mean(axis=0)
        moved[eye] = middle + [1, 2 / 3] * (landmarks[eye] - middle)
    return moved


def one_case(img, landmarks, truth, side, name):
    patch = lid_patch(img, landmarks, side)
    contour = lid_contour(patch.lids)
    candidates = lid_candidates(contour)
    features = lid_features(patch.channels, candidates)
    middle = contour.mean(axis=0)
    places = middle + candidates.shifts[:, None] + candidates.scales[:, None] * (patch.lids - middle)
    linear = patch.matrix[:, :2]
    target = truth[eye_points(side)] @ linear.T + patch.matrix[:, 2]
    unit = outer_eyes(truth) * np.sqrt(abs(np.linalg.det(linear))) / 100
    rows = np.column_stack(list(features.values())).astype(np.float32)
    changed = not np.array_equal(landmarks, truth)
    return Case(name, changed, rows, places, target, patch.lids, unit), tuple(features)


def losses(found: list[Case]) -> np.ndarray:
    """(cases, k): error over that of the picture before snapping, to a power that makes bad snaps count more."""
    names = np.array([case.picture for case in found])
    before = np.array([case.error(case.given) for case in found])
    changed = np.array([case.disturbed for case in found])
    unit = {name: before[(names == name) & changed].mean() for name in set(names)}
    rows = []
    for case in found:
        flat = lid_distance(case.places.reshape(-1, 2), case.truth).reshape(-1, 6).mean(axis=1)
        point = np.linalg.norm(case.places - case.truth, axis=2).mean(axis=1)
        rows.append((((1 - SLIDING) * flat + SLIDING * point) / case.unit / unit[case.picture]) ** POWER)
    return np.array(rows)


def importances(found: list[Case]) -> np.ndarray:
    """(cases,): each picture counts once, and its undisturbed eyes less than others."""
    names = np.array([case.picture for case in found])
    changed = np.array([case.disturbed for case in found])
    weights = np.zeros(len(found))
    for name in set(names):
        mine = names == name
        weights[mine] = np.where(changed[mine], 1.0, 0.7) / mine.sum()
    return weights / len(set(names))


def trained(features: np.ndarray, loss: np.ndarray, importance: np.ndarray) -> np.ndarray:
    """Weights (f,) of standardised features (cases, k, f)."""
    flat = features.reshape(-1, features.shape[2])

    def expected(weights):
        likely = probabilities(features @ weights.astype(np.float32))
        mean = (likely * loss).sum(axis=1)
        slope = (importance[:, None] * likely * (loss - mean[:, None])).astype(np.float32).ravel() @ flat
        return float(importance @ mean + RIDGE * weights @ weights), slope + 2 * RIDGE * weights

    start = np.zeros(features.shape[2])
    return minimize(expected, start, jac=True, method="L-BFGS-B", options={"maxiter": STEPS}).x


def probabilities(score: np.ndarray) -> np.ndarray:
    likely = np.exp(score - score.max(axis=1, keepdims=True))
    return likely / likely.sum(axis=1, keepdims=True)


def report(found, features, loss, importance) -> None:
    """Falls of the error on pictures that were left out, before the last refinement."""
    names = np.array([case.picture for case in found])
    pictures_ = sorted(set(names))
    falls = {}
    for fold in range(FOLDS):
        held = np.isin(names, pictures_[fold::FOLDS])
        likely = probabilities(features[held] @ trained(features[~held], loss[~held], importance[~held]))
        kept = [case for case, out in zip(found, held, strict=True) if out]
        after = [case.error((p[:, None, None] * case.places).sum(axis=0)) for case, p in zip(kept, likely, strict=True)]
        for name in pictures_[fold::FOLDS]:
            pairs = [
                (a, c.error(c.given)) for a, c in zip(after, kept, strict=True) if c.picture == name and c.disturbed
            ]
            falls[name] = 1 - np.sum(pairs, axis=0)[0] / np.sum(pairs, axis=0)[1]
    print("| left-out picture | fall % |\n|---|---|")
    for name in pictures_:
        print(f"| {name} | {100 * falls[name]:.0f} |")
    for folder in sorted({name.split("/")[0] for name in pictures_}):
        print(f"| {folder}: mean | {100 * np.mean([v for n, v in falls.items() if n.startswith(folder + '/')]):.0f} |")


def main() -> None:
    found, names = [], ()
    for folder in [Path(word) for word in sys.argv[1:] if word != "--write"]:
        for picture, points in pictures(folder):
            more, names = cases(read_image(picture), read_landmarks(points), f"{folder.name}/{picture.stem}")
            found += more
    features = np.stack([case.features for case in found])
    mean, deviation = features.mean(axis=(0, 1)), features.std(axis=(0, 1)) + 1e-6
    features = (features - mean) / deviation
    loss, importance = losses(found), importances(found)
    report(found, features, loss, importance)
    if "--write" in sys.argv:
        weights = trained(features, loss, importance)
        rows = zip(names, mean, deviation, weights, strict=True)
        lines = [f"{name},{m:.6g},{d:.6g},{w:.5g}\n" for name, m, d, w in rows]
        OUT.write_text(HEADER + "feature,mean,deviation,weight\n" + "".join(lines), encoding="utf-8")


if __name__ == "__main__":
    main()
