"""Where landmarks and a fitted face say that the parts of a head are.

Constants were chosen by eye on the seven examples and 15 caricatures.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np

from toongeo.arrays import Floats, Mask
from toongeo.model.ibug68 import LIP_RIMS, PARTS
from toongeo.pipeline.parse.lids.lid_patch import lid_unit
from toongeo.pipeline.parse.masks import filled, grown
from toongeo.pipeline.parse.working_view import WorkingView
from toongeo.protocols import FittedFace
from toongeo.render import rasterize

__all__ = ["FaceZones", "face_zones"]

_BROW = 0.07  # outer-eye distances: half the breadth in which a brow's hair is looked for
_LEAST = 1.5  # px; thinner brows are not resolved
_NOSE_WINGS = 0.3  # of the breadth between the points of the wings: how much broader the nose is


@dataclass(frozen=True, eq=False)
class FaceZones:
    """Masks (h, w) bool in a working view.

    Attributes
    ----------
    hull : within jaw and brows
    silhouette : hull, and the fitted head without its neck
    ears, neck : where those of the fitted head are seen
    brow_left, brow_right : bands along the brows
    eyes : the given eyes and what is around them
    nose : between root, wings and base
    upper_lip, lower_lip, inner_mouth : between the lips' rims
    lower_face : below the nose
    below_chin : beyond the chin, where neck and clothes are
    """

    hull: Mask
    silhouette: Mask
    ears: Mask
    neck: Mask
    brow_left: Mask
    brow_right: Mask
    eyes: Mask
    nose: Mask
    upper_lip: Mask
    lower_lip: Mask
    inner_mouth: Mask
    lower_face: Mask
    below_chin: Mask


def face_zones(view: WorkingView, landmarks: Floats, fit: FittedFace) -> FaceZones:
    """Zones of the landmarks (68, 2), px of the picture, none missing, and of a fitted face."""
    shape = view.pixels.shape[:2]
    points = view.place(landmarks)
    unit = lid_unit(points)
    hull = filled(
        shape, np.vstack([points[PARTS["jaw"]], points[PARTS["brow_left"]][::-1], points[PARTS["brow_right"]][::-1]])
    )
    seen = _seen_regions(view, fit)
    rims = {name: points[list(rim)] for name, rim in LIP_RIMS.items()}
    inner = filled(shape, _between(rims["lip_upper_inner"], rims["lip_lower_inner"]))
    upper = filled(shape, _between(rims["lip_upper_outer"], rims["lip_upper_inner"])) & ~inner
    lower = filled(shape, _between(rims["lip_lower_outer"], rims["lip_lower_inner"])) & ~inner & ~upper
    eyes = np.zeros(shape, bool)
    for side in ("right", "left"):
        eyes |= grown(filled(shape, points[PARTS[f"eye_{side}"]]), 0.1 * unit)
    down = points[PARTS["jaw"][8]] - points[PARTS["nose"][0]]
    return FaceZones(
        hull=hull,
        silhouette=hull | seen["skin"],
        ears=seen["ears"],
        neck=seen["neck"],
        brow_left=_band(shape, points[PARTS["brow_left"]], _BROW * unit),
        brow_right=_band(shape, points[PARTS["brow_right"]], _BROW * unit),
        eyes=eyes,
        nose=filled(shape, _nose(points)),
        upper_lip=upper,
        lower_lip=lower,
        inner_mouth=inner,
        lower_face=_beyond(shape, points[PARTS["nose"][3]], down),
        below_chin=_beyond(shape, points[PARTS["jaw"][8]], down),
    )


def _seen_regions(view: WorkingView, fit: FittedFace) -> dict[str, Mask]:
    """Where the regions of the fitted head are in front."""
    px = view.place(fit.camera.project(fit.vertices))
    depth = fit.camera.depth(fit.vertices)
    height, width = view.pixels.shape[:2]
    ids = rasterize(np.column_stack([px, depth]), fit.faces, height, width).face_ids
    seen = {}
    for name in ("skin", "ears", "neck"):
        inside = np.append(fit.region(name)[fit.faces].all(axis=1), False)  # row -1 is no face
        seen[name] = inside[ids]
    seen["skin"] |= np.append(fit.region("face")[fit.faces].any(axis=1), False)[ids]
    return seen


def _between(first: Floats, second: Floats) -> Floats:
    return np.vstack([first, second[::-1]])


def _nose(points: Floats) -> Floats:
    nose = points[PARTS["nose"]]
    root, wings = nose[0], nose[[4, 8]]
    middle = wings.mean(axis=0)
    right, left = middle + (1 + _NOSE_WINGS) * (wings - middle)
    across = 0.3 * (left - right)
    return np.array([root - across, right, *nose[5:8], left, root + across])


def _band(shape: tuple[int, int], line: Floats, radius: float) -> Mask:
    mask = np.zeros(shape, np.uint8)
    thickness = max(1, round(2 * max(radius, _LEAST)))
    cv2.polylines(mask, [np.rint(line * 16).astype(np.int32)], False, 1, thickness, shift=4)
    return mask.astype(bool)


def _beyond(shape: tuple[int, int], start: Floats, direction: Floats) -> Mask:
    """Pixels on the far side of the line through a point across a direction."""
    y, x = np.mgrid[: shape[0], : shape[1]]
    return (x - start[0]) * direction[0] + (y - start[1]) * direction[1] > 0
