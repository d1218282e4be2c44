"""Upper and lower lids and lips that keep their order where their landmarks touch or cross.

Constants were judged on the seven examples and 15 caricatures (``benchmarks/alignment.py``, ``benchmarks/lips.py``).
"""

import numpy as np

from toongeo.model import MorphableModel
from toongeo.model.anatomy.rims import rim_path
from toongeo.protocols import HeadCamera

__all__ = ["GAP_MM", "keep_rims_apart"]

_PAIRS = (
    ("lid_upper_right", "lid_lower_right"),
    ("lid_upper_left", "lid_lower_left"),
    ("lip_upper_inner", "lip_lower_inner"),
)
GAP_MM = 0.3  # at most asked for between rims, in the picture or else in depth
_SPREAD_MM = 8.0  # over which a shift in depth fades out along the rim


def keep_rims_apart(
    model: MorphableModel,
    camera: HeadCamera,
    V: np.ndarray,
    anchors: np.ndarray,
    targets_px: np.ndarray,
    given: np.ndarray,
) -> tuple[np.ndarray, np.ndarray]:
    """Targets of the anchors, with those that would bring a lower rim above its upper one set right.

    Anchors between the landmarks give way in the picture. Landmarks may not, so there the upper rim comes forward and
    the lower one goes back: the picture of a closed mouth or eye, whose points lie on each other, stays as it is.

    Parameters
    ----------
    model : MorphableModel
    camera : HeadCamera
    V : (n, 3) float, mm, model frame
        Where the vertices are before they are pulled, rims in order.
    anchors : (k,) int
    targets_px : (k, 2) float
    given : (k,) bool
        Whether the target of an anchor is a landmark.

    Returns
    -------
    targets_px : (k, 2) float64
    depth : (k,) float64, mm
    """
    px, depth = camera.project(V), camera.depth(V)
    start = px.copy()
    px[anchors] = targets_px
    free = np.zeros(len(V), bool)
    free[anchors[~given]] = True
    for upper_name, lower_name in _PAIRS:
        upper, lower = rim_path(model, upper_name), rim_path(model, lower_name)
        mm = np.sqrt((camera.jacobian(V[upper]) ** 2).mean() * 3)  # pixels
        along = px[upper[-1]] - px[upper[0]]
        along /= max(np.linalg.norm(along), 1e-9)
        up = np.array([-along[1], along[0]])
        up *= np.sign((start[upper].mean(0) - start[lower].mean(0)) @ up) or 1.0
        # No gap is asked for that was not there: towards the corners rims come together.
        sides = [
            (rim, other, sign, np.clip(sign * _height(start, rim, other, along, up), 0, GAP_MM * mm))
            for rim, other, sign in ((upper, lower, 1.0), (lower, upper, -1.0))
        ]
        for in_depth in (False, True):
            lacks = [np.maximum(gap - sign * _height(px, rim, other, along, up), 0) for rim, other, sign, gap in sides]
            for (rim, _, sign, _), lack in zip(sides, lacks, strict=True):
                inner = rim[1:-1]  # the corners belong to both
                if in_depth:
                    depth[inner] += sign * _spread(px[rim] @ along / mm, lack / mm)[1:-1]
                else:
                    px[inner] += (0.5 * sign * (lack * free[rim])[1:-1])[:, None] * up
    return px[anchors], depth[anchors]


def _height(px: np.ndarray, rim: np.ndarray, other: np.ndarray, along: np.ndarray, up: np.ndarray) -> np.ndarray:
    """How far, in px, each point of a rim is above the other rim at the same place along the opening."""
    order = np.argsort(px[other] @ along, kind="stable")
    return px[rim] @ up - np.interp(px[rim] @ along, (px[other] @ along)[order], (px[other] @ up)[order])


def _spread(place: np.ndarray, lack: np.ndarray) -> np.ndarray:
    """The least that is enough at each place (mm) along a rim and fades out around it."""
    return (lack * np.exp(-(((place[:, None] - place) / _SPREAD_MM) ** 2))).max(1)
