"""The face upright and at one size, in colour."""

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from toongeo.arrays import Floats
from toongeo.colour.cielab import cielab
from toongeo.model.ibug68 import PARTS
from toongeo.pipeline.landmarks.search.detector_file import shipped_detector
from toongeo.pipeline.landmarks.search.face_crop import CROP_PX
from toongeo.pipeline.landmarks.search.frames import applied, composed, similarity_onto

__all__ = ["EYES", "UprightCrop", "upright_crop"]

EYES = PARTS["eye_right"], PARTS["eye_left"]
_OUTLINE = np.r_[PARTS["jaw"], PARTS["brow_left"][::-1], PARTS["brow_right"][::-1]]
_SPARED = 1.6  # around eyes, brows and lips, from their middles
_SHIFT = 4  # fractional bits of the corners of polygons


@dataclass(frozen=True, eq=False)
class UprightCrop:
    """`lab` (160, 160, 3) float32 CIELAB, and the points (68, 2) px there; the face has a radius of 38 px."""

    lab: NDArray[np.float32]
    points: Floats

    def inside(self, rows: NDArray[np.int64], grown: float = 1.0) -> NDArray[np.bool_]:
        """Mask (160, 160) of the polygon of some points, grown about their middle."""
        corners = self.points[rows]
        middle = corners.mean(0)
        mask = np.zeros(self.lab.shape[:2], np.uint8)
        polygon = np.rint((middle + grown * (corners - middle)) * (1 << _SHIFT)).astype(np.int32)
        cv2.fillPoly(mask, [polygon], [1], shift=_SHIFT)
        return mask.astype(bool)

    def face(self) -> NDArray[np.bool_]:
        """Mask (160, 160) of what lies between jaw and brows."""
        return self.inside(_OUTLINE)

    def lips(self) -> NDArray[np.bool_]:
        """Mask (160, 160) of the mouth to its outer rim."""
        return self.inside(PARTS["mouth"][:12])

    def skin(self) -> NDArray[np.bool_]:
        """Mask (160, 160) of the face without eyes, brows and lips."""
        spared = (*EYES, PARTS["brow_right"], PARTS["brow_left"], PARTS["mouth"][:12])
        return self.face() & ~np.any([self.inside(rows, _SPARED) for rows in spared], axis=0)


def upright_crop(img: NDArray[np.uint8], points: Floats) -> UprightCrop:
    """The face at points (68, 2) px, all of them known, turned upright by the similarity onto the mean face."""
    matrix = similarity_onto(points, shipped_detector().cascade.shape)
    shrunk = img
    scale = float(np.sqrt(abs(np.linalg.det(matrix[:, :2]))))
    if scale < 1:  # areas are averaged before anything is sampled
        size = [max(1, round(side * scale)) for side in img.shape[1::-1]]
        shrunk = np.asarray(cv2.resize(img, size, interpolation=cv2.INTER_AREA), np.uint8)
        sx, sy = img.shape[1] / size[0], img.shape[0] / size[1]
        matrix = composed(matrix, np.array([[sx, 0, (sx - 1) / 2], [0, sy, (sy - 1) / 2]]))
        points = (points + 0.5) / [sx, sy] - 0.5
    crop = cv2.warpAffine(shrunk, matrix, (CROP_PX, CROP_PX), flags=cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
    return UprightCrop(cielab(np.asarray(crop, np.uint8)), applied(matrix, points))
