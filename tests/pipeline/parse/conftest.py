"""A rendered face in flat colours whose parts are known."""

from dataclasses import dataclass

import cv2
import numpy as np
import pytest

from toongeo.protocols import FaceLabel
from toongeo.render import ScaledOrthographicCamera, rasterize, render_mesh
from toongeo.render.surface import Surface

SKIN, HAIR, LIPS, BROW = (0.93, 0.75, 0.62), (0.35, 0.2, 0.1), (0.75, 0.25, 0.25), (40, 25, 15)
BACKGROUND = (0.55, 0.7, 0.85)


@dataclass
class DrawnFace:
    img: np.ndarray  # (h, w, 3) uint8
    landmarks: np.ndarray  # (68, 2) px
    labels: np.ndarray  # (h, w) uint8, without nose and ears


@pytest.fixture(scope="session")
def drawn_face(model):
    """The template in skin, hair and lips of one colour each, with painted eyes and brows, 400 px."""
    camera = ScaledOrthographicCamera.look(yaw=8.0, size=400, centre=(0, -35, 0), extent=330.0)
    hair = model.region("scalp") & (model.mean[:, 1] > 10)
    colours = np.where(hair[:, None], HAIR, np.where(model.region("lips")[:, None], LIPS, SKIN))
    head = (model.faces[~model.region("mouth_cavity")[model.faces].all(axis=1)]).copy()
    img = render_mesh(Surface(model.mean, head, colours), camera, 400, shading="unlit", background=BACKGROUND)
    landmarks = camera.project(model.mean[model.landmarks])
    seen = rasterize(np.column_stack([camera.project(model.mean), camera.depth(model.mean)]), head, 400, 400)
    part = np.full(len(model.mean), FaceLabel.SKIN, np.uint8)
    part[model.region("neck")], part[hair] = FaceLabel.NECK, FaceLabel.HAIR
    part[model.region("lips")] = FaceLabel.UPPER_LIP
    labels = np.append(part[head].max(axis=1), FaceLabel.BACKGROUND).astype(np.uint8)[seen.face_ids]
    for rows, label in ((range(36, 42), FaceLabel.EYE_RIGHT), (range(42, 48), FaceLabel.EYE_LEFT)):
        paint_eye(img, labels, landmarks[list(rows)], label)
    for first in (17, 22):
        line = np.rint(landmarks[first : first + 5] * 16).astype(int)
        cv2.polylines(img, [line], False, BROW, 4, cv2.LINE_AA, shift=4)
    return DrawnFace(img, landmarks, labels)


def paint_eye(img, labels, lids, label):
    """White opening and dark iris, in place."""
    opening = np.zeros(labels.shape, np.uint8)
    cv2.fillPoly(opening, [np.rint(lids * 16).astype(int)], 1, shift=4)
    iris = np.zeros_like(opening)
    x, y = np.rint(lids.mean(axis=0)).astype(int)
    cv2.circle(iris, (int(x), int(y)), round(0.2 * np.ptp(lids[:, 0])), 1, -1)
    img[opening == 1] = (250, 250, 250)
    img[(iris & opening) == 1] = (50, 70, 40)
    labels[opening == 1] = label
