"""The face of one frame of a video, from where it was in the frame before."""

import cv2
import numpy as np
from numpy.typing import NDArray

from toongeo.pipeline.landmarks.search.detector_file import DetectorParts
from toongeo.pipeline.landmarks.search.face_judge import face_cues, point_cues
from toongeo.pipeline.landmarks.search.find_faces import FoundFace
from toongeo.pipeline.landmarks.search.flat_look import flat_look
from toongeo.pipeline.landmarks.search.frames import applied, box_of, inverse, similarity_onto
from toongeo.pipeline.landmarks.search.passes import face_patch, run_passes
from toongeo.pipeline.landmarks.search.photo_share import photo_share

__all__ = ["flowed_points", "follow_face"]

_WINDOW_PX = 15  # of the flow, in a patch where the face has a radius of 45 px: about the size of an eye
_LEVELS = 3  # of the pyramid: a face may move by a quarter of its width between frames
_RETURN_PX = 1.0  # how far from where it began a point may come out when it is followed there and back
_FEWEST = 12  # points that the flow must have followed for its motion to count
_BOX_SCORE = 0.0  # a face that is followed comes from no box; this is at the margin of those that are found


def follow_face(
    grey: NDArray[np.uint8], start: NDArray[np.float64], parts: DetectorParts, *, thorough: bool = False
) -> FoundFace:
    """The face near points (68, 2) px of a grey picture (h, w), and the chance that there is one.

    Three passes of the cascade and one of its parts or, `thorough`, all ten as of a face that is found for the first
    time, which takes three times as long.
    """
    patch = face_patch(grey, box_of(start))
    passes = run_passes(patch.grey, applied(patch.matrix, start), parts.cascade, first_look=True)
    look = parts.verifier.look(patch.grey, passes.points, parts.cascade)
    flat = flat_look(patch.grey, passes.points, parts.cascade.shape)
    cues, photo = face_cues(look.face, _BOX_SCORE, flat, passes), photo_share(flat, look.figure)
    if thorough:
        passes = run_passes(patch.grey, passes.points, parts.cascade, photo=photo)
    points = passes.points if thorough else parts.cascade.refined(patch.grey, passes.points, photo)
    confidence = parts.judge.point_chances(point_cues(passes, cues))
    return FoundFace(applied(inverse(patch.matrix), points), confidence, parts.judge.face_chance(cues))


def flowed_points(
    before: NDArray[np.uint8], grey: NDArray[np.uint8], points: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Where points (68, 2) px of the picture before are in the next one, by optical flow.

    Points that the flow loses move as the face as a whole does; if it loses nearly all, none moves.
    """
    old, new = face_patch(before, box_of(points)), face_patch(grey, box_of(points))
    here = applied(old.matrix, points)
    there, found = _flow(old.grey, new.grey, here)
    back, found_back = _flow(new.grey, old.grey, there)
    sure = found & found_back & (np.linalg.norm(back - here, axis=1) < _RETURN_PX)
    if sure.sum() < _FEWEST:
        return points
    there = np.where(sure[:, None], there, applied(similarity_onto(here[sure], there[sure]), here))
    return applied(inverse(new.matrix), there)


def _flow(
    before: NDArray[np.uint8], grey: NDArray[np.uint8], points: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
    """Where points (k, 2) px went, and which of them (k,) could be followed."""
    start = points.astype(np.float32)[:, None]
    there, status, _ = cv2.calcOpticalFlowPyrLK(
        before, grey, start, start.copy(), winSize=(_WINDOW_PX, _WINDOW_PX), maxLevel=_LEVELS
    )
    return np.asarray(there, np.float64)[:, 0], np.asarray(status)[:, 0] == 1
