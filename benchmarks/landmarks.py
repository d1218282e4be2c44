"""Landmark error of the ten pictures, coarse and aligned, as the acceptance of the pipeline asks.

usage: python benchmarks/landmarks.py [FOLDER ...]   (pictures with .pts beside them; default: the bundled examples)
"""

import os

for variable in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"):
    os.environ[variable] = "1"

import sys

from pictures import pictures, roles

from toongeo import align_face, fit_3dmm, read_image, read_landmarks
from toongeo.avatar.report import landmark_errors
from toongeo.metrics import mesh_quality


def main() -> None:
    print("| picture | coarse inner 51 % | aligned inner 51 % | self-intersecting, coarse % | aligned % |")
    print("|---|---|---|---|---|")
    found = pictures(sys.argv[1:])
    for picture in found:
        landmarks = read_landmarks(picture.landmarks)
        fit = fit_3dmm(read_image(picture.image), landmarks)
        face = align_face(fit, landmarks)
        errors = [100 * landmark_errors(shape, landmarks)["inner51"] for shape in (fit, face)]
        front = fit.faces[fit.region("face")[fit.faces].all(1)]
        crossing = [100 * mesh_quality(shape.vertices, front).intersecting_fraction for shape in (fit, face)]
        print(f"| {picture.name} | {errors[0]:.2f} | {errors[1]:.5f} | {crossing[0]:.2f} | {crossing[1]:.2f} |")
    print(roles("landmarks", [picture.name for picture in found]))


if __name__ == "__main__":
    main()
