"""A performer's skin from a film in which a neutral frame is named or looked for.

Constants were chosen as those of ``skin_samples``.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterable

import numpy as np

from toongeo.arrays import Bytes, Floats
from toongeo.driving.landmark_rig import LandmarkRig, PerformerFace
from toongeo.driving.landmarks.landmark_pose import FEWEST, LandmarkPose
from toongeo.driving.performer_of_frames import neutral_landmarks
from toongeo.driving.picture.skin_reader import SkinReader

__all__ = ["is_seen", "reader_of_film"]

_LEAST = -1.0  # of a weight, in a face of which it is not yet known that it is at rest
_LOOKED_AT = 150  # frames at most: they are kept
_STEPS = (3, 2)  # of the first reading
_AGREED = 15  # frames that say where the landmarks of the neutral face are, those of the most similar pose


def reader_of_film(frames: Iterable[Bytes], sequence: Floats, neutral: int | None = None) -> SkinReader:
    """Compares all frames with one, and then with the one of them that shows the least expression, or is `neutral`.

    What landmarks (f, 68, 2) px take for the neutral frame is off by as much as the landmarks are. Read against it,
    weights go below 0 where a face is more at rest still. In the frame where their sum is least, the landmarks are the
    median of what its neighbours in pose say, their expression taken out: each frame's points miss in another way.

    Raises
    ------
    ValueError
        If no frame has enough landmarks, or the skin is not seen.
    """
    landmarks, at = neutral_landmarks(sequence) if neutral is None else (sequence[neutral], neutral)
    face = PerformerFace.of_neutral(landmarks)
    reader = SkinReader(face, _frame(frames, at), landmarks)
    chosen = set(np.linspace(0, len(sequence) - 1, _LOOKED_AT).round().astype(int)) | {at}
    greys = {k: reader.grey(frame) for k, frame in enumerate(frames) if k in chosen and is_seen(sequence[k])}
    poses = {}
    for way in (sorted(k for k in greys if k >= at), sorted((k for k in greys if k < at), reverse=True)):
        reader.rest()
        for k in way:
            poses[k] = reader.read(greys[k], sequence[k], least=_LEAST, steps=_STEPS)
    if neutral is None:
        at = min(poses, key=lambda k: float(poses[k].weights.sum()))
    found = {k: reader.smaller(sequence[k]) for k in poses}
    landmarks = reader.larger(_agreed(face.landmarks, poses, found, at))
    return SkinReader(PerformerFace.of_neutral(landmarks), _frame(frames, at), landmarks)


def is_seen(points: Floats) -> bool:
    """Whether a frame has landmarks (68, 2) enough."""
    return int(np.isfinite(points).all(axis=1).sum()) >= FEWEST


def _agreed(rig: LandmarkRig, poses: dict[int, LandmarkPose], found: dict[int, Floats], at: int) -> Floats:
    """Landmarks (68, 2) of one of the frames by what it and its neighbours in pose say."""
    turned = {k: float(np.trace(poses[at].rotation @ pose.rotation.T)) for k, pose in poses.items()}
    near = sorted(turned, key=lambda k: -turned[k])[:_AGREED]
    missed = np.nanmedian([poses[k].errors(found[k], rig) for k in near], axis=0) * rig.width
    posed = (np.tensordot(poses[at].weights, rig.deltas, 1) @ poses[at].rotation.T)[:, :2]
    return poses[at].picture(posed + missed, rig)


def _frame(frames: Iterable[Bytes], at: int) -> Bytes:
    return next(itertools.islice(frames, at, None))
