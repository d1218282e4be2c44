"""Whether the picture shows a face at its landmarks: told of a picture's own points and of those of all other pictures.

usage: python benchmarks/evidence.py [FOLDER ...]   (pictures with .pts or .txt beside them; default: the examples)

Others' points lie in the frame of the picture as they lie in their own; those that come nearer than half an outer-eye
distance on average are left out. The rival is the verifier of the detector alone, one of the seven cues. "Told apart"
is the share of pairs of own and others' points of which the own have more; then how many are said to be implausible.
"""

import os

for variable in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"):
    os.environ[variable] = "1"

import sys

import numpy as np
from pictures import pictures, roles

from toongeo import read_image, read_landmarks
from toongeo.model.ibug68 import OUTER_EYES
from toongeo.pipeline import landmark_evidence
from toongeo.pipeline.landmarks.landmark_evidence import CUES

APART = 0.5


def main() -> None:
    found = pictures(sys.argv[1:])
    every = [(picture.name, read_image(picture.image), read_landmarks(picture.landmarks)) for picture in found]
    own = [landmark_evidence(img, points) for _, img, points in every]
    others = []
    for _, img, points in every:
        unit = np.linalg.norm(np.subtract(*points[list(OUTER_EYES)]))
        for _, picture, theirs in every:
            there = theirs * np.divide(img.shape[1::-1], picture.shape[1::-1])
            if np.linalg.norm(there - points, axis=1).mean() > APART * unit:
                others.append(landmark_evidence(img, there))
    verified = CUES.index("face")
    scores = {
        "landmark_evidence": [np.array([found.chance for found in group]) for group in (own, others)],
        "verifier alone": [np.array([found.cues[verified] for found in group]) for group in (own, others)],
    }
    print(f"| {len(own)} own, {len(others)} others' points | told apart % | implausible: own | others % |")
    print("|---|---|---|---|")
    for name, (right, wrong) in scores.items():
        apart = 100 * (right[:, None] > wrong).mean()
        doubted = [not found.is_plausible for found in own], [not found.is_plausible for found in others]
        said = f"{sum(doubted[0])} | {100 * np.mean(doubted[1]):.1f}" if name == "landmark_evidence" else "|"
        print(f"| {name} | {apart:.2f} | {said} |")
    print(roles("evidence", [name for name, *_ in every]))


if __name__ == "__main__":
    main()
