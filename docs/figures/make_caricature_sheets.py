"""Sheets of caricatures, as small JPEGs: picture, 3DMM, ARAP, caricatured 3DMM, ours in clay and with its texture.

usage: python docs/figures/make_caricature_sheets.py [FOLDER OUT]   (the example pictures, beside this script)
"""

import sys
from pathlib import Path

import cv2
import numpy as np

from toongeo import default_model, make_avatar, render_mesh
from toongeo.app.bench.bench_folder import bench_folder
from toongeo.app.bench.caricature_methods import FoundFace, caricature_methods
from toongeo.io import write_image
from toongeo.render import ScaledOrthographicCamera, Surface

HERE = Path(__file__).parent
PORTRAITS = HERE.parents[1] / "examples" / "portraits"
RIVALS = {"3DMM": "3DMM", "fit_3dmm + ARAP": "ARAP", "caricatured 3DMM": "caricatured 3DMM"}
YAWS = 0, 40
TILE = 256


def sheet(img: np.ndarray, landmarks: np.ndarray, methods) -> np.ndarray:
    columns = [np.vstack(input_views(img, landmarks))]
    for method, title in RIVALS.items():
        face = methods[method](landmarks)
        columns.append(np.vstack([titled(clay(face, yaw), title) for yaw in YAWS]))
    avatar = make_avatar(img, landmarks, method="caricature")
    for textured, title in ((False, "ours"), (True, "ours, textured")):
        views = [titled(avatar.render(size=TILE, yaw=yaw, textured=textured), title) for yaw in YAWS]
        columns.append(np.vstack(views))
    return np.ascontiguousarray(np.hstack(columns))


def input_views(img: np.ndarray, landmarks: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """A square around the face, without and with the landmarks."""
    low, high = np.nanmin(landmarks, axis=0), np.nanmax(landmarks, axis=0)
    side = 1.7 * (high - low).max()
    corner, scale = (low + high - side) / 2 - [0, 0.12 * side], TILE / side
    place = np.array([[scale, 0, -corner[0] * scale], [0, scale, -corner[1] * scale]])
    plain = cv2.warpAffine(img, place, (TILE, TILE), flags=cv2.INTER_AREA, borderValue=(255,) * 3)
    marked = plain.copy()
    for x, y in (landmarks[np.isfinite(landmarks).all(1)] - corner) * scale:
        cv2.circle(marked, (round(x * 16), round(y * 16)), 28, (220, 30, 30), -1, cv2.LINE_AA, shift=4)
    return titled(plain, "input"), marked


def clay(face: FoundFace, yaw: float) -> np.ndarray:
    model = default_model()
    skin = face.vertices[model.region("skin")]
    low, high = skin.min(axis=0), skin.max(axis=0)
    extent = 1.12 * (high - low).max()
    camera = ScaledOrthographicCamera.look(yaw, size=TILE, centre=(low + high) / 2, extent=extent)
    return render_mesh([Surface(face.vertices, model.faces)], camera, TILE, shading="clay")


def titled(view: np.ndarray, title: str) -> np.ndarray:
    view = np.ascontiguousarray(view)
    cv2.putText(view, title, (8, 18), cv2.FONT_HERSHEY_SIMPLEX, 0.45, (40, 40, 40), 1, cv2.LINE_AA)
    return view


def main() -> None:
    folder, out = (Path(argument) for argument in sys.argv[1:]) if len(sys.argv) > 1 else (PORTRAITS, HERE)
    methods = caricature_methods(default_model())
    for picture in bench_folder(folder):
        write_image(out / f"caricature_{picture.picture.stem}.jpg", sheet(*picture.read(), methods))


if __name__ == "__main__":
    main()
