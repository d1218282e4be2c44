"""Each example picture with its head from the front, three-quarter, side and back, textured and as clay: a small JPEG a
picture beside this script.

usage: python docs/figures/make_gallery.py [folder of avatars as NAME.glb, made of the pictures if left out]
"""

import sys
from pathlib import Path

import cv2
import numpy as np

from toongeo import Avatar, load_avatar, make_avatar, read_image, read_landmarks
from toongeo.io import write_image

HERE = Path(__file__).parent
PORTRAITS = HERE.parents[1] / "examples" / "portraits"
TILE = 200  # px
YAWS = (0.0, 40.0, 90.0, 180.0)  # degrees: front, three-quarter, side, back
PAPER = 255


def picture_tile(img: np.ndarray) -> np.ndarray:
    """The whole picture (2 * TILE, TILE, 3) on white."""
    height, width = img.shape[:2]
    scale = min(TILE / width, 2 * TILE / height)
    method = cv2.INTER_AREA if scale < 1 else cv2.INTER_CUBIC
    small = cv2.resize(img, (round(width * scale), round(height * scale)), interpolation=method)
    tile = np.full((2 * TILE, TILE, 3), PAPER, np.uint8)
    y, x = (2 * TILE - small.shape[0]) // 2, (TILE - small.shape[1]) // 2
    tile[y : y + small.shape[0], x : x + small.shape[1]] = small
    return tile


def gallery_sheet(img: np.ndarray, avatar: Avatar) -> np.ndarray:
    """The picture, and two rows of four views (2 * TILE, 5 * TILE, 3) of the face as it is drawn."""
    rows = [
        np.hstack([avatar.render(avatar.pose, TILE, yaw, textured=textured) for yaw in YAWS])
        for textured in (True, False)
    ]
    return np.ascontiguousarray(np.hstack([picture_tile(img), np.vstack(rows)]))


def main(folder: Path | None = None) -> None:
    for path in sorted(PORTRAITS.glob("*.png")):
        img, landmarks = read_image(path), read_landmarks(path.with_suffix(".pts"))
        avatar = make_avatar(img, landmarks) if folder is None else load_avatar(folder / f"{path.stem}.glb")
        write_image(HERE / f"views_{path.stem}.jpg", gallery_sheet(img, avatar))
        print(path.stem)


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:2]))
