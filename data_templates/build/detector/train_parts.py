"""Cascades of single parts of the face, trained from where the cascade of the whole face ends."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from detector.linear import principal_axes, ridge_weights
from detector.samples import Samples, mirrored, with_even_jaw
from detector.workers import mapped
from toongeo.pipeline.landmarks.search.cascade import PART_PX, PART_RADIUS_PX, Cascade, CascadeStage, PartCascade
from toongeo.pipeline.landmarks.search.face_crop import CROP_PX, RADIUS_PX, face_crop, point_descriptors
from toongeo.pipeline.landmarks.search.frames import applied, box_matrix, box_of, inverse, similarity_onto

__all__ = ["PARTS", "WITHOUT_JAW", "train_parts"]

Floats = NDArray[np.float64]

PARTS = (
    np.r_[17:22, 36:42],  # brow and eye of the right side
    np.r_[22:27, 42:48],  # of the left side
    np.r_[27:36],  # nose
    np.r_[48:68],  # mouth
    np.r_[0:17],  # jaw
)
WITHOUT_JAW = PARTS[:-1]
# Radius of the ring and the two blurs, px of the part's crop: the last one sees the line of a lid.
_JITTER, _SCALE_JITTER = 0.1, 0.08  # of the first start, as in `run_passes`
_STAGES = ((12, 2.2, 4), (7, 1.4, 2.4), (4.5, 1.0, 1.6))
_AXES = 40
# Of the start of a part: shift in part radii, log of the scale, rad, and of each point. The cascade of the whole face
# leaves that much more on renders it has not seen than on those it was trained on.
_SHIFT, _SCALE, _TURN, _POINT = 0.08, 0.06, 0.05, 0.04
_PCA_SAMPLES = 1500


def train_parts(
    samples: Samples, held_out: Samples, cascade: Cascade, processes: int, rows=PARTS, say=print
) -> tuple[PartCascade, ...]:
    """Parts of so many `rows`, from where the cascade of the whole face ends; `held_out` chooses the ridges.

    Of each two samples, drawings of one head, the second is mirrored.
    """
    global _SHARED
    _SHARED = samples, held_out, cascade
    jobs = [(k, k % 2) for k in range(len(samples.grey))]
    tests = [(k, -1) for k in range(len(held_out.grey))]
    ends = np.array(mapped(_end, jobs + tests, processes, together=32))
    _SHARED = samples, held_out, cascade, ends, jobs, tests
    trained = mapped(_part, list(enumerate(rows)), processes)
    for part, report in trained:
        say(f"part of {len(part.rows)} points: held out " + " -> ".join(f"{e:.4f}" for e in report), flush=True)
    return tuple(part for part, _ in trained)


_SHARED: tuple = ()  # what forked processes inherit instead of receiving it


def _part(numbered: tuple[int, NDArray[np.int64]]) -> tuple[PartCascade, list[float]]:
    """One part, and its errors on held-out renders before the first stage and after each."""
    _, held_out, cascade, ends, jobs, tests = _SHARED
    number, rows = numbered
    rng = np.random.default_rng([11, number])
    truth = np.array([_sample(job)[1][rows] for job in jobs])
    test_truth, eyes = np.array([_sample(job)[1][rows] for job in tests]), _eyes(held_out.landmarks)
    part = PartCascade(rows, _part_shape(truth, cascade.shape[rows]), ())
    points = np.array([_jittered(rng, p) for p in ends[: len(jobs), rows]])
    test_points, stages = ends[len(jobs) :, rows], []
    report = [_error(test_points, test_truth, eyes)]
    for radius, near, far in _STAGES:
        stage = _stage(rng, part, jobs, points, (radius, (near, far)))
        inputs, aims = _regression(part, stage, jobs, points, truth)
        test_inputs, test_aims = _regression(part, stage, tests, test_points, test_truth)
        weights, _ = ridge_weights(inputs, aims, test_inputs, test_aims)
        stages.append(CascadeStage(stage.radius, stage.blurs, stage.mean, stage.axes, weights))
        points = _stepped(part, points, inputs @ weights)
        test_points = _stepped(part, test_points, test_inputs @ weights)
        report.append(_error(test_points, test_truth, eyes))
    return PartCascade(rows, part.shape, tuple(stages)), report


def _sample(job: tuple[int, int]) -> tuple[NDArray[np.uint8], Floats]:
    """Picture and points of a sample, of its mirror image (1), or of a held-out one (-1); its jaw is even."""
    samples, held_out = _SHARED[:2]
    k, side = job
    source = held_out if side < 0 else samples
    grey, truth = source.grey[k], with_even_jaw(source.landmarks[k])
    return mirrored(grey, truth) if side > 0 else (grey, truth)


def _end(job: tuple[int, int]) -> Floats:
    """Where the cascade of the whole face ends from a jittered start."""
    rng = np.random.default_rng([12, job[0], job[1] + 1])
    grey, truth = _sample(job)
    box = box_of(truth)
    box[:2] += rng.normal(0, _JITTER, 2) * box[2]
    box[2] *= np.exp(rng.normal(0, _SCALE_JITTER))
    cascade = _SHARED[2]
    return cascade.rough(grey, box_matrix(box, CROP_PX, RADIUS_PX), len(cascade.stages))


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


def _stage(rng, part: PartCascade, jobs, points: Floats, kind) -> CascadeStage:
    """A stage without weights: the principal axes of descriptors."""
    chosen = rng.choice(len(points), min(_PCA_SAMPLES, len(points)), replace=False)
    described = []
    for k in chosen:
        matrix = similarity_onto(points[k], part.shape)
        crop = face_crop(_sample(jobs[k])[0], matrix, PART_PX)
        described.append(point_descriptors(crop, applied(matrix, points[k]), *kind))
    return CascadeStage(*kind, *principal_axes(np.array(described), _AXES), np.zeros((0, 0), np.float32))


def _regression(part: PartCascade, stage: CascadeStage, jobs, points: Floats, truth: Floats):
    """Rows (n, d) and steps (n, 2 k) in the crop of the part."""
    rows, steps = [], []
    for job, p, t in zip(jobs, points, truth, strict=True):
        matrix = similarity_onto(p, part.shape)
        here = applied(matrix, p)
        coordinates = stage.coordinates(face_crop(_sample(job)[0], matrix, PART_PX), here)
        rows.append(np.concatenate([coordinates, part.terms(here), np.ones(1, np.float32)]))
        steps.append((applied(matrix, t) - here).ravel())
    return np.array(rows), np.array(steps, np.float32)


def _stepped(part: PartCascade, points: Floats, steps: Floats) -> Floats:
    """Points (n, k, 2) px after steps (n, 2 k) in the crops of the part."""
    out = []
    for p, step in zip(points, steps, strict=True):
        matrix = similarity_onto(p, part.shape)
        out.append(applied(inverse(matrix), applied(matrix, p) + step.reshape(-1, 2)))
    return np.array(out)


def _eyes(landmarks: Floats) -> Floats:
    return np.linalg.norm(landmarks[:, 36] - landmarks[:, 45], axis=1)


def _error(points: Floats, truth: Floats, eyes: Floats) -> float:
    return float(np.median(np.linalg.norm(points - truth, axis=2).mean(axis=1) / np.maximum(eyes, 1)))
