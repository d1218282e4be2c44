"""Weights of a performer before a camera."""

from __future__ import annotations

import numpy as np

from toongeo.arrays import Bytes, Floats
from toongeo.driving.landmark_rig import PerformerFace
from toongeo.driving.one_euro_filter import OneEuroFilter
from toongeo.driving.picture.skin_reader import SkinReader
from toongeo.model.expression_schemes import EXPRESSIONS
from toongeo.pipeline import LandmarkTracker
from toongeo.protocols import LandmarkDetector

__all__ = ["LiveVideo"]

_LOOKED = 8  # frames of the neutral face; their median is steadier than any
_NOISE = 0.01  # s.d. of a weight of a still face
_STEPS = (2, 2)  # of the reading: half of what a film gets, from a frame that is near


class LiveVideo:
    """Reads the expression of a performer off frames that come one by one.

    At first the performer looks into the camera without expression; the face that is seen in the first frames is the
    neutral one. :meth:`restart` begins anew.

    Parameters
    ----------
    detector : LandmarkDetector, optional
        What finds the face; :func:`toongeo.detect_faces` unless another is given.

    Examples
    --------
    >>> from toongeo.io import read_image
    >>> from toongeo.model import data_path
    >>> live = LiveVideo()
    >>> frame = read_image(data_path("examples/portraits/moustache_man.png"))
    >>> live(frame, 0.0).shape, live.is_ready
    ((54,), False)
    """

    names = EXPRESSIONS

    def __init__(self, detector: LandmarkDetector | None = None) -> None:
        self._tracker = LandmarkTracker(detector)
        self.restart()

    def restart(self) -> None:
        """Take the face in the next frames for neutral."""
        self._neutral: list[Floats] = []
        self._reader: SkinReader | None = None
        self._filter = OneEuroFilter(_NOISE)
        self._weights = np.zeros(len(EXPRESSIONS))

    @property
    def is_ready(self) -> bool:
        """Whether the neutral face is known; weights are 0 before."""
        return self._reader is not None

    def __call__(self, frame: Bytes, time: float) -> Floats:
        """Weights (54,) in [0, 1] of the expressions ``names``.

        While the face is lost the last ones are held. The frame that completes the neutral face takes two seconds.

        Parameters
        ----------
        frame : (H, W, 3) uint8 RGB
            Of the same size as the ones before.
        time : float, s
            Later than that of the frame before.

        Raises
        ------
        ValueError
            As of :meth:`toongeo.LandmarkTracker.track`.
        """
        face = self._tracker.track(frame, time)
        if face.lost:
            if self._reader is not None:
                self._reader.lost()
        elif self._reader is not None:
            pose = self._reader(frame, face.points, steps=_STEPS)
            smooth = self._filter(pose.weights[:, None], time)[:, 0]
            self._weights = self._reader.skin.rig.all_weights(smooth[None])[0]
        else:
            self._neutral.append(face.points)
            if len(self._neutral) == _LOOKED:
                there = [_brought(points, face.points) for points in self._neutral]
                landmarks = np.median(there, axis=0)
                self._reader = SkinReader(PerformerFace.of_neutral(landmarks), frame, landmarks)
        return self._weights


def _brought(points: Floats, targets: Floats) -> Floats:
    """Points (68, 2) moved, turned and scaled in the plane as near to others as can be."""
    p, t = points @ (1, 1j), targets @ (1, 1j)
    centre = p - p.mean()
    z = np.vdot(centre, t) / np.vdot(centre, centre).real * centre + t.mean()
    return np.column_stack([z.real, z.imag])
