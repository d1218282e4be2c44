"""Weights and pose of a performer, frame by frame, from how the skin looks.

Constants were chosen as those of ``skin_samples``.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from toongeo.arrays import Bytes, Floats
from toongeo.driving.landmark_rig import PerformerFace
from toongeo.driving.landmarks.landmark_pose import LandmarkPose, landmark_pose
from toongeo.driving.picture.eye_aperture import eye_apertures
from toongeo.driving.picture.picture_pose import Steps, picture_error, picture_pose, slopes
from toongeo.driving.picture.skin_samples import FACE_PX, Grey, shrunken, skin_samples
from toongeo.geometry.one_thread import one_thread
from toongeo.geometry.scaled_orthographic_pose import scaled_orthographic_pose

__all__ = ["SkinReader"]

_NOISE = 0.02  # of landmarks that were found, in widths of the face: they only say where to start
_FEWEST = 200  # samples: of a face that hides most of its skin, or has no place in the frame, nothing can be read


class SkinReader:
    """Follows a performer of whom one frame is known in which the face is at rest.

    Each frame is compared with that one: errors do not add up. The landmarks of a frame, and the frame before it, say
    where to start.

    Parameters
    ----------
    face : PerformerFace
    frame : (H, W, 3) uint8 RGB
        At rest.
    landmarks : (68, 2) px
        In that frame, as the face was made from.

    Raises
    ------
    ValueError
        If the frame shows too little of the skin.
    """

    def __init__(self, face: PerformerFace, frame: Bytes, landmarks: Floats) -> None:
        rig = face.landmarks
        scale, rotation, translation = scaled_orthographic_pose(rig.neutral, landmarks)
        self._factor = FACE_PX / (scale * rig.width)
        at_rest = LandmarkPose(np.zeros(len(rig.names)), FACE_PX / rig.width, rotation, self.smaller(translation))
        self.skin = skin_samples(face, shrunken(frame, self._factor), at_rest)
        if len(self.skin.rest) < _FEWEST:
            raise ValueError(f"frame: expected {_FEWEST} places on the skin of a face, got {len(self.skin.rest)}")
        self._eyes = eye_apertures(rig, slopes(shrunken(frame, self._factor))[-1], at_rest)
        self._at_rest = at_rest, self.smaller(landmarks)
        self._pose = at_rest
        self._landmarks: Floats | None = None

    def smaller(self, px: Floats) -> Floats:
        """Places in a frame as places in the pictures that are compared."""
        return (px + 0.5) * self._factor - 0.5

    def larger(self, px: Floats) -> Floats:
        """The inverse of :meth:`smaller`."""
        return (px + 0.5) / self._factor - 0.5

    def __call__(self, frame: Bytes, landmarks: Floats, *, least: float = 0.0, steps: Steps = (4, 3)) -> LandmarkPose:
        """Pose (in the pictures that are compared) and weights in the next frame, where landmarks (68, 2) px were
        found; `least` and `steps` as of :func:`picture_pose`."""
        return self.read(self.grey(frame), landmarks, least=least, steps=steps)

    def grey(self, frame: Bytes) -> Grey:
        """A frame as it is compared: small enough to be kept."""
        return shrunken(frame, self._factor)

    def read(self, grey: Grey, landmarks: Floats, *, least: float = 0.0, steps: Steps = (4, 3)) -> LandmarkPose:
        """The same from a frame as of :meth:`grey`.

        How far the eyes are closed is told by what is seen between the lids; by the skin only where eye and lid look
        alike, as where the eyes are closed in the frame of the samples.
        """
        small = self.smaller(landmarks)
        with one_thread():
            levels = slopes(grey)
            start = min(self._starts(small), key=lambda pose: picture_error(self.skin, levels, pose))
            start, held = self._blinked(levels[-1], start)
            pose = picture_pose(self.skin, levels, start, least=least, steps=steps, held=held)
            self._pose = self._blinked(levels[-1], pose)[0]
        self._landmarks = small
        return self._pose

    def lost(self) -> None:
        """The next frame does not follow the last one."""
        self._landmarks = None

    def rest(self) -> None:
        """The next frame follows the one in which the face is at rest."""
        self._pose, self._landmarks = self._at_rest

    def _starts(self, landmarks: Floats) -> list[LandmarkPose]:
        """As the landmarks have it; and as the frame before had it, moved along with the landmarks."""
        rig, last = self.skin.rig, self._pose
        found = landmark_pose(rig, landmarks, np.clip(last.weights, 0, 1), _NOISE)
        if self._landmarks is None:
            return [found]
        shift = np.median(landmarks - self._landmarks, axis=0)
        return [
            replace(last, translation=last.translation + shift),
            replace(found, weights=last.weights),
            found,
        ]

    def _blinked(self, level: Grey, pose: LandmarkPose) -> tuple[LandmarkPose, list[int]]:
        """The pose with the eyes as far closed as they plainly look, and the weights that are known by that."""
        weights, known = pose.weights.copy(), []
        for eye in self._eyes:
            closed = eye.closed(level, pose)
            if closed is not None:
                known += [eye.blink, *(eye.rivals if closed > 0 else ())]
                weights[list(eye.rivals) if closed > 0 else []] = 0
                weights[eye.blink] = closed
        return replace(pose, weights=weights), known
