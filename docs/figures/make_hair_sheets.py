"""Heads with hair painted on and with hair of their own, as small JPEGs beside this script.

usage: python docs/figures/make_hair_sheets.py
"""

from pathlib import Path

import cv2
import numpy as np

from toongeo import make_avatar, read_image, read_landmarks
from toongeo.io import write_image

HERE = Path(__file__).parent
PORTRAITS = HERE.parents[1] / "examples" / "portraits"
TILE = 224
VIEWS = ((0, True), (40, True), (-40, True), (85, True), (180, True), (40, False))  # yaw, textured
BROWS = ("browInnerUpLeft", "browInnerUpRight", "browOuterUpLeft", "browOuterUpRight")
MOVED = {"jawOpen": 0.8, **dict.fromkeys(BROWS, 1.0)}


def fitted(img: np.ndarray) -> np.ndarray:
    """The picture in a white square."""
    scale = TILE / max(img.shape[:2])
    small = cv2.resize(img, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA)
    square = np.full((TILE, TILE, 3), 255, np.uint8)
    top, left = (TILE - small.shape[0]) // 2, (TILE - small.shape[1]) // 2
    square[top : top + small.shape[0], left : left + small.shape[1]] = small
    return square


def main() -> None:
    rows = {}
    for picture in sorted(PORTRAITS.glob("*.png")):
        img, landmarks = read_image(picture), read_landmarks(picture.with_suffix(".pts"))
        painted, worn = make_avatar(img, landmarks, hair=False), make_avatar(img, landmarks)
        tiles = [fitted(img), painted.render(painted.pose, TILE, 40)]
        tiles += [worn.render(worn.pose, TILE, yaw, textured=textured) for yaw, textured in VIEWS]
        tiles.append(worn.render(MOVED, TILE, -30))
        rows[picture.stem] = np.hstack(tiles)
        print(picture.stem, *(warning for warning in worn.report.warnings if "hair" in warning))
    write_image(HERE / "hair.jpg", np.ascontiguousarray(np.vstack([rows[name] for name in rows])))


if __name__ == "__main__":
    main()
