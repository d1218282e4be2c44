"""Picture in, faces with their points out."""

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from toongeo.pipeline.landmarks.search.detector_file import DetectorParts
from toongeo.pipeline.landmarks.search.face_boxes import face_boxes
from toongeo.pipeline.landmarks.search.face_crop import CROP_PX, RADIUS_PX
from toongeo.pipeline.landmarks.search.face_judge import face_cues, point_cues
from toongeo.pipeline.landmarks.search.frames import applied, box_matrix, box_of, composed, inverse
from toongeo.pipeline.landmarks.search.passes import Passes, face_patch, run_passes

__all__ = ["Candidate", "FoundFace", "candidate_faces", "find_faces"]

_BOXES = 14  # looked at
_ROUGH_STAGES = 2  # of the cascade, before the verifier looks for the first time
_KEPT = 4  # boxes that the whole cascade is run on, at least
_PLAIN = 0.5  # the sum of the first scores at which others are kept too: there may be many faces
_TILTS = (-35.0, 35.0)  # degrees, tried when no upright face is found
_FACE = 0.5  # the least chance of a face
_SURE = 0.9  # a chance at which other tilts are not tried
_OVERLAP = 0.7  # radii between the middles of faces that cannot both be
_SAME = 0.15  # radii between the points of what would end as one face


@dataclass(frozen=True, eq=False)
class Candidate:
    """Points after passes from three starts, and the cues of the face (5,)."""

    passes: Passes
    cues: NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class FoundFace:
    """`points` (68, 2) px, their `confidence` (68,), and the chance that it is a face."""

    points: NDArray[np.float64]
    confidence: NDArray[np.float64]
    chance: float


def find_faces(grey: np.ndarray, parts: DetectorParts) -> list[FoundFace]:
    """Every face of a grey picture (h, w), the largest first."""
    found = candidate_faces(grey, parts)
    if max((parts.judge.face_chance(c.cues) for c in found), default=0.0) < _SURE:
        for tilt in _TILTS:
            found += candidate_faces(grey, parts, tilt)
    likely = [c for c in found if parts.judge.face_chance(c.cues) >= _FACE]
    likely.sort(key=lambda c: -parts.judge.face_chance(c.cues))
    kept: list[Candidate] = []
    for candidate in likely:
        if not any(_overlap(candidate, other) for other in kept):
            kept.append(candidate)
    faces = [_finished(grey, candidate, parts) for candidate in kept]
    return sorted(faces, key=lambda face: -box_of(face.points)[2])


def candidate_faces(grey: np.ndarray, parts: DetectorParts, tilt: float = 0.0) -> list[Candidate]:
    """The likeliest faces of a picture, searched after it was turned by `tilt` degrees."""
    turn = np.array([[1.0, 0, 0], [0, 1, 0]])
    if tilt:
        turn = cv2.getRotationMatrix2D((grey.shape[1] / 2, grey.shape[0] / 2), tilt, 1.0)
    turned = cv2.warpAffine(grey, turn, grey.shape[::-1], borderMode=cv2.BORDER_REPLICATE) if tilt else grey
    rough = []
    for box in face_boxes(turned, parts.boxes, _BOXES):
        middle = applied(inverse(turn), box[:2])
        patch = face_patch(grey, np.append(middle, box[2]))
        start = composed(composed(box_matrix(box, CROP_PX, RADIUS_PX), turn), inverse(patch.matrix))
        points = parts.cascade.rough(patch.grey, start, _ROUGH_STAGES)
        verified = parts.verifier.score(patch.grey, points, parts.cascade.shape)
        rough.append((verified + box[3], box[3], applied(inverse(patch.matrix), points)))
    rough.sort(key=lambda entry: -entry[0])
    kept: list[tuple[float, NDArray[np.float64]]] = []
    for score, box_score, points in rough:
        new = not any(_same(points, other) for _, other in kept)
        if new and (len(kept) < _KEPT or score > _PLAIN):
            kept.append((box_score, points))
    return [_checked(grey, points, box_score, parts) for box_score, points in kept]


def _checked(grey: np.ndarray, points: NDArray[np.float64], box_score: float, parts: DetectorParts) -> Candidate:
    patch = face_patch(grey, box_of(points))
    passes = run_passes(patch.grey, applied(patch.matrix, points), parts.cascade, first_look=True)
    verified = parts.verifier.score(patch.grey, passes.points, parts.cascade.shape)
    back = Passes(applied(inverse(patch.matrix), passes.points), passes.spread)
    return Candidate(back, face_cues(verified, box_score, passes))


def _finished(grey: np.ndarray, candidate: Candidate, parts: DetectorParts) -> FoundFace:
    """All passes, from where the first ones ended."""
    points = candidate.passes.points
    patch = face_patch(grey, box_of(points))
    passes = run_passes(patch.grey, applied(patch.matrix, points), parts.cascade)
    confidence = parts.judge.point_chances(point_cues(passes, candidate.cues))
    return FoundFace(applied(inverse(patch.matrix), passes.points), confidence, parts.judge.face_chance(candidate.cues))


def _overlap(one: Candidate, other: Candidate) -> bool:
    a, b = box_of(one.passes.points), box_of(other.passes.points)
    return bool(np.hypot(*(a[:2] - b[:2])) < _OVERLAP * max(a[2], b[2]))


def _same(points: NDArray[np.float64], other: NDArray[np.float64]) -> bool:
    radius = box_of(other)[2]
    return bool(np.linalg.norm(points - other, axis=1).mean() < _SAME * radius)
