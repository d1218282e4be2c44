"""Eye landmarks onto the lids that the picture shows (Pan et al. 2024, section 3.2.1).

Constants were chosen on the seven examples and 15 caricatures (``benchmarks/snapping.py``).
"""

from __future__ import annotations

from typing import Literal, get_args

import numpy as np
from numpy.typing import ArrayLike

from toongeo.arrays import Floats
from toongeo.geometry.polyline import arc_shares, interpolated
from toongeo.model.ibug68 import LID_RIMS
from toongeo.pipeline.fit.ibug_landmarks import ibug_landmarks
from toongeo.pipeline.parse.lids.eye_boundary import EyeBoundary, eye_boundary
from toongeo.pipeline.parse.lids.lid_patch import EYES_APART
from toongeo.protocols import FaceLabel, FaceParse

__all__ = ["snap_eyes"]

_Mode = Literal["arc", "nearest"]

# The lids of each eye run from the viewer's left to the right, so that the upper one is on the left hand.
_EYES = tuple(
    (label, np.array(LID_RIMS[f"lid_upper_{side}"]), np.array(LID_RIMS[f"lid_lower_{side}"]))
    for side, label in (("right", FaceLabel.EYE_RIGHT), ("left", FaceLabel.EYE_LEFT))
)
_CONFIDENCE = 0.2  # least mean confidence of an eye
_FARTHEST = 0.3  # outer-eye distances that its middle may be off
_WIDTHS, _RAGGED = (0.4, 5.0), 1.3  # of the landmarks' width; longest outline, in those of its convex hull


def snap_eyes(landmarks: ArrayLike, parse: FaceParse, *, mode: _Mode = "arc", scheme: str = "ibug68") -> Floats:
    """Move each eye landmark to the boundary of the segmented eye, if there is one.

    An eye stays as it is where the segmentation does not look like it: too far away, too small or large, ragged, or
    not to be believed; or if its lids would cross.

    Parameters
    ----------
    landmarks : (68, 2) array_like, px
        iBUG-68 order; a NaN row is a missing point.
    parse : FaceParse
        Of the picture.
    mode : {"arc", "nearest"}
        ``"nearest"`` takes the nearest boundary point, as the paper does; of eyes that are too small, both ends of a
        lid then land on its middle. ``"arc"`` finds the corners of the segmented eye first, and gives each point the
        place on the upper or lower boundary, by arc length, that it had on its lid. An eye with missing points is
        snapped by ``"nearest"``.
    scheme : str
        What the landmarks are: see :func:`toongeo.ibug_landmarks`.

    Returns
    -------
    (68, 2) float64, px
        Rows other than 36-47 are untouched.

    Raises
    ------
    ValueError
        If the landmarks are not 68 points, all are missing, or the mode is not known.

    Examples
    --------
    >>> from toongeo import parse_face, read_image, read_landmarks
    >>> from toongeo.model import data_path
    >>> img = read_image(data_path("examples/portraits/moustache_man.png"))
    >>> landmarks = read_landmarks(data_path("examples/portraits/moustache_man.pts"))
    >>> shifted = landmarks.copy()
    >>> shifted[36:42] += 10
    >>> snapped = snap_eyes(shifted, parse_face(img, shifted))
    >>> bool(abs(snapped - landmarks).max() < 5)
    True
    """
    points = ibug_landmarks(landmarks, scheme)
    if mode not in get_args(_Mode):
        raise ValueError(f"mode: expected one of {get_args(_Mode)}, got {mode!r}")
    unit = _outer_eye_distance(points)
    snapped = points.copy()
    for label, upper, lower in _EYES:
        rows = np.r_[upper, lower[1:-1]]
        known = rows[np.isfinite(points[rows, 0])]
        if not len(known):
            continue
        boundary = eye_boundary(parse, label, points[known].mean(axis=0))
        if boundary is None or not _plausible(boundary, points[known], unit):
            continue
        if mode == "nearest" or len(known) < len(rows):
            snapped[known] = _nearest(boundary.ring, points[known])
        else:
            lids = _along_lids(boundary, points[upper], points[lower])
            if lids is not None:
                snapped[upper], snapped[lower] = lids
    return snapped


