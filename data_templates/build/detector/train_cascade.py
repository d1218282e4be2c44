"""The cascade of regressions, trained on renders."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from detector.linear import principal_axes, ridge_weights, rounded, signed
from detector.samples import SIZE_PX, Samples
from detector.workers import mapped
from toongeo.model.ibug68 import MIRROR
from toongeo.pipeline.landmarks.search.cascade import Cascade, CascadeStage, realigned, shape_terms
from toongeo.pipeline.landmarks.search.face_crop import CROP_PX, RADIUS_PX, face_crop, point_descriptors
from toongeo.pipeline.landmarks.search.frames import applied, box_matrix, box_of, similarity_onto

__all__ = ["train_cascade"]

Floats = NDArray[np.float64]

# Radius of the ring and the two blurs of each stage, px of the crop: from half of the face to half of an eye.
STAGES = ((22, 4, 7), (18, 3, 5.5), (14, 2.4, 4.2), (10, 1.8, 3.2), (7.5, 1.4, 2.4), (5.5, 1.1, 1.8))
_AXES, _SHAPES = 40, 20  # coordinates a point; coordinates of the shape so far
_JITTER, _SCALE_JITTER = 0.14, 0.11  # of the start: of the radius, and of the log of the scale
_PCA_SAMPLES = 4000
_PARTS = 64  # of the samples, for the processes


def train_cascade(samples: Samples, held_out: Samples, processes: int, seed: int = 0, say=print) -> Cascade:
    """Trained on each sample and its mirror image; `held_out` chooses the ridge."""
    rng = np.random.default_rng(seed)
    count = len(samples.grey)
    pictures = np.concatenate([samples.grey, samples.grey[:, :, ::-1], held_out.grey])
    reflected = samples.landmarks[:, MIRROR] * [-1, 1] + [SIZE_PX - 1, 0]
    truth = np.concatenate([samples.landmarks, reflected, held_out.landmarks])
    shape = mean_shape(samples.landmarks)
    boxes = np.array([box_of(points) for points in truth])
    boxes[:, :2] += rng.normal(0, _JITTER, (len(boxes), 2)) * boxes[:, 2:]
    boxes[:, 2] *= np.exp(rng.normal(0, _SCALE_JITTER, len(boxes)))
    matrices = np.array([box_matrix(box, CROP_PX, RADIUS_PX) for box in boxes])
    targets = np.array([applied(m, p) for m, p in zip(matrices, truth, strict=True)])
    points = np.repeat(shape[None], len(truth), axis=0)
    shape_axes = _shape_axes((targets[: 2 * count] - shape).reshape(2 * count, -1))
    cascade = Cascade(shape, shape_axes, ())
    training, testing = slice(0, 2 * count), slice(2 * count, None)
    for number, (radius, near, far) in enumerate(STAGES):
        if number:
            for k in range(len(truth)):
                matrices[k], points[k] = realigned(matrices[k], points[k], shape)
                targets[k] = applied(matrices[k], truth[k])
        stage = CascadeStage(radius, (near, far), *_axes(pictures, matrices, points, (radius, (near, far)), rng), None)
        rows = _rows(pictures, matrices, points, stage, cascade, processes)
        steps = (targets - points).reshape(len(truth), -1).astype(np.float32)
        weights, ridge = ridge_weights(rows[training], steps[training], rows[testing], steps[testing])
        points = points + (rows @ weights).reshape(points.shape)
        cascade = Cascade(shape, shape_axes, (*cascade.stages, _with_weights(stage, weights)))
        errors = (f"{_error(points, targets, chosen):.4f}" for chosen in (training, testing))
        say(f"stage {number}: ridge {ridge}, error, held out: " + ", ".join(errors), flush=True)
    return cascade


def mean_shape(landmarks: Floats) -> Floats:
    """The symmetric mean (68, 2) of shapes (n, 68, 2) after similarities, in the crop."""
    shapes = landmarks - landmarks.mean(axis=1, keepdims=True)
    mean = shapes[0]
    for _ in range(5):
        mean = np.mean([applied(similarity_onto(s, mean), s) for s in shapes], axis=0)
        mean = (mean + mean[MIRROR] * [-1, 1]) / 2
        mean = mean - mean.mean(axis=0)
        mean = mean / np.sqrt((mean**2).sum(axis=1).mean())
    return mean * RADIUS_PX + CROP_PX / 2


def _shape_axes(offsets: Floats) -> NDArray[np.float32]:
    _, axes = np.linalg.eigh(np.cov(offsets.T))
    return rounded(signed(axes[:, ::-1][:, :_SHAPES]))


def _axes(pictures, matrices, points, kind, rng) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Means (68, d) and principal axes (68, d, c) of the descriptors."""
    radius, blurs = kind
    chosen = rng.choice(len(points), min(_PCA_SAMPLES, len(points)), replace=False)
    crops = (face_crop(_picture(pictures, k), matrices[k]) for k in chosen)
    found = [point_descriptors(crop, points[k], radius, blurs) for crop, k in zip(crops, chosen, strict=True)]
    return principal_axes(np.array(found), _AXES)


def _picture(pictures: NDArray[np.uint8], k: int) -> NDArray[np.uint8]:
    return np.ascontiguousarray(pictures[k])


_SHARED: tuple = ()  # what forked processes inherit instead of receiving it


def _rows(pictures, matrices, points, stage, cascade, processes) -> NDArray[np.float32]:
    global _SHARED
    _SHARED = pictures, matrices, points, stage, cascade
    pieces = np.array_split(np.arange(len(points)), _PARTS)
    return np.concatenate(mapped(_rows_of, pieces, processes))


def _rows_of(chosen: NDArray[np.int64]) -> NDArray[np.float32]:
    pictures, matrices, points, stage, cascade = _SHARED
    out = np.empty((len(chosen), 68 * _AXES + _SHAPES + 1), np.float32)
    for row, k in zip(out, chosen, strict=True):
        row[: 68 * _AXES] = stage.coordinates(face_crop(_picture(pictures, k), matrices[k]), points[k])
        row[68 * _AXES : -1] = shape_terms(points[k], cascade)
        row[-1] = 1
    return out


def _with_weights(stage: CascadeStage, weights) -> CascadeStage:
    return CascadeStage(stage.radius, stage.blurs, stage.mean, stage.axes, weights)


def _error(points: Floats, targets: Floats, chosen: slice) -> float:
    """Median error of the inner 51 points over the distance of the outer corners of the eyes."""
    found, truth = points[chosen], targets[chosen]
    eyes = np.maximum(np.linalg.norm(truth[:, 36] - truth[:, 45], axis=1), 0.25 * RADIUS_PX)
    return float(np.median(np.linalg.norm(found - truth, axis=2)[:, 17:].mean(axis=1) / eyes))
