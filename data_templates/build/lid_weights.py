"""Weights of the lid model (``data_templates/lid_weights.csv``) from rendered faces.

usage: PYTHONPATH=. python data_templates/build/lid_weights.py [--pictures 600] [--out FILE]

No picture of anyone is used: heads of the template are drawn in many styles by `renders`, nearly half of them with eyes
as cartoonists draw them (`drawn_eyes`), and their lids are known exactly. The landmarks of each eye are shrunken,
shifted, flattened or left as they are. The weights minimise the expected error of the candidates under their
probabilities, with a ridge penalty. The same machine gives the same bytes; it takes about two minutes.
"""

import argparse
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from drawn_eyes import LID_ROWS, with_drawn_eyes
from numpy.typing import NDArray
from renders import Part, Render, drawn, random_scene
from renders.render_face import random_style
from scipy.optimize import minimize
from threadpoolctl import threadpool_limits

from toongeo.model.ibug68 import OUTER_EYES
from toongeo.pipeline.parse.lids.lid_candidates import lid_candidates, lid_contour
from toongeo.pipeline.parse.lids.lid_features import lid_features
from toongeo.pipeline.parse.lids.lid_patch import eye_points, lid_patch

Floats = NDArray[np.float64]

OUT = Path(__file__).parents[1] / "lid_weights.csv"
PICTURES = 600  # the error of the examples falls by 85 % with 150, and by 87 % with 400
SIZE, EXTENT = 384, (0.2, 0.25)  # px; makes eyes about as large as the patches that the model sees
KINDS = {"person": 0.3, "caricature": 0.4, "cartoon": 0.3}
DRAWN_EYES = {"person": 0.1, "caricature": 0.4, "cartoon": 0.85}  # share with eyes by `drawn_eyes`
NARROWEST = 0.4  # of the other eye's width; eyes that turn away farther are not learnt from
HIDDEN = 0.2  # share of an eye's box behind hair, hats and hands that is too much
ANNOTATOR = 0.008  # outer-eye distances: how far people's points are from the edge
CANDIDATES = 400  # of about 1,800, drawn anew for each eye
# Disturbances and their chances; amounts are those that detectors make on drawings.
DISTURBED = {"none": 0.1, "shrink": 0.35, "shift": 0.35, "both": 0.1, "flat": 0.1}
AMOUNTS = 0.05, 0.12  # of the outer-eye distance
LEAST = 0.15  # of its size is left of a shrunken eye
RIDGE = 1e-2  # from 3e-3 to 3e-2 the pictures of CHOOSING in benchmarks/pictures.py hardly differ
UNIT = 0.05  # outer-eye distances: the error of landmarks so disturbed; the ridge is measured against it
POWER = 2  # of the error, so that bad snaps count more
SLIDING = 0.3  # weight of the distance from point to point, besides that from point to lid
STEPS = 100
HEADER = """\
# The lid model: log-probability of a candidate = sum of weight * (feature - mean) / deviation.
# Made by data_templates/build/lid_weights.py from rendered faces. Features: see lid_features.py.
"""


@dataclass(frozen=True, eq=False)
class Case:
    """One eye: `features` (k, f) float32 of k candidates by `names`, and their `loss` (k,)."""

    names: tuple[str, ...]
    features: NDArray[np.float32]
    loss: NDArray[np.float32]


def picture(rng: np.random.Generator) -> Render:
    """A random face with its landmarks."""
    kind = str(rng.choice(list(KINDS), p=list(KINDS.values())))
    style = random_style(rng, kind)
    scene = random_scene(rng, kind, style in ("flat", "outlined"), SIZE, EXTENT)
    if rng.random() < DRAWN_EYES[kind]:
        scene = with_drawn_eyes(rng, scene)
    return drawn(rng, scene, style)


def usable_sides(render: Render) -> list[str]:
    """Sides of the subject whose eye the picture shows."""
    widths = [np.linalg.norm(render.landmarks[rows[3]] - render.landmarks[rows[0]]) for rows in LID_ROWS]
    found = []
    for side, rows, width in zip(("right", "left"), LID_ROWS, widths, strict=True):
        low = np.floor(render.landmarks[rows].min(axis=0)).astype(int).clip(0, SIZE - 1)
        high = np.ceil(render.landmarks[rows].max(axis=0)).astype(int).clip(0, SIZE - 1) + 1
        box = render.parts[low[1] : high[1], low[0] : high[0]]
        hidden = np.isin(box, (Part.HAIR, Part.HAT, Part.HAND, Part.BACKGROUND)).mean()
        if width >= NARROWEST * max(widths) and hidden <= HIDDEN:
            found.append(side)
    return found


