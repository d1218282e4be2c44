"""Triangles of the face that intersect others, at rest and over all expressions.

usage: python benchmarks/crossings.py [FOLDER ...]
(pictures with .pts or .txt beside them; default: the bundled examples)

rest: in the neutral face. all: summed over the expressions at 1, each by itself, but for `mouthClose`, which without
`jawOpen` lifts the lower lip through the upper one. worst: the expressions with the most.
"""

import os

for variable in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"):
    os.environ[variable] = "1"

import sys

import numpy as np
from pictures import pictures, roles

from toongeo import align_face, fit_3dmm, fit_lids, parse_face, read_image, read_landmarks
from toongeo.avatar.making.rigged import rigged
from toongeo.geometry import self_intersections
from toongeo.pipeline import fit_cranium
from toongeo.pipeline.align.size_teeth import size_teeth
from toongeo.pipeline.parse.drawn_mouth import drawn_mouth

WORST = 4


def main() -> None:
    found = pictures(sys.argv[1:])
    print("| picture | crossing triangles at rest | in all expressions | worst |\n|---|---|---|---|")
    for picture in found:
        img, landmarks = read_image(picture.image), read_landmarks(picture.landmarks)
        fit = fit_3dmm(img, landmarks)
        parse = parse_face(img, landmarks, fit)
        face = size_teeth(fit_cranium(align_face(fit, landmarks), parse), drawn_mouth(img, parse))
        rest, rig, _ = rigged(face, landmarks, "transfer", neutral=True, gain=1.0)
        rig, _ = fit_lids(rest, rig)
        used, F = np.unique(face.faces[face.region("face")[face.faces].all(1)], return_inverse=True)
        counts = {
            name: len(np.unique(self_intersections(V[used], F.reshape(-1, 3))))
            for name, V in (("rest", rig.neutral), *zip(rig.names, rig.neutral + rig.deltas, strict=True))
            if name != "mouthClose"
        }
        at_rest = counts.pop("rest")
        worst = sorted(counts, key=lambda name: -counts[name])[:WORST]
        told = ", ".join(f"{name} {counts[name]}" for name in worst)
        print(f"| {picture.name} | {at_rest} | {sum(counts.values())} | {told} |", flush=True)
    print(roles("crossings", [picture.name for picture in found]))


if __name__ == "__main__":
    main()
