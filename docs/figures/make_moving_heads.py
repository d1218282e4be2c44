"""Five example pictures, and below each its head that turns, speaks, laughs and blinks: one animated WebP that loops.

usage: python docs/figures/make_moving_heads.py [folder of avatars as NAME.glb, made of the pictures if left out]
"""

import sys
from collections.abc import Mapping
from pathlib import Path

import cv2
import numpy as np
from PIL import Image

from toongeo import Avatar, ScaledOrthographicCamera, load_avatar, make_avatar, preset, read_image, read_landmarks

HERE = Path(__file__).parent
PORTRAITS = HERE.parents[1] / "examples" / "portraits"
TILE, FRAMES, FPS = 192, 60, 15  # px, of 4 s
QUALITY = 70  # of WebP: below that faces of flat colour show blocks
YAW, NOD = 32.0, 5.0  # degrees to either side
EXTENT = 0.98  # of the height of head and neck that a tile shows: the end of the neck is cut off
WIDE = 1.75  # of the square about the landmarks, which holds hair and chin

# Each head: part of the turn by which it is ahead, and what it does: middle and length in turns, and the weights.
SPEECH = ("aa", "PP", "oh", "nn", "E", "FF", "ou")
TALK = tuple((0.30 + 0.055 * k, 0.11, preset(f"viseme_{name}")) for k, name in enumerate(SPEECH))
BLINK = {"eyeBlinkLeft": 1.0, "eyeBlinkRight": 1.0}
ACTS: dict[str, tuple[float, tuple[tuple[float, float, Mapping[str, float]], ...]]] = {
    "moustache_man": (0.0, ((0.35, 0.5, preset("laugh")), (0.8, 0.09, BLINK))),
    "blonde_girl_threequarter": (0.2, (*TALK, (0.12, 0.09, BLINK), (0.85, 0.3, preset("smile")))),
    "astronaut": (0.55, ((0.3, 0.45, preset("smile")), (0.72, 0.4, preset("surprise")), (0.95, 0.09, BLINK))),
    "blue_girl": (0.4, ((0.3, 0.4, preset("surprise")), (0.75, 0.35, preset("wink")))),
    "beethoven": (0.75, ((0.25, 0.45, preset("anger")), (0.65, 0.3, preset("kiss")), (0.9, 0.09, BLINK))),
}


def weights_at(turn: float, acts: tuple[tuple[float, float, Mapping[str, float]], ...]) -> dict[str, float]:
    """What the face does at a part of the loop; each act swells and fades, the last frame runs into the first."""
    weights: dict[str, float] = {}
    for middle, length, act in acts:
        away = abs((turn - middle + 0.5) % 1 - 0.5) / (length / 2)
        share = np.cos(np.pi / 2 * away) ** 2 if away < 1 else 0.0
        for name, weight in act.items():
            weights[name] = min(1.0, weights.get(name, 0.0) + share * weight)
    return weights


def picture_tile(img: np.ndarray, landmarks: np.ndarray) -> np.ndarray:
    """A square about the face, white beyond the picture's border."""
    low, high = landmarks.min(0), landmarks.max(0)
    side = WIDE * (high - low).max()
    corner, scale = (low + high) / 2 - [side / 2, 0.6 * side], TILE / side
    shrunk = cv2.GaussianBlur(img, (0, 0), max(0.01, 0.4 / scale))
    shift = np.array([[scale, 0, -corner[0] * scale], [0, scale, -corner[1] * scale]])
    return cv2.warpAffine(shrunk, shift, (TILE, TILE), flags=cv2.INTER_LINEAR, borderValue=(255, 255, 255))


def camera_at(avatar: Avatar, yaw: float, pitch: float) -> ScaledOrthographicCamera:
    """A camera that shows head and hair from above the hair to the middle of the neck."""
    skin = avatar.rig.neutral[avatar.face.region("skin")]
    shown = skin if avatar.hair is None else np.vstack([skin, avatar.hair.vertices])
    low, high = shown.min(0), shown.max(0)
    extent = EXTENT * (high - low).max()
    centre = (low + high) / 2
    centre[1] = high[1] + 0.03 * extent - extent / 2
    return ScaledOrthographicCamera.look(yaw, pitch, size=TILE, centre=centre, extent=extent)


def head_tiles(avatar: Avatar, ahead: float, acts: tuple) -> list[np.ndarray]:
    """The frames of one head."""
    turns = np.arange(FRAMES) / FRAMES
    angles = 2 * np.pi * (turns + ahead)
    return [
        avatar.render(
            weights_at(turn, acts), TILE, camera=camera_at(avatar, YAW * np.sin(angle), NOD * np.sin(2 * angle))
        )
        for turn, angle in zip(turns.tolist(), angles.tolist(), strict=True)
    ]


def main(folder: Path | None = None) -> None:
    columns = []
    for name, (ahead, acts) in ACTS.items():
        img, landmarks = read_image(PORTRAITS / f"{name}.png"), read_landmarks(PORTRAITS / f"{name}.pts")
        avatar = make_avatar(img, landmarks) if folder is None else load_avatar(folder / f"{name}.glb")
        above = picture_tile(img, landmarks)
        columns.append([np.vstack([above, head]) for head in head_tiles(avatar, ahead, acts)])
        print(name)
    frames = [Image.fromarray(np.hstack(tiles)) for tiles in zip(*columns, strict=True)]
    out = HERE / "moving_heads.webp"
    frames[0].save(
        out, save_all=True, append_images=frames[1:], duration=1000 // FPS, loop=0, quality=QUALITY, method=4
    )
    print(out, out.stat().st_size)


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:2]))
