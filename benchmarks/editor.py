"""The landmark editor: how far a few clicks get, and how long the face takes to follow.

usage: python benchmarks/editor.py [FOLDER ...]   (pictures with landmarks beside them; default: the bundled examples)
"""

import os

for variable in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"):
    os.environ[variable] = "1"

import json
import sys
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
from pictures import FOLDER, pictures, roles

from toongeo.app.editor.editor_session import EditorSession
from toongeo.app.editor.editor_settings import editor_settings
from toongeo.app.editor.picture_list import PictureList
from toongeo.app.editor.place_landmarks import place_landmarks
from toongeo.model import default_model
from toongeo.model.ibug68 import OUTER_EYES

ORDER = [click["point"] for click in editor_settings()["clicks"]]
COUNTS = (2, 3, 6, 12, 20)
NUDGES = 10


def main() -> None:
    folders = [Path(name) for name in sys.argv[1:]] or [FOLDER]
    print("| folder | clicks | others, % of the outer-eye distance, median (worst) | mean face by similarity |")
    print("|---|---|---|---|")
    for folder in folders:
        listed = PictureList(folder)
        everyone = [
            points for k in range(len(listed)) if (points := listed.landmarks(k, listed.picture(k))) is not None
        ]
        for count in COUNTS:
            columns = [[left(way, points, count) for points in everyone] for way in (place_landmarks, mean_face)]
            print(
                f"| {folder.parent.name}/{folder.name} | {count} | " + " | ".join(map(middle_and_worst, columns)) + " |"
            )
    print(roles("editor", [picture.name for picture in pictures(folders)]))
    times = [ms for k in range(len(PictureList(FOLDER))) for ms in answers(k)]
    print("\n| CPU ms | median | longest |\n|---|---|---|")
    print(f"| a fit with its answer as JSON | {np.median(times):.1f} | {max(times):.1f} |")


def left(way: Callable[[np.ndarray], np.ndarray], points: np.ndarray, count: int) -> float:
    """Mean distance from the truth, in percent, where nobody clicks in the end."""
    clicks = np.full((68, 2), np.nan)
    clicks[ORDER[:count]] = points[ORDER[:count]]
    others = np.setdiff1d(np.arange(17, 68), ORDER)
    off = np.linalg.norm(way(clicks)[others] - points[others], axis=1).mean()
    return 100 * off / float(np.linalg.norm(np.subtract(*points[list(OUTER_EYES)])))


def mean_face(clicks: np.ndarray) -> np.ndarray:
    """The rival: the mean face from the front, laid onto the clicks by a similarity."""
    model, known = default_model(), np.isfinite(clicks[:, 0])
    plane, wanted = model.mean[model.landmarks][:, :2] @ [1, -1j], clicks @ [1, 1j]
    source = plane - plane[known].mean()
    turn = np.vdot(source[known], wanted[known]) / np.vdot(source[known], source[known])
    seen = turn * source + wanted[known].mean()
    return np.stack([seen.real, seen.imag], 1)


def middle_and_worst(errors: list[float]) -> str:
    return f"{np.median(errors):.1f} ({max(errors):.1f})"


def answers(picture: int) -> list[float]:
    """CPU milliseconds of the answers while the tip of the nose goes a pixel a time."""
    session = EditorSession(PictureList(FOLDER))
    points = session.answer("open", {"picture": picture})["points"]
    session.answer("fit", {"picture": picture, "points": points})
    times = []
    for _ in range(NUDGES):
        points[30][0] += 1
        started = time.process_time()
        json.dumps(session.answer("fit", {"picture": picture, "points": points}))
        times.append(1000 * (time.process_time() - started))
    return times


if __name__ == "__main__":
    main()
