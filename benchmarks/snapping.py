"""Eye landmarks that are shrunken or shifted, as detectors place them on cartoons, before and after snapping.

usage: python benchmarks/snapping.py [FOLDER ...]
(pictures with .pts or .txt beside them; default: the bundled examples)

Eye error: mean distance of the twelve points from the closed polygon of the annotated lids, in percent of the
outer-eye distance; points may slide along it.
"""

import os

for variable in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"):
    os.environ[variable] = "1"

import sys
from pathlib import Path

import numpy as np
from pictures import FOLDER, pictures, roles

from toongeo import parse_face, read_image, read_landmarks, snap_eyes
from toongeo.model.ibug68 import OUTER_EYES, PARTS

EYES = (PARTS["eye_right"], PARTS["eye_left"])
KINDS = ("shrink", "shift")
AMOUNTS = 0.05, 0.12  # of the outer-eye distance
LEAST = 0.15  # of its size is left of a shrunken eye
SEEDS = 4


def outer_eyes(landmarks: np.ndarray) -> float:
    return float(np.linalg.norm(np.subtract(*landmarks[list(OUTER_EYES)])))


def disturbed(landmarks: np.ndarray, kind: str, rng: np.random.Generator) -> np.ndarray:
    """Each eye shifted, or shrunken until its farthest point has moved, by 5-12 % of the outer-eye distance."""
    moved = landmarks.copy()
    for eye in EYES:
        middle = landmarks[eye].mean(axis=0)
        amount = rng.uniform(*AMOUNTS) * outer_eyes(landmarks)
        if kind == "shrink":
            radius = np.linalg.norm(landmarks[eye] - middle, axis=1).max()
            moved[eye] = middle + max(LEAST, 1 - amount / radius) * (landmarks[eye] - middle)
        else:
            angle = rng.uniform(0, 2 * np.pi)
            moved[eye] += amount * np.array([np.cos(angle), np.sin(angle)])
    return moved


def lid_distance(points: np.ndarray, polygon: np.ndarray) -> np.ndarray:
    """Distances (k,) of points (k, 2) from a closed polygon (n, 2)."""
    along = np.roll(polygon, -1, axis=0) - polygon
    at = ((points[:, None] - polygon) * along).sum(axis=2) / np.maximum((along**2).sum(axis=1), 1e-12)
    foot = polygon + np.clip(at, 0, 1)[..., None] * along
    return np.linalg.norm(points[:, None] - foot, axis=2).min(axis=1)


def eye_error(points: np.ndarray, truth: np.ndarray) -> float:
    """Percent of the outer-eye distance."""
    return 100 * float(np.mean([lid_distance(points[eye], truth[eye]) for eye in EYES])) / outer_eyes(truth)


def main() -> None:
    print("| picture | kind | before % | nearest % | arc % | fall % |")
    print("|---|---|---|---|---|---|")
    names: list[str] = []
    summary = []
    for folder in [Path(name) for name in sys.argv[1:]] or [FOLDER]:
        falls = {}
        for picture in pictures([folder]):
            img, truth = read_image(picture.image), read_landmarks(picture.landmarks)
            total = np.zeros(3)
            for kind in KINDS:
                errors = np.zeros(3)
                for seed in range(SEEDS):
                    given = disturbed(truth, kind, np.random.default_rng([seed, KINDS.index(kind)]))
                    parse = parse_face(img, given)
                    found = (given, snap_eyes(given, parse, mode="nearest"), snap_eyes(given, parse))
                    errors += [eye_error(landmarks, truth) / SEEDS for landmarks in found]
                total += errors / len(KINDS)
                print_row(picture.name, kind, errors)
            print_row(picture.name, "both", total)
            falls[picture.name] = 100 * (1 - total[2] / total[0])
        found = list(falls.values())
        summary.append(f"| {len(found)} of {folder.name} | {np.mean(found):.0f} | {np.min(found):.0f} |")
        names += falls
    print("\n| pictures | fall of the error %, mean | least |\n|---|---|---|", *summary, sep="\n")
    print(roles("snapping", names))


def print_row(name: str, kind: str, errors: np.ndarray) -> None:
    before, nearest, arc = errors
    print(f"| {name} | {kind} | {before:.2f} | {nearest:.2f} | {arc:.2f} | {100 * (1 - arc / before):.0f} |")


if __name__ == "__main__":
    main()
