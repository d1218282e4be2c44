"""What tells faces from clutter once the cascade has run: trained on results of the whole cascade."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from detector.samples import KINDS, Samples, mirrored
from detector.views import classifier, view_classifiers, view_of
from detector.workers import mapped
from toongeo.pipeline.landmarks.search.cascade import Cascade
from toongeo.pipeline.landmarks.search.face_boxes import BoxTemplates, face_boxes
from toongeo.pipeline.landmarks.search.face_crop import CROP_PX, RADIUS_PX
from toongeo.pipeline.landmarks.search.face_verifier import FaceVerifier, verified_row
from toongeo.pipeline.landmarks.search.frames import applied, box_matrix, box_of, composed, inverse
from toongeo.pipeline.landmarks.search.passes import face_patch

__all__ = ["train_verifier"]

_RIDGE, _FIGURE_RIDGE = 0.3, 1.0
_JITTER = 0.1
_CLOSE, _AWAY = 0.15, 0.35  # radii: mean error of a face that was found, and of one that was not
_SEARCHED = 3  # one render in so many is searched for what is taken for a face
_BOXES = 8  # wrong ones of each picture
_ROUNDS, _HARD, _REPEAT = 3, -0.5, 2  # clutter above that score counts more


def train_verifier(
    samples: Samples,
    boxes: BoxTemplates,
    cascade: Cascade,
    clutter: list[NDArray[np.uint8]],
    processes: int,
    say=print,
) -> FaceVerifier:
    """From renders, on and off the face, and from pictures without one."""
    global _SHARED
    _SHARED = samples, boxes, cascade, clutter
    jobs = [("face", k) for k in range(len(samples.grey))] + [("clutter", k) for k in range(len(clutter))]
    results = [entry for part in mapped(_described, jobs, processes, together=16) for entry in part]
    rows = np.array([row for row, _, _ in results])
    views, kinds = (np.array([entry[k] for entry in results]) for k in (1, 2))
    faces, negatives = rows[views >= 0], rows[views < 0]
    say(f"verifier: {len(faces)} faces, {len(negatives)} others", flush=True)
    is_figure = kinds[views >= 0] == KINDS.index("figure")
    if is_figure.any():
        figure = np.append(*classifier(faces[is_figure], faces[~is_figure], _FIGURE_RIDGE)).astype(np.float32)
    else:  # a toy may have none
        figure = np.zeros(rows.shape[1] + 1, np.float32)
    every = negatives
    for _ in range(_ROUNDS):
        verifier = FaceVerifier(*view_classifiers(faces, views[views >= 0], every, _RIDGE), figure)
        scores = (negatives @ verifier.weights.T + verifier.offsets).max(axis=1)
        hard = negatives[scores > _HARD]
        every = np.concatenate([negatives, np.repeat(hard, _REPEAT, axis=0)])
    return verifier


_SHARED: tuple = ()  # what forked processes inherit instead of receiving it


def _described(job: tuple[str, int]) -> list[tuple[NDArray[np.float32], int, int]]:
    """Descriptors after the cascade, each with the view of the face or -1, and the kind of the render or -1."""
    samples, boxes, cascade, clutter = _SHARED
    kind, k = job
    rng = np.random.default_rng([k, kind == "face"])
    if kind == "clutter":
        return [(_run(clutter[k], box, cascade)[1], -1, -1) for box in face_boxes(clutter[k], boxes, 2 * _BOXES)]
    grey, truth, kind_of_head = samples.grey[k], samples.landmarks[k], int(samples.kinds[k])
    if rng.random() < 0.5:
        grey, truth = mirrored(grey, truth)
    face, out = box_of(truth), []
    start = face + np.append(rng.normal(0, _JITTER, 2), rng.normal(0, _JITTER)) * face[2]
    points, row = _run(grey, start, cascade)
    if np.linalg.norm(points - truth, axis=1).mean() < _CLOSE * face[2]:
        out.append((row, view_of(truth, KINDS[kind_of_head]), kind_of_head))
    if k % _SEARCHED == 0:
        for box in face_boxes(grey, boxes, _BOXES):
            points, row = _run(grey, box, cascade)
            if np.linalg.norm(points - truth, axis=1).mean() > _AWAY * face[2]:
                out.append((row, -1, -1))
    return out


def _run(grey: NDArray[np.uint8], box: NDArray[np.float64], cascade: Cascade):
    """Points in the picture, and the descriptors around them."""
    patch = face_patch(grey, box)
    start = composed(box_matrix(box, CROP_PX, RADIUS_PX), inverse(patch.matrix))
    points = cascade.rough(patch.grey, start, len(cascade.stages))  # as at the first look
    return applied(inverse(patch.matrix), points), verified_row(patch.grey, points, cascade)
