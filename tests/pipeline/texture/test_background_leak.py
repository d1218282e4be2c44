"""What stands behind a head has no say in its texture."""

import cv2
import numpy as np
import pytest

from toongeo.pipeline import align_face, bake_texture, fit_3dmm
from toongeo.pipeline.texture.bake_texture import _atlas_fragments
from toongeo.protocols import FaceLabel, FaceParse

TWO_PERCENT = 0.02 * 255
LOUD = (255, 0, 255), (0, 255, 0)


def head_pixels(landmarks, shape, lift):
    """Pixels (h, w) bool within the landmarks' hull with a forehead above it: a hand-made mask of the person."""
    brow, chin = landmarks[17:27].mean(0), landmarks[8]
    forehead = landmarks[17:27] + lift * (brow - chin)
    mask = np.zeros(shape[:2], np.uint8)
    points = np.vstack([landmarks, forehead]).astype(np.int32)
    cv2.fillConvexPoly(mask, cv2.convexHull(points), 1)
    return mask.astype(bool)


def worst_leak(img, landmarks, *, shift=0.0, parsed, lift=0.35):
    """Largest difference of face texels between a magenta and a green background, jaw points moved out by ``shift``."""
    person = head_pixels(landmarks, img.shape, lift)
    moved = landmarks.copy()
    moved[:17] += (
        shift * (landmarks[:17] - landmarks[30]) / np.linalg.norm(landmarks[:17] - landmarks[30], axis=1, keepdims=True)
    )
    face = align_face(fit_3dmm(img, moved), moved)
    labels = np.where(person, FaceLabel.SKIN, FaceLabel.BACKGROUND).astype(np.uint8)
    parse = FaceParse(labels, np.ones(labels.shape)) if parsed else None
    bakes = []
    for colour in LOUD:
        painted = np.where(person[..., None], img, np.uint8(colour))
        bakes.append(bake_texture(painted, face, size=512, parse=parse).astype(int))
    atlas = _atlas_fragments(face.model, 512)
    texels = atlas.mask & face.region("face")[face.faces].all(1)[atlas.face_ids]
    return np.abs(bakes[0] - bakes[1])[texels].max()


@pytest.mark.parametrize("shift", [0.0, 4.0])
@pytest.mark.parametrize("name", ["astronaut", "bad_guy", "moustache_man", "blonde_girl_threequarter"])
def test_with_a_parse_no_face_texel_knows_the_background(cartoon, name, shift):
    assert worst_leak(*cartoon(name), shift=shift, parsed=True) == 0


@pytest.mark.parametrize("shift", [0.0, 4.0])
@pytest.mark.parametrize("name", ["astronaut", "bad_guy", "moustache_man", "blonde_girl_threequarter"])
def test_without_a_parse_the_background_moves_no_face_texel(cartoon, name, shift):
    assert worst_leak(*cartoon(name), shift=shift, parsed=False) <= TWO_PERCENT
