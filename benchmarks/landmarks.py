"""Landmark error of the ten pictures, coarse and aligned, as the acceptance of the pipeline asks.

usage: python benchmarks/landmarks.py [FOLDER ...]   (pictures with .pts beside them; default: the bundled examples)
"""

import os

for variable in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"):
    os.environ[variable] = "1"

import sys
from pathlib import Path

from toongeo import align_face, fit_3dmm, read_image, read_landmarks
from toongeo.avatar.report import landmark_errors
from toongeo.metrics import mesh_quality

PORTRAITS = Path(__file__).parents[1] / "examples" / "portraits"


def main() -> None:
    print("| picture | coarse inner 51 % | aligned inner 51 % | self-intersecting, coarse % | aligned % |")
    print("|---|---|---|---|---|")
    for folder in [Path(name) for name in sys.argv[1:]] or [PORTRAITS]:
        for points in sorted(folder.glob("*.pts")):
            picture = next(path for path in sorted(folder.glob(f"{points.stem}.*")) if path.suffix != ".pts")
            landmarks = read_landmarks(points)
            fit = fit_3dmm(read_image(picture), landmarks)
            face = align_face(fit, landmarks)
            errors = [100 * landmark_errors(found, landmarks)["inner51"] for found in (fit, face)]
            front = fit.faces[fit.region("face")[fit.faces].all(1)]
            crossing = [100 * mesh_quality(found.vertices, front).intersecting_fraction for found in (fit, face)]
            print(f"| {points.stem} | {errors[0]:.2f} | {errors[1]:.5f} | {crossing[0]:.2f} | {crossing[1]:.2f} |")


if __name__ == "__main__":
    main()
