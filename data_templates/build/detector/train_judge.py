"""Chances of faces and points, calibrated on renders and clutter that nothing else was trained on.

Points of faces that were met badly count like others: what matters is to tell them.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from detector.samples import Samples
from detector.workers import mapped
from toongeo.model.ibug68 import PARTS
from toongeo.pipeline.landmarks.search.detector_file import DetectorParts
from toongeo.pipeline.landmarks.search.face_judge import FaceJudge, point_cues
from toongeo.pipeline.landmarks.search.find_faces import candidate_faces
from toongeo.pipeline.landmarks.search.frames import applied, box_of, inverse
from toongeo.pipeline.landmarks.search.passes import face_patch, run_passes

__all__ = ["train_judge"]

_RIDGE = 1e-2
_STEPS = 40
_FOUND, _ASTRAY = 0.15, 0.35  # radii: mean error of a face that was found, and of one that was not
_THERE = 0.7  # radii between the middles of the points and of the face: it is this face, however badly placed
_WITHIN = 0.08  # of the outer-eye distance: a point in its place


def train_judge(
    samples: Samples, parts: DetectorParts, clutter: list[NDArray[np.uint8]], processes: int, say=print
) -> FaceJudge:
    """From held-out renders and clutter; `parts.judge` is not used."""
    global _SHARED
    _SHARED = samples, parts, clutter
    jobs = [("face", k) for k in range(len(samples.grey))] + [("clutter", k) for k in range(len(clutter))]
    results = mapped(_judged, jobs, processes, together=4)
    faces = [entry for part, _ in results for entry in part]
    cues, real = np.array([c for c, _ in faces]), np.array([r for _, r in faces], float)
    weight = np.where(real > 0, 1.0, 0.5 * real.sum() / max((1 - real).sum(), 1))
    face = _logistic_regression(cues, real, weight)
    right = ((cues @ face) > 0) == (real > 0)
    say(f"judge: {right[real > 0].mean():.3f} of faces, {right[real < 1].mean():.3f} of others are told", flush=True)
    found = [points for _, points in results if points is not None]
    rows, good = np.array([p[0] for p in found]), np.array([p[1] for p in found], float)
    tables = []
    for part in PARTS.values():
        mine = rows[:, part].reshape(-1, rows.shape[2])
        tables.append(_logistic_regression(mine, good[:, part].ravel(), np.ones(len(mine))))
    return FaceJudge(face, np.array(tables))


_SHARED: tuple = ()  # what forked processes inherit instead of receiving it


def _judged(job: tuple[str, int]):
    """Cues of candidates with whether each is the face, and for the face the cues of points with which are right."""
    samples, parts, clutter = _SHARED
    kind, k = job
    grey = samples.grey[k] if kind == "face" else clutter[k]
    candidates = candidate_faces(grey, parts)
    if kind == "clutter":
        return [(candidate.cues, False) for candidate in candidates], None
    truth = samples.landmarks[k]
    box, out, best = box_of(truth), [], None
    for candidate in candidates:
        error = np.linalg.norm(candidate.passes.points - truth, axis=1).mean() / box[2]
        if error < _FOUND:
            out.append((candidate.cues, True))
        elif error > _ASTRAY:
            out.append((candidate.cues, False))
        if np.hypot(*(box_of(candidate.passes.points)[:2] - box[:2])) < _THERE * box[2]:
            best = max((best or candidate, candidate), key=lambda one: one.cues[:2].sum())
    if best is None:
        return out, None
    patch = face_patch(grey, box_of(best.passes.points))
    start = applied(patch.matrix, best.passes.points)
    passes = run_passes(patch.grey, start, parts.cascade, photo=best.photo)
    error = np.linalg.norm(applied(inverse(patch.matrix), passes.points) - truth, axis=1)
    eyes = max(np.linalg.norm(truth[36] - truth[45]), 0.5 * box[2])
    return out, (point_cues(passes, best.cues), error < _WITHIN * eyes)


def _logistic_regression(rows: NDArray, aims: NDArray, weights: NDArray) -> NDArray[np.float64]:
    """Coefficients (d,) by Newton's method; a weak ridge in standardised units keeps separable data finite."""
    mean, deviation = rows.mean(axis=0), rows.std(axis=0)
    constant = deviation < 1e-12
    mean, deviation = np.where(constant, 0, mean), np.where(constant, 1, deviation)
    x, c = (rows - mean) / deviation, np.zeros(rows.shape[1])
    penalty = _RIDGE * weights.sum() * np.where(constant, 1e-6, 1) / 10
    for _ in range(_STEPS):
        p = 1 / (1 + np.exp(-np.clip(x @ c, -30, 30)))
        slope = x.T @ (weights * (p - aims)) + penalty * c
        bend = (x * (weights * p * (1 - p))[:, None]).T @ x + np.diag(penalty + 1e-9)
        c = c - np.linalg.solve(bend, slope)
    c = c / deviation
    c[np.flatnonzero(constant)[0]] -= mean @ c
    return c
