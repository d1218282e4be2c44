"""Picture in, faces with their points out."""

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from toongeo.model.ibug68 import INNER
from toongeo.pipeline.landmarks.search.detector_file import DetectorParts
from toongeo.pipeline.landmarks.search.face_boxes import face_boxes
from toongeo.pipeline.landmarks.search.face_crop import CROP_PX, RADIUS_PX
from toongeo.pipeline.landmarks.search.face_judge import face_cues, point_cues
from toongeo.pipeline.landmarks.search.flat_look import flat_look
from toongeo.pipeline.landmarks.search.frames import applied, box_matrix, box_of, composed, inverse
from toongeo.pipeline.landmarks.search.passes import Passes, face_patch, run_passes
from toongeo.pipeline.landmarks.search.photo_share import photo_share

__all__ = ["Candidate", "FoundFace", "candidate_faces", "find_faces", "looks"]

_TILTS = (-35.0, 35.0)  # degrees, tried when no upright face is found
_BOXES = 14  # looked at
_ROUGH_STAGES = 2  # of the cascade, before the verifier looks for the first time
_KEPT = 4  # boxes that the whole cascade is run on, at least
_PLAIN = 0.5  # the sum of the first scores at which others are looked at too: there may be many faces
# Chances of a face: the least one, and that beside a sure face. Chosen on renders and on photographs without a face.
_FACE, _SURE, _BESIDE = 0.7, 0.9, 0.9
_PLACED = 0.6  # mean confidence of inner points; on strange renders hardly a face with less had its points within 8 %
_PLACED_BESIDE = 0.6  # of that of the face whose points are surest
_OVERLAP = 0.7  # radii between the middles of faces that cannot both be
_SAME = 0.15  # radii between the points of what would end as one face


@dataclass(frozen=True, eq=False)
class Candidate:
    """Points after passes from three starts, the cues of the face (6,), and its `photo_share`."""

    passes: Passes
    cues: NDArray[np.float64]
    photo: float


@dataclass(frozen=True, eq=False)
class FoundFace:
    """`points` (68, 2) px, their `confidence` (68,), and the chance that it is a face."""

    points: NDArray[np.float64]
    confidence: NDArray[np.float64]
    chance: float


@dataclass(frozen=True, eq=False)
class _Rough:
    """`points` (68, 2) px after the first stages, the score of the box, and that with the verifier's."""

    points: NDArray[np.float64]
    box_score: float
    score: float


def find_faces(grey: np.ndarray, parts: DetectorParts) -> list[FoundFace]:
    """Every face of a grey picture (h, w), the largest first."""
    found: list[tuple[float, Candidate]] = []
    for tilt in (0.0, *_TILTS):
        for rough in _rough_faces(grey, parts, tilt):
            if rough.score > _PLAIN or _best(found) < _SURE:
                candidate = _checked(grey, rough, parts)
                found.append((parts.judge.face_chance(candidate.cues), candidate))
        if _best(found) >= _SURE:
            break
    least = _BESIDE if _best(found) >= _SURE else _FACE
    kept: list[tuple[float, Candidate]] = []
    for chance, candidate in sorted(found, key=lambda entry: -entry[0]):
        if chance >= least and not any(_overlap(candidate, other) for _, other in kept):
            kept.append((chance, candidate))
    faces = [_finished(grey, candidate, chance, parts) for chance, candidate in kept]
    sure = [float(face.confidence[INNER].mean()) for face in faces]
    least_sure = max(_PLACED, _PLACED_BESIDE * max(sure, default=0.0))
    placed = [face for face, mean in zip(faces, sure, strict=True) if mean >= least_sure]
    return sorted(placed, key=lambda face: -box_of(face.points)[2])


def candidate_faces(grey: np.ndarray, parts: DetectorParts) -> list[Candidate]:
    """The likeliest upright faces of a picture."""
    return [_checked(grey, rough, parts) for rough in _rough_faces(grey, parts, 0.0)]


def _best(found: list[tuple[float, Candidate]]) -> float:
    return max((chance for chance, _ in found), default=0.0)


def _rough_faces(grey: np.ndarray, parts: DetectorParts, tilt: float) -> list[_Rough]:
    """Boxes after the first stages of the cascade, the likeliest first, each face once."""
    turn = np.array([[1.0, 0, 0], [0, 1, 0]])
    if tilt:
        turn = cv2.getRotationMatrix2D((grey.shape[1] / 2, grey.shape[0] / 2), tilt, 1.0)
    turned = cv2.warpAffine(grey, turn, grey.shape[::-1], borderMode=cv2.BORDER_REPLICATE) if tilt else grey
    every = []
    for box in face_boxes(turned, parts.boxes, _BOXES):
        middle = applied(inverse(turn), box[:2])
        patch = face_patch(grey, np.append(middle, box[2]))
        start = composed(composed(box_matrix(box, CROP_PX, RADIUS_PX), turn), inverse(patch.matrix))
        points = parts.cascade.rough(patch.grey, start, _ROUGH_STAGES)
        verified = parts.verifier.look(patch.grey, points, parts.cascade).face
        every.append(_Rough(applied(inverse(patch.matrix), points), float(box[3]), verified + float(box[3])))
    kept: list[_Rough] = []
    for rough in sorted(every, key=lambda entry: -entry.score):
        new = not any(_same(rough.points, other.points) for other in kept)
        if new and (len(kept) < _KEPT or rough.score > _PLAIN):
            kept.append(rough)
    return kept


def _checked(grey: np.ndarray, rough: _Rough, parts: DetectorParts) -> Candidate:
    patch = face_patch(grey, box_of(rough.points))
    passes = run_passes(patch.grey, applied(patch.matrix, rough.points), parts.cascade, first_look=True)
    look = parts.verifier.look(patch.grey, passes.points, parts.cascade)
    back = Passes(applied(inverse(patch.matrix), passes.points), passes.spread)
    flat = flat_look(patch.grey, passes.points, parts.cascade.shape)
    return Candidate(back, face_cues(look.face, rough.box_score, flat, passes), photo_share(flat, look.figure))


def _finished(grey: np.ndarray, candidate: Candidate, chance: float, parts: DetectorParts) -> FoundFace:
    """All passes, from where the first ones ended."""
    points = candidate.passes.points
    patch = face_patch(grey, box_of(points))
    passes = run_passes(patch.grey, applied(patch.matrix, points), parts.cascade, photo=candidate.photo)
    confidence = parts.judge.point_chances(point_cues(passes, candidate.cues))
    return FoundFace(applied(inverse(patch.matrix), passes.points), confidence, chance)


def _overlap(one: Candidate, other: Candidate) -> bool:
    a, b = box_of(one.passes.points), box_of(other.passes.points)
    return bool(np.hypot(*(a[:2] - b[:2])) < _OVERLAP * max(a[2], b[2]))


def _same(points: NDArray[np.float64], other: NDArray[np.float64]) -> bool:
    radius = box_of(other)[2]
    return bool(np.linalg.norm(points - other, axis=1).mean() < _SAME * radius)


def looks(grey: np.ndarray, points: NDArray[np.float64], parts: DetectorParts) -> tuple[float, float]:
    """How flat the face at points (68, 2) px is (see `flat_look`), and how much like a figure (see `FaceLook`)."""
    patch = face_patch(grey, box_of(points))
    points = applied(patch.matrix, points)
    flat = flat_look(patch.grey, points, parts.cascade.shape)
    return flat, parts.verifier.look(patch.grey, points, parts.cascade).figure
