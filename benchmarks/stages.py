"""Seconds a stage of the whole way, at 1024 px, one BLAS thread.

usage: python benchmarks/stages.py [PICTURE LANDMARKS]
"""

import os

for variable in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"):
    os.environ[variable] = "1"

import sys
import time
from pathlib import Path

import cv2
import numpy as np
from pictures import FOLDER, roles

from toongeo import default_model, make_avatar, read_image, read_landmarks
from toongeo.avatar.make_avatar import STAGES

RUNS = 5


def main() -> None:
    picture, points = sys.argv[1:] or (FOLDER / "beethoven.png", FOLDER / "beethoven.pts")
    img, landmarks = read_image(picture), read_landmarks(points)
    scale = 1024 / max(img.shape[:2])
    img = cv2.resize(img, None, fx=scale, fy=scale, interpolation=cv2.INTER_CUBIC)
    landmarks = (landmarks + 0.5) * scale - 0.5

    started = time.perf_counter()
    default_model()
    loading = time.perf_counter() - started
    runs, totals = [], []
    for _ in range(RUNS):
        started = time.perf_counter()
        avatar = make_avatar(img, landmarks)
        totals.append(time.perf_counter() - started)
        stages = [stage for stage in STAGES if stage in avatar.report.seconds]  # not those that were not asked for
        runs.append([avatar.report.seconds[stage] for stage in stages])
    print("| stage | median s | first run s |\n|---|---|---|")
    print(f"| load the model (once a process) | {loading:.3f} | {loading:.3f} |")
    for stage, seconds, first in zip(stages, np.median(runs, 0), runs[0], strict=True):
        print(f"| {stage} | {seconds:.3f} | {first:.3f} |")
    print(f"| whole way | {np.median(totals):.3f} | {totals[0]:.3f} |")
    print(roles("stages", [Path(picture).stem]))


if __name__ == "__main__":
    main()
