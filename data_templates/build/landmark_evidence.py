"""Weights of the evidence for landmarks (``data_templates/landmark_evidence.csv``) from rendered faces.

usage: PYTHONPATH=. python data_templates/build/landmark_evidence.py [--pictures 90] [--out FILE]

No picture of anyone is used: heads of the template are drawn in many styles by `renders`, and their points are known.
Right are these, as they are and with a little noise; wrong are points of other renders as they lie in their own
picture, and the right ones shifted or scaled. A logistic regression with a ridge tells them apart. It is to be run
anew whenever the detector was trained, whose verifier is one of the cues. The same machine gives the same bytes; it
takes about two minutes.
"""

import argparse
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from renders import Render, render_face
from scipy.optimize import minimize
from threadpoolctl import threadpool_limits

from toongeo.model.ibug68 import OUTER_EYES
from toongeo.pipeline.landmarks.landmark_evidence import CUES, evidence_cues

Floats = NDArray[np.float64]

OUT = Path(__file__).parents[1] / "landmark_evidence.csv"
PICTURES = 90
SEED = 978
SIZE, EXTENT = 320, (0.11, 0.16)  # px; heads with air around them
NOISE = 0.03  # outer-eye distances, of points that still are right
APART = 0.25  # outer-eye distances: points of another picture that lie nearer on average may pass for right
OTHERS = (1, 7)  # how far down the list the other pictures are
SHIFT, SCALE = (0.3, 1.2), (0.25, 0.5)  # outer-eye distances; log
RIDGE = 0.3
DIGITS = 3
HEADER = """\
# The evidence for landmarks: log-odds = sum of weight * cue. Made by data_templates/build/landmark_evidence.py from
# rendered faces. Cues: see edge_cues.py, colour_cues.py and landmark_evidence.py.
"""


def picture(number: int) -> Render:
    """The render of a number."""
    return render_face(np.random.default_rng([SEED, number]), size=SIZE, extent=EXTENT)


def right_points(rng: np.random.Generator, landmarks: Floats) -> Iterator[Floats]:
    """Points that belong to the picture."""
    yield landmarks
    yield landmarks + rng.normal(0, NOISE * _unit(landmarks), landmarks.shape)


def wrong_points(rng: np.random.Generator, landmarks: Floats, others: list[Floats]) -> Iterator[Floats]:
    """Points that do not."""
    unit, middle = _unit(landmarks), landmarks.mean(axis=0)
    for other in others:
        if np.linalg.norm(other - landmarks, axis=1).mean() > APART * unit:
            yield other
    angle = rng.uniform(0, 2 * np.pi)
    yield landmarks + rng.uniform(*SHIFT) * unit * np.array([np.cos(angle), np.sin(angle)])
    yield middle + np.exp(rng.choice([-1, 1]) * rng.uniform(*SCALE)) * (landmarks - middle)


def _unit(landmarks: Floats) -> float:
    return float(np.linalg.norm(np.subtract(*landmarks[list(OUTER_EYES)])))


def cases(numbers: range) -> tuple[Floats, NDArray[np.bool_]]:
    """Cues (k, c) of points, and which of them are right (k,)."""
    renders = [picture(number) for number in numbers]
    rng = np.random.default_rng(SEED)
    rows, right = [], []
    for k, render in enumerate(renders):
        others = [renders[(k + step) % len(renders)].landmarks for step in OTHERS]
        for belong, every in (
            (True, right_points(rng, render.landmarks)),
            (False, wrong_points(rng, render.landmarks, others)),
        ):
            for points in every:
                rows.append(evidence_cues(render.picture, points))
                right.append(belong)
    return np.array(rows), np.array(right)


def trained(cues: Floats, right: NDArray[np.bool_]) -> Floats:
    """Weights (c,) of the logistic regression; that of the constant is not held to 0."""
    signs, ridge = np.where(right, 1.0, -1.0), RIDGE * (np.array(CUES) != "constant")

    def loss(weights: Floats) -> tuple[float, Floats]:
        odds = -signs * (cues @ weights)
        share = 1 / (1 + np.exp(-odds))
        value = np.logaddexp(0, odds).sum() + ridge @ weights**2 / 2
        return float(value), -(signs * share) @ cues + ridge * weights

    return np.asarray(minimize(loss, np.zeros(len(CUES)), jac=True, method="L-BFGS-B", options={"ftol": 1e-12}).x)


def write_weights(pictures: int, out: Path) -> None:
    with threadpool_limits(1):
        cues, right = cases(range(pictures))
        weights = trained(cues, right)
    lines = [f"{name},{weight:.{DIGITS}f}" for name, weight in zip(CUES, weights, strict=True)]
    out.write_text(HEADER + "cue,weight\n" + "\n".join(lines) + "\n", encoding="utf-8", newline="\n")
    chance = np.sort(1 / (1 + np.exp(-cues @ weights.round(DIGITS))))
    order = np.argsort(cues @ weights)
    print(f"wrote {out}: {right.sum()} right, {(~right).sum()} wrong")
    for least in (0.03, 0.05, 0.08, 0.12, 0.2, 0.5):
        below = chance < least
        print(f"chance below {least}: {right[order][below].sum()} right, {(~right)[order][below].sum()} wrong")


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("--pictures", type=int, default=PICTURES)
    parser.add_argument("--out", type=Path, default=OUT)
    options = parser.parse_args()
    write_weights(options.pictures, options.out)


if __name__ == "__main__":
    main()
