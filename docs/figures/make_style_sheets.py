"""A sheet of the styles: photograph and drawings above, avatars of photograph, toon and chibi below.

usage: python docs/figures/make_style_sheets.py
"""

from pathlib import Path

import cv2
import numpy as np

from toongeo import make_avatar, read_image, read_landmarks, stylize
from toongeo.io import write_image
from toongeo.pipeline import STYLES

HERE = Path(__file__).parent
PORTRAITS = HERE.parents[1] / "examples" / "portraits"
TILE = 260


def main() -> None:
    sheet("astronaut", read_image(PORTRAITS / "astronaut.png"), read_landmarks(PORTRAITS / "astronaut.pts"))


def sheet(name: str, img: np.ndarray, landmarks: np.ndarray) -> None:
    drawings = {style: stylize(img, landmarks, style) for style in STYLES}
    top = [head(img, landmarks), *(head(drawn.img, landmarks) for drawn in drawings.values())]
    bottom = []
    for style in (None, "toon", "chibi"):
        avatar = make_avatar(img, landmarks, style=style)
        bottom += [avatar.render(avatar.pose, TILE, yaw)[..., :3] for yaw in (0, 40)]
    write_image(HERE / f"styles_{name}.jpg", np.vstack([np.hstack(top), np.hstack(bottom)]))
    print(name)


def head(img: np.ndarray, landmarks: np.ndarray) -> np.ndarray:
    low, high = landmarks.min(axis=0), landmarks.max(axis=0)
    side, centre = 1.15 * (high - low).max(), (low + high) / 2 - [0, 0.2 * (high - low).max()]
    cut = cv2.getRectSubPix(img, (round(2 * side),) * 2, tuple(centre))
    return cv2.resize(cut, (TILE, TILE), interpolation=cv2.INTER_AREA)


if __name__ == "__main__":
    main()
