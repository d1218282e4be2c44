"""Photometric fits of the seven example pictures, as small JPEGs beside this script.

Each shows the picture, the fitted shape as clay over it, the albedo in its light, and the residual: rendering minus
picture, mean of the channels. Blue: the rendering is too dark; red: too bright; the numbers are in sRGB, 0..1.

usage: python docs/figures/make_fit_sheets.py [FOLDER OUT]   (other pictures with .pts beside them)
"""

import sys
from pathlib import Path

import cv2
import numpy as np

from toongeo import fit_3dmm, photometric_fit, read_image, read_landmarks, rendered_picture, residual_map
from toongeo.geometry import vertex_normals
from toongeo.io import write_image
from toongeo.render import Surface, render_mesh

HERE = Path(__file__).parent
PORTRAITS = HERE.parents[1] / "examples" / "portraits"
TILE, MARGIN = 256, 0.12
RANGE = 0.25  # residual in sRGB at the ends of the scale


def diverging(values):
    """Colours (..., 3) uint8 of values in [-1, 1]: blue, white, red; NaN is grey."""
    t = np.clip(values, -1, 1)
    ends = np.where((t < 0)[..., None], [0.13, 0.3, 0.7], [0.75, 0.1, 0.12])
    colours = 1 + np.abs(t)[..., None] * (ends - 1)
    colours[~np.isfinite(values)] = 0.6
    return np.round(255 * colours).astype(np.uint8)


def clay(fit, img):
    """The front of the fitted face shaded over its picture."""
    front = fit.faces[fit.region("face")[fit.faces].all(axis=1)]
    surface = Surface(fit.vertices, front, normals=vertex_normals(fit.vertices, fit.faces))
    return render_mesh(surface, fit.camera, img.shape[:2], background=img, shading="clay")


def tile(picture, corner, side):
    """A square cut out of a picture, white beyond its border."""
    shift = np.array([[1, 0, -corner[0]], [0, 1, -corner[1]]], float)
    shift *= TILE / side
    shrunk = cv2.GaussianBlur(picture, (0, 0), max(0.01, 0.4 * side / TILE)) if side > TILE else picture
    return cv2.warpAffine(shrunk, shift, (TILE, TILE), flags=cv2.INTER_LINEAR, borderValue=(255, 255, 255))


def scale_bar():
    """The colours of the residual with their numbers."""
    bar = np.full((TILE, 76, 3), 255, np.uint8)
    ramp = np.linspace(1, -1, TILE - 40)
    bar[20:-20, 8:24] = diverging(np.repeat(ramp[:, None], 16, axis=1))
    for value in (1, 0.5, 0, -0.5, -1):
        row = int(20 + (1 - value) / 2 * (TILE - 41)) + 4
        cv2.putText(bar, f"{value * RANGE:+.3f}", (27, row), cv2.FONT_HERSHEY_SIMPLEX, 0.36, (0, 0, 0), 1, cv2.LINE_AA)
    return bar


def sheet(img, landmarks):
    """Input, clay, rendering, residual, scale; and the fit."""
    fit = photometric_fit(img, fit_3dmm(img, landmarks), landmarks)
    points = fit.project(fit.vertices[fit.region("face")])
    low, high = points.min(axis=0), points.max(axis=0)
    side = (1 + 2 * MARGIN) * (high - low).max()
    corner = (low + high - side) / 2
    residual = diverging(residual_map(img, fit).mean(axis=2) / RANGE)
    pictures = [img, clay(fit, img), rendered_picture(fit, img.shape, background=img), residual]
    tiles = [tile(np.ascontiguousarray(picture), corner, side) for picture in pictures]
    return np.concatenate([*tiles, scale_bar()], axis=1), fit


def main() -> None:
    folder, out = (Path(name) for name in sys.argv[1:]) if len(sys.argv) == 3 else (PORTRAITS, HERE)
    for points in sorted(folder.glob("*.pts")):
        path = next(path for path in sorted(folder.glob(f"{points.stem}.*")) if path.suffix != ".pts")
        picture, fit = sheet(read_image(path), read_landmarks(points))
        write_image(out / f"fit_{points.stem}.jpg", np.ascontiguousarray(picture))
        report = fit.photometric
        print(f"{points.stem}: {100 * report.residual_before:.1f} % -> {100 * report.residual_after:.1f} %")


if __name__ == "__main__":
    main()