def _outer_eye_distance(points: Floats) -> float:
    """Told from the middles of the eyes; without one of them, from the width of the other or of all points."""
    middles, widths = [], []
    for _, upper, lower in _EYES:
        eye = points[np.r_[upper, lower]]
        eye = eye[np.isfinite(eye[:, 0])]
        if len(eye):
            middles.append(eye.mean(axis=0))
            widths.append(np.ptp(eye, axis=0).max())
    if len(middles) == 2:
        return float(np.linalg.norm(middles[0] - middles[1])) / EYES_APART
    return 3.3 * max(widths, default=0.0)


def _plausible(boundary: EyeBoundary, known: Floats, unit: float) -> bool:
    width = np.ptp(known, axis=0).max()
    return bool(
        boundary.confidence >= _CONFIDENCE
        and boundary.raggedness <= _RAGGED
        and np.linalg.norm(boundary.middle - known.mean(axis=0)) <= _FARTHEST * unit
        and _WIDTHS[0] * width <= np.ptp(boundary.ring, axis=0).max() <= max(_WIDTHS[1] * width, 0.1 * unit)
    )


def _nearest(ring: Floats, points: Floats) -> Floats:
    """Nearest points (k, 2) of a closed polygon (n, 2)."""
    start, along = ring, np.roll(ring, -1, axis=0) - ring
    length = np.maximum((along**2).sum(axis=1), 1e-12)
    at = np.clip(((points[:, None] - start) * along).sum(axis=2) / length, 0.0, 1.0)
    foot = start + at[..., None] * along
    best = np.linalg.norm(points[:, None] - foot, axis=2).argmin(axis=1)
    return foot[np.arange(len(points)), best]


def _along_lids(boundary: EyeBoundary, upper: Floats, lower: Floats) -> tuple[Floats, Floats] | None:
    """The upper (4, 2) and lower (4, 2) lid on the boundary; None if they would cross there."""
    across = upper[-1] - upper[0]
    if np.linalg.norm(across) < 1e-9:
        return None
    across = across / np.linalg.norm(across)
    up = np.array([across[1], -across[0]])
    first, last = _corners(boundary, np.vstack([upper, lower[1:-1]]), across, up)
    if first == last:
        return None
    ring, n = boundary.ring, len(boundary.ring)
    ways = (
        ring[(first + np.arange((last - first) % n + 1)) % n],
        ring[(first - np.arange((first - last) % n + 1)) % n],
    )
    above, below = sorted(ways, key=lambda way: -float((way @ up).mean()))
    on_upper, on_lower = (_at_fractions(way, lid) for way, lid in ((above, upper), (below, lower)))
    if ((on_upper - on_lower)[1:-1] @ up < 0).any() or (np.diff(on_upper @ across) < 0).any():
        return None
    return on_upper, on_lower


def _corners(boundary: EyeBoundary, points: Floats, across: Floats, up: Floats) -> tuple[int, int]:
    """Samples of the ring that are the corners: those nearest to the landmarks, moved and stretched onto the eye."""
    axes = np.column_stack([across, up])
    placed = (points - points.mean(axis=0)) @ axes
    target = (boundary.ring - boundary.middle) @ axes
    stretch = np.ptp(target, axis=0) / np.maximum(np.ptp(placed, axis=0), 1e-9)
    centre = (target.max(axis=0) + target.min(axis=0) - stretch * (placed.max(axis=0) + placed.min(axis=0))) / 2
    ends = placed[[0, 3]] * stretch + centre
    first, last = (int(np.linalg.norm(target - end, axis=1).argmin()) for end in ends)
    return first, last


def _at_fractions(way: Floats, lid: Floats) -> Floats:
    """Points (k, 2) of a polyline at the arc lengths, as fractions, that the points of a lid (k, 2) have on it."""
    return interpolated(arc_shares(lid), arc_shares(way), way)
