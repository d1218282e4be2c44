"""Where landmarks and a fitted face say that hair can be."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np

from toongeo.arrays import Floats, Singles
from toongeo.model.ibug68 import PARTS
from toongeo.pipeline.parse.lids.lid_patch import lid_unit
from toongeo.pipeline.parse.masks import Mask, filled, grown
from toongeo.pipeline.parse.working_view import WorkingView
from toongeo.protocols import FittedFace
from toongeo.render import rasterize

__all__ = ["HeadZones", "head_zones"]


_CORE = 0.04  # head sizes inside the jaw line and the brows, where there is face for sure
_CROWN = 0.3  # faces above the brows: there a head is scalp
_FEATURE = 0.1  # outer-eye distances around eyes, nose, mouth and brows that are not plain skin
_BROW = 0.06  # outer-eye distances: half the breadth of a brow


@dataclass(frozen=True, eq=False)
class HeadZones:
    """Masks (h, w) bool and coordinates (h, w) float32 of a working view.

    Attributes
    ----------
    skull : the fitted head without ears and neck
    ears : the fitted ears
    hull : within jaw and brows
    core : well within them
    plain : skin of the core: without eyes, brows, nose and mouth
    brow : bands along the brows
    crown : the skull well above the brows
    across : from the face's middle line, to the right of the picture, in faces (brows to chin)
    up : above the brows, in faces; the chin is at -1
    chin : (2,) px
    head : size of the head, px
    unit : distance of the outer eye corners, px
    """

    skull: Mask
    ears: Mask
    hull: Mask
    core: Mask
    plain: Mask
    brow: Mask
    crown: Mask
    across: Singles
    up: Singles
    chin: Floats
    head: float
    unit: float

    @property
    def high(self) -> Mask:
        """So far above the brows that a head is scalp."""
        return np.asarray(self.up > _CROWN)


def head_zones(view: WorkingView, landmarks: Floats, fit: FittedFace) -> HeadZones:
    """Zones of the landmarks (68, 2), px of the picture, none missing, and of a fitted face."""
    height, width = shape = view.pixels.shape[:2]
    points = view.place(landmarks)
    unit = lid_unit(points)
    px = view.place(fit.camera.project(fit.vertices))
    head = (fit.region("skin") | fit.region("scalp")) & ~fit.region("ears")
    skull, ears = (
        rasterize(px, fit.faces[part[fit.faces].all(axis=1)], height, width).mask for part in (head, fit.region("ears"))
    )
    brows = [points[PARTS["brow_right"]], points[PARTS["brow_left"]]]
    hull = filled(shape, np.vstack([points[PARTS["jaw"]], brows[1][::-1], brows[0][::-1]]))
    core = grown(hull, -_CORE * view.head)
    brow = np.zeros(shape, np.uint8)
    for line in brows:
        breadth = max(2, round(2 * _BROW * unit))
        cv2.polylines(brow, [np.rint(line * 16).astype(np.int32)], False, 1, breadth, shift=4)
    features = np.zeros(shape, bool)
    for ring in (PARTS["eye_right"], PARTS["eye_left"], range(48, 60), PARTS["brow_right"], PARTS["brow_left"]):
        features |= filled(shape, np.asarray(cv2.convexHull(points[list(ring)].astype(np.float32))[:, 0], np.float64))
    origin, chin = np.vstack(brows).mean(axis=0), points[PARTS["jaw"][8]]
    face = max(float(np.linalg.norm(origin - chin)), 1.0)
    axis = (origin - chin) / face
    y, x = np.mgrid[:height, :width]
    up = ((x - origin[0]) * axis[0] + (y - origin[1]) * axis[1]) / face
    across = (-(x - origin[0]) * axis[1] + (y - origin[1]) * axis[0]) / face
    return HeadZones(
        skull=skull,
        ears=ears & ~skull,
        hull=hull,
        core=core,
        plain=core & ~grown(features, _FEATURE * unit),
        brow=brow > 0,
        crown=skull & (up > _CROWN),
        across=across.astype(np.float32),
        up=up.astype(np.float32),
        chin=chin,
        head=view.head,
        unit=unit,
    )
