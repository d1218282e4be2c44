"""Landmarks that are found, against points set by hand, and faces found where there are none.

usage: python benchmarks/detection.py [FOLDER ...] [--mediapipe PYTHON]
(pictures with .pts or .txt beside them; default: the bundled examples. PYTHON: the interpreter of an environment with
mediapipe==0.10.21, whose points are measured beside ours)

Error: mean distance of the inner 51 points from those set by hand, or of all 68, over the outer-eye distance. A face
counts as found if the mean of its points lies within half a face radius of theirs.
"""

import os

for variable in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"):
    os.environ[variable] = "1"

import argparse
import json
import subprocess
import time
from pathlib import Path

import numpy as np
import skimage.data
from pictures import FOLDER, pictures, roles
from snapping import outer_eyes

from toongeo import detect_faces, read_image, read_landmarks
from toongeo.model.ibug68 import INNER
from toongeo.model.mediapipe478 import VERTICES

# Pictures of scikit-image without a face; the first nine and cell, retina and microaneurysms were
# clutter in training, the others were not.
FACELESS = (
    *("coffee.png", "rocket.jpg", "brick.png", "grass.png", "gravel.png", "hubble_deep_field.jpg", "moon.png"),
    *("text.png", "clock_motion.png", "chelsea.png", "horse.png", "coins.png", "page.png", "motorcycle_left.png"),
    *("retina.jpg", "cell.png", "ihc.png", "microaneurysms.png", "logo.png", "phantom.png"),
)


def errors(points: np.ndarray | None, truth: np.ndarray) -> tuple[bool, float, float]:
    """Found or not, and the errors of the inner and of all points (infinite if not found)."""
    if points is None:
        return False, np.inf, np.inf
    middle = truth.mean(axis=0)
    radius = np.sqrt(((truth - middle) ** 2).sum(axis=1).mean())
    if np.linalg.norm(points.mean(axis=0) - middle) > 0.5 * radius:
        return False, np.inf, np.inf
    distance = np.linalg.norm(points - truth, axis=1) / outer_eyes(truth)
    return True, float(distance[INNER].mean()), float(distance.mean())


def rival_points(python: str, paths: list[Path]) -> list[np.ndarray | None]:
    script = Path(__file__).with_name("mediapipe_points.py")
    printed = subprocess.run([python, script, *paths], capture_output=True, text=True, check=True).stdout
    return [None if points is None else np.array(points)[VERTICES] for points in json.loads(printed.splitlines()[-1])]


def row(name: str, who: str, results: list[tuple[bool, float, float]], seconds: float | None) -> str:
    found, inner, all_ = (np.array(column) for column in zip(*results, strict=True))
    mean = inner[found].mean() if found.any() else np.inf
    took = "" if seconds is None else f"{seconds:.2f}"
    return (
        f"| {name} ({len(found)}) | {who} | {100 * found.mean():.0f} | {np.median(inner):.3f} / {mean:.3f} | "
        f"{100 * (inner <= 0.08).mean():.0f} | {np.median(all_):.3f} | {took} |"
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folders", nargs="*", type=Path, default=[FOLDER])
    parser.add_argument("--mediapipe", metavar="PYTHON")
    parser.add_argument("--each", action="store_true", help="a line for each picture, too")
    arguments = parser.parse_args()
    print("| pictures | by | found % | inner 51, median / mean of found | <= 8 % | all 68 | s |")
    print("|---|---|---|---|---|---|---|")
    names: list[str] = []
    for folder in arguments.folders:
        found_pictures = pictures([folder])
        names += [picture.name for picture in found_pictures]
        truths = [read_landmarks(picture.landmarks) for picture in found_pictures]
        results, seconds = [], []
        for picture, truth in zip(found_pictures, truths, strict=True):
            img = read_image(picture.image)
            start = time.process_time()
            faces = detect_faces(img)
            seconds.append(time.process_time() - start)
            results.append(errors(faces[0].points if faces else None, truth))
            if arguments.each:
                sure = f"{faces[0].score:.2f} {faces[0].confidence[INNER].mean():.2f}" if faces else "-"
                print(f"  {picture.name}: {results[-1][1]:.3f} {results[-1][2]:.3f}, {len(faces)} faces, {sure}")
        print(row(folder.name, "toongeo", results, float(np.median(seconds))), flush=True)
        if arguments.mediapipe:
            rival = rival_points(arguments.mediapipe, [picture.image for picture in found_pictures])
            found = [errors(points, truth) for points, truth in zip(rival, truths, strict=True)]
            print(row(folder.name, "MediaPipe", found, None), flush=True)
    print(roles("detection", names))
    folder = Path(skimage.data.__file__).parent
    false = {name: len(detect_faces(read_image(folder / name))) for name in FACELESS}
    where = ", ".join(name for name, count in false.items() if count) or "nowhere"
    print(f"\nfalse faces in {len(false)} pictures without one: {sum(false.values())} ({where})")


if __name__ == "__main__":
    main()
