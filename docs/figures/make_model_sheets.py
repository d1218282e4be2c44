"""One drawing fitted with several models: ``docs/figures/models.jpg``.

usage: python docs/figures/make_model_sheets.py SHARED [--surrey OUT.jpg]

SHARED holds ``data/models``. A row a model: the drawing, the avatar as drawn from three
sides, its shape, and two expressions.
With --surrey the Surrey model is drawn as well, to a file that stays with you: its licence is non-commercial.
"""

import argparse
from pathlib import Path

import cv2
import numpy as np

import toongeo as tg
from toongeo.io import write_image
from toongeo.model import data_path

HERE = Path(__file__).parent
PICTURE = "examples/portraits/moustache_man"
TILE, TITLE = 240, 24  # px
SMILE = {"mouthSmileLeft": 1.0, "mouthSmileRight": 1.0, "eyeBlinkLeft": 1.0, "eyeBlinkRight": 1.0}


def row(img, landmarks, model, title):
    avatar = tg.make_avatar(img, landmarks, model=model, texture_size=1024)
    scale = (TILE - TITLE) / max(img.shape[:2])
    small = cv2.resize(img, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA)
    tile = np.full((TILE, TILE, 3), 255, np.uint8)
    tile[: small.shape[0], : small.shape[1]] = small
    cv2.putText(tile, title, (6, TILE - 8), cv2.FONT_HERSHEY_SIMPLEX, 0.45, (40, 40, 40), 1, cv2.LINE_AA)
    tiles = [tile, *(avatar.render(avatar.pose, TILE, yaw) for yaw in (0, 40, 85))]
    tiles.append(avatar.render(avatar.pose, TILE, 20, textured=False))
    for weights in ({"jawOpen": 0.7}, SMILE):
        tiles.append(avatar.render({name: w for name, w in weights.items() if name in avatar.names}, TILE))
    return np.hstack(tiles)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("shared", type=Path)
    parser.add_argument("--surrey", type=Path)
    arguments = parser.parse_args()
    img, landmarks = tg.read_image(data_path(f"{PICTURE}.png")), tg.read_landmarks(data_path(f"{PICTURE}.pts"))
    folder = arguments.shared / "data" / "models"
    ict = tg.load_model(folder / "ict_facekit" / "ict_facekit_light.npz")
    rows = [
        row(img, landmarks, tg.default_model(), "template"),
        row(img, landmarks, ict, "ICT-FaceKit"),
        row(img, landmarks, ict.with_rig_of(), "ICT-FaceKit, with_rig_of"),
    ]
    write_image(HERE / "models.jpg", np.vstack(rows))
    if arguments.surrey:
        surrey = tg.load_model(folder / "sfm")
        rows += [
            row(img, landmarks, surrey, "Surrey"),
            row(img, landmarks, surrey.with_rig_of(), "Surrey, with_rig_of"),
        ]
        write_image(arguments.surrey, np.vstack(rows))


if __name__ == "__main__":
    main()
