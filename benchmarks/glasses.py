"""Glasses that are found, on pictures as they are and with glasses drawn on them, and on fresh renders.

usage: PYTHONPATH=.:data_templates/build python benchmarks/glasses.py [--renders COUNT] [FOLDER ...]
(pictures with .pts or .txt beside them; default: the bundled examples)

Three frames (thin and dark, thick and square, thin and brown) and one pair of dark glasses are drawn on each picture.
Renders wear round, square or dark glasses in 13 of 100, painted before the style; those whose frames cover less than
0.3 % of the picture are left aside.
"""

import os

for variable in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"):
    os.environ[variable] = "1"

import argparse

import cv2
import numpy as np
from pictures import CHOSEN_ON, pictures, roles

from toongeo import read_image, read_landmarks
from toongeo.pipeline.texture.find_glasses import find_glasses

FRAMES = ((0.05, (40, 35, 30), 2.0), (0.1, (20, 20, 20), 4.0), (0.04, (110, 70, 40), 2.5))  # eye widths, sRGB, power
LEAST = 0.003  # of the picture


def worn(img: np.ndarray, landmarks: np.ndarray, thickness: float, colour: tuple, power: float, dark=False):
    """The picture with glasses drawn on it; lenses are superellipses."""
    out, eyes = img.copy(), (landmarks[36:42], landmarks[42:48])
    width = np.mean([np.linalg.norm(eye[3] - eye[0]) for eye in eyes])
    thick, along = max(1, round(thickness * width)), landmarks[45] - landmarks[36]
    along = along / np.linalg.norm(along)
    turn = np.array([along, [-along[1], along[0]]])
    angles = np.linspace(0, 2 * np.pi, 80, endpoint=False)
    ring = np.column_stack([np.cos(angles), np.sin(angles)])
    ring *= 0.85 * width / ((np.abs(ring[:, :1]) ** power + np.abs(ring[:, 1:] / 0.8) ** power) ** (1 / power))
    middles = [eye.mean(0) + 0.1 * width * turn[1] for eye in eyes]
    for middle in middles:
        outline = [np.rint((middle + ring @ turn) * 16).astype(np.int32)]
        if dark:
            cv2.fillPoly(out, outline, (25, 22, 22), cv2.LINE_AA, 4)
        cv2.polylines(out, outline, True, colour, thick, cv2.LINE_AA, 4)
    bridge = np.array([middles[0] + 0.83 * width * along, middles[1] - 0.83 * width * along])
    cv2.polylines(out, [np.rint(bridge * 16).astype(np.int32)], False, colour, thick, cv2.LINE_AA, 4)
    return out


def kind(img: np.ndarray, landmarks: np.ndarray) -> str:
    found = find_glasses(img, landmarks)
    return "-" if found is None else found.kind


def on_renders(count: int) -> None:
    from renders import Part, render_face

    table = {wears: [0, 0] for wears in (False, True)}
    for seed in range(count):
        render = render_face(np.random.default_rng([2027, seed]))
        share = (render.parts == Part.GLASSES).mean()
        if 0 < share < LEAST:
            continue
        row = table[bool(share)]
        row[0] += find_glasses(render.picture, render.landmarks) is not None
        row[1] += 1
    print("\n| renders | found |\n|---|---|")
    for wears, name in ((True, "with glasses"), (False, "without")):
        print(f"| {table[wears][1]} {name} | {table[wears][0]} |")


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("folders", nargs="*")
    parser.add_argument("--renders", type=int, default=0)
    options = parser.parse_args()
    found = pictures(options.folders)
    counts = {chosen: np.zeros(4, int) for chosen in (True, False)}
    print("| picture | as it is | thin | thick | brown | dark |\n|---|---|---|---|---|---|")
    for picture in found:
        img, landmarks = read_image(picture.image), read_landmarks(picture.landmarks)
        kinds = [kind(worn(img, landmarks, *frame), landmarks) for frame in FRAMES]
        kinds.append(kind(worn(img, landmarks, 0.1, (25, 22, 22), 2.0, dark=True), landmarks))
        own = kind(img, landmarks)
        print(f"| {picture.name} | " + " | ".join([own, *kinds]) + " |", flush=True)
        half = picture.name in CHOSEN_ON["glasses"]
        counts[half] += 1, own != "-", sum(name != "-" for name in kinds[:3]), kinds[3] == "dark"
    print(
        "\n| glasses are found on | of pictures that constants were chosen on | of those only looked at |\n"
        "|---|---|---|"
    )
    for name, row, of in (("as they are", 1, 1), ("clear frames", 2, 3), ("dark glasses", 3, 1)):
        print(f"| {name} | " + " | ".join(f"{count[row]} of {of * count[0]}" for count in counts.values()) + " |")
    if options.renders:
        on_renders(options.renders)
    print(roles("glasses", [picture.name for picture in found]))


if __name__ == "__main__":
    main()