def disturbed(rng: np.random.Generator, landmarks: Floats) -> Floats:
    """Landmarks with the eyes moved in one way."""
    moved, how = landmarks.copy(), str(rng.choice(list(DISTURBED), p=list(DISTURBED.values())))
    unit = np.linalg.norm(np.subtract(*landmarks[list(OUTER_EYES)]))
    for rows in LID_ROWS:
        middle = moved[rows].mean(axis=0)
        if how in ("shrink", "both"):
            amount = rng.uniform(*AMOUNTS) * unit
            radius = np.linalg.norm(moved[rows] - middle, axis=1).max()
            moved[rows] = middle + max(LEAST, 1 - amount / radius) * (moved[rows] - middle)
        if how == "flat":
            moved[rows] = middle + [1, 2 / 3] * (moved[rows] - middle)
        if how in ("shift", "both"):
            angle, amount = rng.uniform(0, 2 * np.pi), rng.uniform(*AMOUNTS) * unit
            moved[rows] += amount * np.array([np.cos(angle), np.sin(angle)])
    return moved


def lid_distance(points: Floats, polygon: Floats) -> Floats:
    """Distances (...,) of points (..., 2) from a closed polygon (n, 2)."""
    along = np.roll(polygon, -1, axis=0) - polygon
    at = ((points[..., None, :] - polygon) * along).sum(axis=-1) / np.maximum((along**2).sum(axis=1), 1e-12)
    foot = polygon + np.clip(at, 0, 1)[..., None] * along
    return np.linalg.norm(points[..., None, :] - foot, axis=-1).min(axis=-1)


def case(rng: np.random.Generator, render: Render, side: str) -> Case:
    """One eye with landmarks that are disturbed, and a sample of the candidates."""
    unit = float(np.linalg.norm(np.subtract(*render.landmarks[list(OUTER_EYES)])))
    truth = render.landmarks + rng.normal(0, ANNOTATOR * unit, (68, 2))
    patch = lid_patch(render.picture, disturbed(rng, truth), side)
    contour = lid_contour(patch.lids)
    every = lid_candidates(contour)
    taken = np.sort(rng.choice(len(every.shifts), CANDIDATES, replace=False))
    some = replace(every, **{key: getattr(every, key)[taken] for key in ("contours", "shifts", "scales", "growths")})
    features = lid_features(patch.channels, some)
    middle, linear = contour.mean(axis=0), patch.matrix[:, :2]
    places = middle + some.shifts[:, None] + some.scales[:, None] * (patch.lids - middle)  # (k, 6, 2)
    target = render.landmarks[eye_points(side)] @ linear.T + patch.matrix[:, 2]
    off = (1 - SLIDING) * lid_distance(places, target).mean(axis=1)
    off += SLIDING * np.linalg.norm(places - target, axis=2).mean(axis=1)
    px = UNIT * unit * np.sqrt(abs(np.linalg.det(linear)))
    return Case(tuple(features), np.column_stack(list(features.values())), ((off / px) ** POWER).astype(np.float32))


def trained(features: NDArray[np.float32], loss: NDArray[np.float32]) -> Floats:
    """Weights (f,) of standardised features (cases, k, f) that minimise the expected loss (cases, k)."""
    flat = features.reshape(-1, features.shape[2])

    def expected(weights: Floats) -> tuple[float, Floats]:
        score = features @ weights.astype(np.float32)
        likely = np.exp(score - score.max(axis=1, keepdims=True))
        likely /= likely.sum(axis=1, keepdims=True)
        mean = (likely * loss).sum(axis=1, keepdims=True)
        slope = (likely * (loss - mean)).ravel() @ flat / len(loss)
        return float(mean.mean() + RIDGE * weights @ weights), slope + 2 * RIDGE * weights

    return minimize(expected, np.zeros(features.shape[2]), jac=True, method="L-BFGS-B", options={"maxiter": STEPS}).x


def cases(count: int) -> list[Case]:
    """The eyes of `count` pictures."""
    found = []
    for seed in range(count):
        rng = np.random.default_rng([seed, 68])
        render = picture(rng)
        found += [case(rng, render, side) for side in usable_sides(render)]
    return found


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--pictures", type=int, default=PICTURES)
    parser.add_argument("--out", type=Path, default=OUT)
    options = parser.parse_args()
    with threadpool_limits(1):
        write_weights(options.pictures, options.out)


def write_weights(count: int, path: Path) -> None:
    """Train on so many pictures."""
    found = cases(count)
    features, loss = np.stack([case.features for case in found]), np.stack([case.loss for case in found])
    mean = features.mean(axis=(0, 1), dtype=np.float64)
    deviation = features.std(axis=(0, 1), dtype=np.float64) + 1e-6
    features -= mean.astype(np.float32)
    features /= deviation.astype(np.float32)
    rows = zip(found[0].names, mean, deviation, trained(features, loss), strict=True)
    lines = [f"{name},{m:.6g},{d:.6g},{w:.5g}\n" for name, m, d, w in rows]
    path.write_text(HEADER + "feature,mean,deviation,weight\n" + "".join(lines), encoding="utf-8")


if __name__ == "__main__":
    main()
