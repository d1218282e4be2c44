"""What the stages give for a picture, in few numbers, none of which stays where it is if a constant or a sign changes.

``python -m tests.golden.results`` writes them down anew: when results are meant to change, after looking at the heads.
"""

from pathlib import Path

import cv2
import numpy as np

from toongeo import bake_texture, detect_landmarks, edit_expression, find_irises, make_avatar
from toongeo.io import read_image, read_landmarks

FOLDER = Path(__file__).parent
PORTRAITS = FOLDER.parents[1] / "examples" / "portraits"
EDITS = {"mouthSmileLeft": 0.8, "jawOpen": 0.4, "eyeBlinkLeft": 1.0}
_STEP = 12  # every so many vertices are kept


def picture(name):
    """A bundled picture and its landmarks."""
    return read_image(PORTRAITS / f"{name}.png"), read_landmarks(PORTRAITS / f"{name}.pts")


def results(avatar, img, landmarks):
    """``stage.key`` -> array."""
    fit, face, eyes, hair = avatar.fit, avatar.face, avatar.eyes, avatar.hair
    found = detect_landmarks(img)
    irises = [iris for iris in find_irises(img, landmarks) if iris is not None]
    whole = {
        "detection.points_px": found.points,
        "detection.confidence": np.r_[found.confidence, found.score],
        "fit.vertices_mm": fit.vertices[::_STEP],
        "fit.points_px": fit.project(fit.vertices[fit.landmark_vertices]),
        "parse.labels": avatar.parse.labels,
        "align.vertices_mm": face.vertices[::_STEP],
        "rig.neutral_mm": avatar.rig.neutral[::_STEP],
        "rig.deltas_mm": avatar.rig.deltas[:, :: 2 * _STEP],
        "rig.weights": avatar.rig.pose,
        "eyes.places_mm": np.c_[eyes.centres, eyes.radii],
        "eyes.weights": np.r_[eyes.pose, eyes.turn.ravel() / 90],
        "irises.ellipses_px": np.array([np.r_[iris.centre, iris.radii] for iris in irises]).reshape(-1, 4),
        "texture.levels": small(avatar.texture),
        "texture.plain_levels": small(bake_texture(img, face, size=256)),
        "edit.levels": small(edit_expression(img, landmarks, EDITS)),
    }
    if hair is not None:
        whole |= {"hair.surface_mm": hair.vertices[::_STEP], "hair.levels": small(hair.texture)}
    return {key: np.asarray(value) for key, value in whole.items()}


def small(img):
    """A picture of 48 pixels a side, in levels."""
    return cv2.resize(img, (48, 48), interpolation=cv2.INTER_AREA)


def record(path, values):
    """Write results in as few bytes as their tolerance allows."""
    rounded = {key: value if value.dtype == np.uint8 else value.astype(np.float32) for key, value in values.items()}
    np.savez_compressed(path, **rounded)


if __name__ == "__main__":
    for path in sorted(PORTRAITS.glob("*.png")):
        img, landmarks = picture(path.stem)
        record(FOLDER / f"{path.stem}.npz", results(make_avatar(img, landmarks), img, landmarks))
