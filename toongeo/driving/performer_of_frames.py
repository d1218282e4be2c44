"""A performer's face from a take in which no frame is known to be neutral."""

import numpy as np

from toongeo.arrays import Floats
from toongeo.driving.landmark_rig import LandmarkRig
from toongeo.driving.landmarks.landmark_noise import FIRST_NOISE, doubt_of
from toongeo.driving.landmarks.landmark_pose import landmark_poses

__all__ = ["neutral_landmarks", "performer_of_frames"]

# Chosen on films of two examples (astronaut, moustache_man).
_CAUTION = 2.0  # for the first weights, of a face that is not quite known yet
_TURN = 15.0  # degrees of turning that are worth a weight of 1: a face seen from the front is known best
_FRAMES = 5  # that the neutral frame is the median of


def performer_of_frames(sequence: Floats) -> LandmarkRig:
    """The landmarks of a performer who is only known from a sequence (f, 68, 2) px, NaN where missing.

    A face is aligned to :func:`neutral_landmarks`.

    Raises
    ------
    ValueError
        If no frame has enough landmarks.
    """
    return LandmarkRig.of_neutral(neutral_landmarks(sequence)[0])


def neutral_landmarks(sequence: Floats) -> tuple[Floats, int]:
    """The landmarks (68, 2) px of a neutral face, and the frame in which it is seen so.

    A face with one identity and an expression a frame is fitted to a few frames; of the frames with the least
    expression by that face, seen most from the front, the median is taken for neutral. What a detector always puts in
    a wrong place becomes part of the face then, rather than of its expressions.

    Raises
    ------
    ValueError
        If no frame has enough landmarks.
    """
    rig = LandmarkRig.of_frames(sequence)
    poses = landmark_poses(rig, sequence, FIRST_NOISE)
    errors = np.array([pose.errors(x, rig) for pose, x in zip(poses, sequence, strict=True)])
    poses = landmark_poses(rig, sequence, doubt_of(errors, _CAUTION))
    there = np.asarray(np.isfinite(sequence).all(axis=2))
    turned = np.degrees(np.arccos(np.clip([pose.rotation[2, 2] for pose in poses], -1, 1)))
    expressed = np.array([pose.weights.sum() for pose in poses]) + turned / _TURN
    expressed[there.sum(axis=1) < there.sum(axis=1).max()] = np.inf
    order = np.argsort(expressed, kind="stable")[:_FRAMES]
    alike = [i for i in order if np.isfinite(expressed[i]) and (there[i] == there[order[0]]).all()]
    median = np.median([poses[i].head_frame(sequence[i], rig) for i in alike], axis=0)
    return poses[order[0]].picture(median, rig), int(order[0])
