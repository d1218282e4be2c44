"""Cascades of single parts of the face, trained from where the cascade of the whole face ends."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from detector.linear import principal_axes, ridge_weights
from detector.samples import Samples, mirrored
from detector.workers import mapped
from toongeo.pipeline.landmarks.search.cascade import PART_PX, PART_RADIUS_PX, Cascade, CascadeStage, PartCascade
from toongeo.pipeline.landmarks.search.face_crop import CROP_PX, RADIUS_PX, face_crop, point_descriptors
from toongeo.pipeline.landmarks.search.frames import applied, box_matrix, box_of, similarity_onto

__all__ = ["train_parts"]

Floats = NDArray[np.float64]

_PARTS = (
    np.r_[17:22, 36:42],  # brow and eye of the right side
    np.r_[22:27, 42:48],  # of the left side
    np.r_[27:36],  # nose
    np.r_[48:68],  # mouth
)
_STAGES = ((12, 2.2, 4), (7, 1.4, 2.4))  # radius of the ring and the two blurs, px of the part's crop
_AXES = 40
_JITTER, _SCALE_JITTER = 0.1, 0.08  # of the first start, as in `run_passes`
# Of the start of a part: shift in part radii, log of the scale, rad, and of each point. The cascade of the whole face
# leaves that much more on renders it has not seen than on those it was trained on.
_SHIFT, _SCALE, _TURN, _POINT = 0.08, 0.06, 0.05, 0.04
_PCA_SAMPLES = 2000


def train_parts(samples: Samples, held_out: Samples, cascade: Cascade, processes: int, say=print):
    """Parts of the cascade (tuple of PartCascade); `held_out` chooses the ridges."""
    rng = np.random.default_rng(11)
    pictures, truth, found = _ends(samples, cascade, processes, mirror=True)
    tests, test_truth, test_found = _ends(held_out, cascade, processes, mirror=False)
    eyes = np.linalg.norm(test_truth[:, 36] - test_truth[:, 45], axis=1)
    parts = []
    for rows in _PARTS:
        part = PartCascade(rows, _part_shape(truth[:, rows], cascade.shape[rows]), ())
        points = np.array([_jittered(rng, p) for p in found[:, rows]])
        test_points, stages = test_found[:, rows], []
        report = [_error(test_points, test_truth[:, rows], eyes)]
        for radius, near, far in _STAGES:
            stage = _stage(rng, part, pictures, points, (radius, (near, far)))
            inputs, aims = _regression(part, stage, pictures, points, truth[:, rows])
            test_inputs, test_aims = _regression(part, stage, tests, test_points, test_truth[:, rows])
            weights, _ = ridge_weights(inputs, aims, test_inputs, test_aims)
            stages.append(CascadeStage(stage.radius, stage.blurs, stage.mean, stage.axes, weights))
            one = PartCascade(rows, part.shape, (stages[-1],))
            points = np.array([one.run(g, p) for g, p in zip(pictures, points, strict=True)])
            test_points = np.array([one.run(g, p) for g, p in zip(tests, test_points, strict=True)])
            report.append(_error(test_points, test_truth[:, rows], eyes))
        say(f"part of {len(rows)} points: held out " + " -> ".join(f"{e:.4f}" for e in report), flush=True)
        parts.append(PartCascade(rows, part.shape, tuple(stages)))
    return tuple(parts)


_SHARED: tuple = ()  # what forked processes inherit instead of receiving it


def _ends(samples: Samples, cascade: Cascade, processes: int, mirror: bool):
    """Pictures, true points, and where the cascade of the whole face ends from one jittered start each."""
    global _SHARED
    _SHARED = samples, cascade
    jobs = [(k, side) for side in range(1 + mirror) for k in range(len(samples.grey))]
    found = mapped(_end, jobs, processes, together=32)
    return [np.array(column) for column in zip(*found, strict=True)]


def _end(job: tuple[int, int]):
    samples, cascade = _SHARED
    k, side = job
    rng = np.random.default_rng([12, k, side])
    grey, truth = samples.grey[k], samples.landmarks[k]
    if side:
        grey, truth = mirrored(grey, truth)
    box = box_of(truth)
    box[:2] += rng.normal(0, _JITTER, 2) * box[2]
    box[2] *= np.exp(rng.normal(0, _SCALE_JITTER))
    start = box_matrix(box, CROP_PX, RADIUS_PX)
    return grey, truth, cascade.rough(grey, start, len(cascade.stages))


def _part_shape(truth: Floats, mean: Floats) -> Floats:
    """The mean (k, 2) of a part (n, k, 2) after similarities, in its crop, upright as in the face."""
    for _ in range(4):
        mean = np.mean([applied(similarity_onto(t, mean), t) for t in truth], axis=0)
        mean = (mean - mean.mean(axis=0)) / box_of(mean)[2]
    return mean * PART_RADIUS_PX + PART_PX / 2


def _jittered(rng: np.random.Generator, points: Floats) -> Floats:
    middle_x, middle_y, radius = box_of(points)
    middle, turn, scale = np.array([middle_x, middle_y]), rng.normal(0, _TURN), np.exp(rng.normal(0, _SCALE))
    linear = scale * np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
    moved = (points - middle) @ linear.T + middle + rng.normal(0, _SHIFT, 2) * radius
    return moved + rng.normal(0, _POINT, points.shape) * radius


def _stage(rng, part: PartCascade, pictures, points: Floats, kind) -> CascadeStage:
    """A stage without weights: the principal axes of descriptors."""
    chosen = rng.choice(len(points), min(_PCA_SAMPLES, len(points)), replace=False)
    described = []
    for k in chosen:
        matrix = similarity_onto(points[k], part.shape)
        described.append(point_descriptors(face_crop(pictures[k], matrix, PART_PX), applied(matrix, points[k]), *kind))
    return CascadeStage(*kind, *principal_axes(np.array(described), _AXES), np.zeros((0, 0), np.float32))


def _regression(part: PartCascade, stage: CascadeStage, pictures, points: Floats, truth: Floats):
    """Rows (n, d) and steps (n, 2 k) in the crop of the part."""
    rows, steps = [], []
    for grey, p, t in zip(pictures, points, truth, strict=True):
        matrix = similarity_onto(p, part.shape)
        here = applied(matrix, p)
        coordinates = stage.coordinates(face_crop(grey, matrix, PART_PX), here)
        rows.append(np.concatenate([coordinates, part.terms(here), np.ones(1, np.float32)]))
        steps.append((applied(matrix, t) - here).ravel())
    return np.array(rows), np.array(steps, np.float32)


def _error(points: Floats, truth: Floats, eyes: Floats) -> float:
    return float(np.median(np.linalg.norm(points - truth, axis=2).mean(axis=1) / np.maximum(eyes, 1)))
