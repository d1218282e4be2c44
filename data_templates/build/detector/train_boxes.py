"""Templates of face boxes, trained on windows of renders and on what they confuse with faces."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from detector.samples import KINDS, Samples, mirrored
from detector.views import view_classifiers, view_of
from toongeo.pipeline.landmarks.search.face_boxes import (
    BOX_RADIUS_PX,
    WINDOW_PX,
    BoxTemplates,
    box_descriptor,
    face_boxes,
)
from toongeo.pipeline.landmarks.search.frames import box_matrix, box_of

__all__ = ["train_boxes"]

_RIDGE = 0.1
_JITTER = 0.05  # of the radius, and of the log of the scale
_RANDOM = 3  # windows beside each face
_AWAY, _OTHER_SIZE = 0.6, 0.45  # radii, log of the scale: farther than that it is not the face
_SEARCHED = 400  # renders, from all of them, searched for what is confused with faces
_ROUNDS = 2
_LEAST = -0.4  # score of a confusion worth learning from
_REPEAT = 2  # how much more a confusion counts than a random window


def train_boxes(samples: Samples, clutter: list[NDArray[np.uint8]], seed: int = 0, say=print) -> BoxTemplates:
    """From renders, and grey pictures without a face."""
    rng = np.random.default_rng(seed)
    faces, views, negatives = [], [], []
    for grey, points, kind in zip(samples.grey, samples.landmarks, samples.kinds, strict=True):
        if rng.random() < 0.5:
            grey, points = mirrored(grey, points)
        box = box_of(points)
        moved = box + np.append(rng.normal(0, _JITTER, 2), rng.normal(0, _JITTER)) * box[2]
        faces.append(_window(grey, moved))
        views.append(view_of(points, KINDS[kind]))
        negatives += [_window(grey, _elsewhere(rng, box, grey.shape)) for _ in range(_RANDOM)]
    faces, views, negatives = np.array(faces), np.array(views), np.array(negatives)
    templates = BoxTemplates(*view_classifiers(faces, views, negatives, _RIDGE))
    confused: list[NDArray] = []
    searched = slice(None, None, max(len(samples.grey) // _SEARCHED, 1))
    for _ in range(_ROUNDS):
        for grey, points in zip(samples.grey[searched], samples.landmarks[searched], strict=True):
            boxes = face_boxes(grey, templates, 6)
            confused += [_window(grey, b) for b in boxes if b[3] > _LEAST and not _is(b, box_of(points))]
        for grey in clutter:
            confused += [_window(grey, b) for b in face_boxes(grey, templates, 20) if b[3] > _LEAST]
        every = np.concatenate([negatives, np.repeat(np.array(confused), _REPEAT, axis=0)])
        templates = BoxTemplates(*view_classifiers(faces, views, every, _RIDGE))
        say(f"boxes: {len(confused)} confusions", flush=True)
    return templates


def _window(grey: NDArray[np.uint8], box: NDArray[np.float64]) -> NDArray[np.float32]:
    matrix = box_matrix(box[:3], WINDOW_PX, BOX_RADIUS_PX)
    scale = matrix[0, 0]
    if scale < 0.7:  # no aliasing
        small = cv2.resize(grey, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA)
        sx, sy = small.shape[1] / grey.shape[1], small.shape[0] / grey.shape[0]
        matrix = matrix @ np.array([[1 / sx, 0, 0.5 / sx - 0.5], [0, 1 / sy, 0.5 / sy - 0.5], [0, 0, 1]])
        grey = small
    return box_descriptor(cv2.warpAffine(grey, matrix, (WINDOW_PX, WINDOW_PX), borderMode=cv2.BORDER_REPLICATE))


def _elsewhere(rng: np.random.Generator, box: NDArray[np.float64], shape) -> NDArray[np.float64]:
    while True:
        size = box[2] * np.exp(rng.uniform(-1.2, 0.6))
        other = np.array([rng.uniform(0, shape[1]), rng.uniform(0, shape[0]), size])
        if not _is(other, box):
            return other


def _is(box: NDArray[np.float64], face: NDArray[np.float64]) -> bool:
    near = np.hypot(*(box[:2] - face[:2])) < _AWAY * face[2]
    return bool(near and abs(np.log(box[2] / face[2])) < _OTHER_SIZE)
