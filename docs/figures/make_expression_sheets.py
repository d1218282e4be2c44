"""Six expressions of each example picture beside two baselines, as one small JPEG a picture beside this script.

usage: python docs/figures/make_expression_sheets.py [folder of pictures] [folder for the sheets]

First row: the picture, then open mouth, smile, pout, contempt, closed eyes and surprise by
``toongeo.ExpressionEditor``. Second: the same landmarks moved by a thin-plate warp of the picture. Third: deformation
transfer alone, that is the avatar with its fixed texture drawn over the picture.
"""

import sys
from pathlib import Path

import cv2
import numpy as np

from toongeo import ExpressionEditor, read_image, read_landmarks, render_mesh
from toongeo.caricature import thin_plate_warp
from toongeo.io import write_image

HERE = Path(__file__).parent
PORTRAITS = HERE.parents[1] / "examples" / "portraits"
TILE = 200  # px
EXPRESSIONS: tuple[dict[str, float], ...] = (
    {"jawOpen": 0.7},
    {"mouthSmileLeft": 0.9, "mouthSmileRight": 0.9, "cheekSquintLeft": 0.5, "cheekSquintRight": 0.5},
    {"mouthPucker": 0.9, "mouthShrugLower": 0.4},
    {"mouthSmileLeft": 0.7, "mouthDimpleLeft": 0.6, "browDownRight": 0.6, "noseSneerLeft": 0.3},
    {"eyeBlinkLeft": 1.0, "eyeBlinkRight": 1.0},
    {"jawOpen": 0.5, "eyeWideLeft": 0.8, "eyeWideRight": 0.8, "browInnerUpLeft": 1.0, "browInnerUpRight": 1.0}
    | {"browOuterUpLeft": 1.0, "browOuterUpRight": 1.0},
)


def main(pictures: Path = PORTRAITS, sheets: Path = HERE) -> None:
    for path in sorted(path for path in pictures.iterdir() if path.suffix in (".png", ".jpg")):
        beside = path.with_suffix(".pts") if path.with_suffix(".pts").exists() else path.with_suffix(".txt")
        write_image(sheets / f"expressions_{path.stem}.jpg", expression_sheet(read_image(path), read_landmarks(beside)))
        print(path.stem)


def expression_sheet(img: np.ndarray, landmarks: np.ndarray) -> np.ndarray:
    """Three rows of seven tiles."""
    editor = ExpressionEditor(img, landmarks)
    box = _box(landmarks, img.shape)
    ways = editor.frame, lambda weights: _warped(editor, img, weights), lambda weights: _over(editor, img, weights)
    rows = [np.hstack([_tile(picture[box]) for picture in (img, *map(way, EXPRESSIONS))]) for way in ways]
    return np.ascontiguousarray(np.vstack(rows))


def _warped(editor: ExpressionEditor, img: np.ndarray, weights: dict[str, float]) -> np.ndarray:
    return thin_plate_warp(img, editor.landmarks(editor.pose), editor.landmarks(weights))


def _over(editor: ExpressionEditor, img: np.ndarray, weights: dict[str, float]) -> np.ndarray:
    """The avatar's blendshapes with one texture for all expressions."""
    avatar = editor.avatar
    return render_mesh(
        avatar.surfaces(weights), avatar.face.camera, img.shape[:2], background=img, shading="unlit", supersample=1
    )


def _box(landmarks: np.ndarray, shape: tuple[int, ...]) -> tuple[slice, slice]:
    """Rows and columns of a square about the face."""
    middle = (landmarks.min(0) + landmarks.max(0)) / 2 - [0, 0.05 * np.ptp(landmarks[:, 1])]
    half = min(0.8 * np.ptp(landmarks, axis=0).max(), min(shape[:2]) / 2)
    x, y = np.clip(middle, half, np.array(shape[1::-1]) - half)
    return slice(int(y - half), int(y + half)), slice(int(x - half), int(x + half))


def _tile(picture: np.ndarray) -> np.ndarray:
    how = cv2.INTER_AREA if len(picture) > TILE else cv2.INTER_CUBIC
    return np.asarray(cv2.resize(picture, (TILE, TILE), interpolation=how))


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:3]))
