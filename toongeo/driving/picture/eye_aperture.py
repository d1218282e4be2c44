"""How far the lids are closed, from what is seen between them.

A blink is over in three frames and moves a lid by its whole height between two of them: steps from where the lid was
do not get there. What the eye would look like is therefore compared at every height of the lid at once. Constants were
chosen as those of ``skin_samples``.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from toongeo._read_only import read_only
from toongeo.arrays import Floats
from toongeo.driving.landmark_rig import LandmarkRig
from toongeo.driving.landmarks.landmark_pose import LandmarkPose
from toongeo.driving.picture.skin_samples import Grey, posed_px
from toongeo.geometry.polyline import arc_shares, interpolated
from toongeo.model.ibug68 import LID_RIMS
from toongeo.render import sample_image

__all__ = ["EyeAperture", "eye_apertures"]

_ALONG = np.linspace(0.12, 0.88, 13)  # of a lid: at its corners nothing opens
_STEP = 0.05  # of the opening, from lid to lid
_ABOVE, _BELOW = -0.4, 1.3  # of the opening: skin of the upper lid, and below the lower one
_DOWN = np.arange(_ABOVE, _BELOW + _STEP / 2, _STEP)
_OPEN = (_DOWN > -_STEP / 2) & (_DOWN < 1 + _STEP / 2)
_LID, _BELOW_LID = _DOWN < -0.1, _DOWN > 1.1
_LASHES = -0.2  # from here to the lid's edge it keeps its look; what is above is stretched
_DARKEST = 0.05  # contrasts, of skin
_HEIGHTS = np.linspace(0, 1, 26)  # weights of the blink that are compared
_SOFT = 0.06  # of the opening, over which the lid's edge is blurred
_OUTLIER = 1.5  # contrasts; a larger error counts no more
_PLAIN = 0.85  # of the error of an open eye: a blink that leaves more of it is not plain
_RIVALS = "eyeWide", "eyeSquint"
_CALM = 0.03  # contrasts that a closed eye must look better than an open one
_FAINT = 0.52  # contrasts between eye and lid: of seven faces open eyes have 0.87 and more, closed ones 0.2 to 0.88


@dataclass(frozen=True, eq=False)
class EyeAperture:
    """The place of an eye, as it looks at rest.

    Attributes
    ----------
    blink : int
        Which expression of the rig closes it.
    rivals : tuple of int
        Other expressions of the same eye, which cannot be told from a part of a blink.
    rest : (t, u, 3) float64, mm
        Places down from the skin of the upper lid to below the lower one, and along the lids.
    deltas : (t, u, 3, k) float64, mm
        What each expression adds, but for the blink itself and its rivals.
    closing : (u,) float64
        The share of the opening that the blink at weight 1 closes.
    greys : (t, u) float64
    """

    blink: int
    rivals: tuple[int, ...]
    rest: Floats
    deltas: Floats
    closing: Floats
    greys: Floats

    def __post_init__(self) -> None:
        read_only(self, "rest", "deltas", "closing", "greys")

    @property
    def is_told(self) -> bool:
        """Whether eye and lid look different enough."""
        lid = np.median(self.greys[_DOWN < 0], axis=0)
        return bool(np.abs(self.greys[_OPEN] - lid).mean() >= _FAINT)

    def closed(self, level: Grey, pose: LandmarkPose) -> float | None:
        """The weight in [0, 1] of the blink under which the eye looks most like this in a frame; None if it looks
        neither open nor closed.

        `level` are blurred grey values, the first of its channels; `pose` that of the face.
        """
        seen = _values(level, self.rest + self.deltas @ pose.weights, pose)
        error = np.minimum(np.abs(seen[_OPEN] - self._looks(seen)), _OUTLIER).mean(axis=(1, 2)) + _CALM * _HEIGHTS
        best = int(error.argmin())
        if best and error[best] > _PLAIN * error[0]:
            return None
        if not 0 < best < len(error) - 1:
            return float(_HEIGHTS[best])
        before, here, after = error[best - 1 : best + 2]
        bend = max(before - 2 * here + after, 1e-9)  # the lowest point of a parabola through three
        return float(_HEIGHTS[best] + _HEIGHTS[1] * np.clip((before - after) / bend / 2, -0.5, 0.5))

    def _looks(self, seen: Floats) -> Floats:
        """(h, t, u) What is seen between the lids at each height: the lid with its lashes, moved down; the eye.

        In the light of what is `seen` (t, u) above and below: a lid that closes turns towards it.
        """
        light = np.median(seen[_BELOW_LID]) / max(float(np.median(self.greys[_BELOW_LID])), _DARKEST)
        on_lid = np.median(seen[_LID], axis=0) / np.maximum(np.median(self.greys[_LID], axis=0), _DARKEST)
        edge = _HEIGHTS[:, None, None] * self.closing
        down = _DOWN[_OPEN][:, None]
        covered = 1 / (1 + np.exp(np.clip((down - edge) / _SOFT, -30, 30)))
        place = (np.clip(down - edge, _LASHES, 0) - _ABOVE) / _STEP
        row = np.minimum(place.astype(np.int64), len(_DOWN) - 2)
        share, column = place - row, np.arange(len(_ALONG))
        lid = (1 - share) * self.greys[row, column] + share * self.greys[row + 1, column]
        return on_lid * covered * lid + light * (1 - covered) * self.greys[_OPEN]


def eye_apertures(rig: LandmarkRig, level: Grey, pose: LandmarkPose) -> tuple[EyeAperture, ...]:
    """The eyes of a face whose lids can be told from them, from a frame in which it is at rest in a pose."""
    found = []
    for side, name in (("right", "eyeBlinkRight"), ("left", "eyeBlinkLeft")):
        if name not in rig.names:
            continue
        blink = rig.names.index(name)
        lids = [np.array(LID_RIMS[f"lid_{lid}_{side}"]) for lid in ("upper", "lower")]
        upper, lower = (_along(rig.neutral[rows], rig.neutral[rows]) for rows in lids)
        moved = [np.stack([_along(rig.neutral[rows], delta[rows]) for delta in rig.deltas], axis=-1) for rows in lids]
        height = np.maximum(upper[:, 1] - lower[:, 1], 1e-6)
        closing = np.clip((moved[1] - moved[0])[:, 1, blink] / height, 0, 1.3)
        deltas = _between(*moved)
        rivals = tuple(rig.names.index(f"{kind}{name[8:]}") for kind in _RIVALS if f"{kind}{name[8:]}" in rig.names)
        deltas[..., [blink, *rivals]] = 0
        rest = _between(upper, lower)
        eye = EyeAperture(blink, rivals, rest, deltas, closing, _values(level, rest, pose))
        if eye.is_told:
            found.append(eye)
    return tuple(found)


def _along(lid: Floats, values: Floats) -> Floats:
    """Values (4, 3) at the landmarks of a lid (4, 3), at places along it (u, 3)."""
    return interpolated(_ALONG, arc_shares(lid), values)


def _between(upper: Floats, lower: Floats) -> Floats:
    """(t, u, ...) from values at the upper lid (u, ...) to those at the lower one, and beyond."""
    down = _DOWN.reshape(-1, *[1] * upper.ndim)
    return upper + down * (lower - upper)


def _values(level: Grey, places: Floats, pose: LandmarkPose) -> Floats:
    return sample_image(level, posed_px(places.reshape(-1, 3), pose))[:, 0].reshape(places.shape[:2]).astype(np.float64)
