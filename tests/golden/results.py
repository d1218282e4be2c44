"""What the stages give for a picture, in few numbers, none of which stays where it is if a constant or a sign changes.

``python -m tests.golden.results`` writes them down anew: when results are meant to change, after looking at the heads.
"""

import sys
from pathlib import Path

import cv2
import numpy as np

from toongeo import (
    bake_texture,
    detect_landmarks,
    edit_expression,
    find_irises,
    fit_3dmm,
    make_avatar,
    parse_face,
    photometric_fit,
    snap_eyes,
)
from toongeo.caricature import fit_caricature
from toongeo.io import read_image, read_landmarks

FOLDER = Path(__file__).parent
PORTRAITS = FOLDER.parents[1] / "examples" / "portraits"
EDITS = {"mouthSmileLeft": 0.8, "jawOpen": 0.4, "eyeBlinkLeft": 1.0}
_STEP = 12  # every so many vertices are kept


def detection(img, landmarks):
    found = detect_landmarks(img)
    return {"points_px": found.points, "confidence": np.r_[found.confidence, found.score]}


def fit(img, landmarks):
    fit = fit_3dmm(img, landmarks)
    lit = photometric_fit(img, fit, landmarks)
    return {
        "vertices_mm": fit.vertices[::_STEP],
        "points_px": fit.project(fit.vertices[fit.landmark_vertices]),
        "lit.vertices_mm": lit.vertices[::_STEP],
        "lit.weights": np.r_[lit.albedo, lit.light.ravel()],
    }


def parse(img, landmarks):
    parse = parse_face(img, landmarks, fit_3dmm(img, landmarks))
    hair = parse.hair
    alpha = hair.mask if hair.alpha is None else hair.alpha
    hat = np.zeros_like(hair.mask) if hair.hat is None else hair.hat
    return {
        "labels": parse.labels,
        "share.weights": small(parse.confidence),
        "hair.weights": small(alpha.astype(np.float32)),
        "hat.weights": small(hat.astype(np.float32)),
        "trusted.weights": np.array([hair.trusted]),
        "eyes_px": snap_eyes(landmarks, parse)[36:48],
        "irises_px": np.array([np.r_[i.centre, i.radii] for i in find_irises(img, landmarks) if i is not None]),
    }


def head(img, landmarks):
    avatar = make_avatar(img, landmarks)
    face, eyes, hair = avatar.face, avatar.eyes, avatar.hair
    values = {
        "aligned_mm": face.vertices[::_STEP],
        "neutral_mm": avatar.rig.neutral[::_STEP],
        "deltas_mm": avatar.rig.deltas[:, :: 2 * _STEP],
        "gaze_mm": avatar.rig.gaze[:, :: 2 * _STEP],
        "motion_sums": np.abs(np.concatenate([avatar.rig.deltas, avatar.rig.gaze])).sum(axis=1),
        "pose.weights": np.r_[avatar.rig.pose, eyes.pose, eyes.turn.ravel() / 90],
        "eyeballs_mm": np.c_[eyes.centres, eyes.radii],
        "texture.levels": small(avatar.texture, 128),
        "diffused.levels": small(bake_texture(img, face, size=256)),
        "seen.levels": small(avatar.render(avatar.pose, size=96)),
    }
    if hair is not None:
        values |= {"hair.surface_mm": hair.vertices[::4], "strands.levels": small(hair.texture, 96)}
    return values


def drawing(img, landmarks):
    fitted = fit_caricature(img, landmarks)
    return {
        "edit.levels": small(edit_expression(img, landmarks, EDITS), 128),
        "caricature_mm": fitted.vertices[::_STEP],
    }


STAGES = {stage.__name__: stage for stage in (detection, fit, parse, head, drawing)}


def picture(name):
    """A bundled picture and its landmarks."""
    return read_image(PORTRAITS / f"{name}.png"), read_landmarks(PORTRAITS / f"{name}.pts")


def small(img, side=48):
    """A picture of so many pixels a side."""
    return cv2.resize(img, (side, side), interpolation=cv2.INTER_AREA)


def path_of(stage, name):
    return FOLDER / "records" / f"{name}_{stage}.npz"


if __name__ == "__main__":
    for stage in sys.argv[1:] or STAGES:
        for name in sorted(path.stem for path in PORTRAITS.glob("*.png")):
            values = STAGES[stage](*picture(name))
            values = {
                key: value if value.dtype == np.uint8 else value.astype(np.float32) for key, value in values.items()
            }
            np.savez_compressed(path_of(stage, name), **values)
