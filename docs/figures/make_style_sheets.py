"""Sheets of the styles: a photograph and its drawings above, below them their avatars from the front and from aside.

usage: PYTHONPATH=.:data_templates/build python docs/figures/make_style_sheets.py [NAME ...]

Names are those of the sheets: the astronaut, and two renders of people.
"""

import sys
from pathlib import Path

import cv2
import numpy as np

from toongeo import make_avatar, read_image, read_landmarks, stylize
from toongeo.io import write_image
from toongeo.pipeline import STYLES

HERE = Path(__file__).parent
PORTRAITS = HERE.parents[1] / "examples" / "portraits"
RENDERS = {"render_dark": (77, 4), "render_fair": (77, 22)}  # seeds of renders that look ahead
TILE = 220


def main() -> None:
    for name in sys.argv[1:] or ("astronaut", *RENDERS):
        sheet(name, *picture(name))


def picture(name: str) -> tuple[np.ndarray, np.ndarray]:
    """Picture and landmarks."""
    if name not in RENDERS:
        return read_image(PORTRAITS / f"{name}.png"), read_landmarks(PORTRAITS / f"{name}.pts")
    from renders.scene import random_scene

    scene = random_scene(np.random.default_rng(RENDERS[name]), "person", size=420)
    return np.clip(scene.picture, 0, 255).astype(np.uint8), scene.landmarks


def sheet(name: str, img: np.ndarray, landmarks: np.ndarray) -> None:
    """One column a style, the photograph first."""
    columns = []
    for style in (None, *STYLES):
        drawn = img if style is None else stylize(img, landmarks, style).img
        avatar = make_avatar(img, landmarks, style=style, texture_size=512)
        views = [avatar.render(avatar.pose, TILE, yaw)[..., :3] for yaw in (0, 40)]
        columns.append(np.vstack([head(drawn, landmarks), *views]))
    write_image(HERE / f"styles_{name}.jpg", np.hstack(columns))
    print(name)


def head(img: np.ndarray, landmarks: np.ndarray) -> np.ndarray:
    low, high = landmarks.min(axis=0), landmarks.max(axis=0)
    side, centre = 1.15 * (high - low).max(), (low + high) / 2 - [0, 0.2 * (high - low).max()]
    cut = cv2.getRectSubPix(img, (round(2 * side),) * 2, tuple(centre))
    return cv2.resize(cut, (TILE, TILE), interpolation=cv2.INTER_AREA)


if __name__ == "__main__":
    main()
