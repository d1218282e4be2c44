"""A picture in perspective as a parallel view of the same head would show it."""

from __future__ import annotations

from dataclasses import dataclass, replace

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import distance_transform_edt

from toongeo.arrays import Floats
from toongeo.pipeline.fit.face_fit import FaceFit
from toongeo.protocols import HeadCamera
from toongeo.render.camera import ScaledOrthographicCamera
from toongeo.render.interpolate import interpolate
from toongeo.render.perspective_camera import PerspectiveCamera
from toongeo.render.rasterize import rasterize

__all__ = ["ParallelView", "in_perspective", "parallel_view"]

_STEP = 2  # px of the depth that is rasterised: skin is smooth
_BLUR = 1.0  # of these: the depth leaps at its outline, and so would the picture


@dataclass(frozen=True, eq=False)
class ParallelView:
    """Picture (H, W, 3), confidence (H, W) or None and landmarks (68, 2) px, and the fit with its parallel camera."""

    img: NDArray[np.uint8]
    confidence: NDArray[np.float32] | None
    pixels: Floats
    fit: FaceFit


def parallel_view(
    img: NDArray[np.uint8], confidence: NDArray[np.float32] | None, pixels: Floats, fit: FaceFit
) -> ParallelView:
    """What a viewer far away would see along the same axis, where the head's origin looks as large as it does.

    A point at the distance d is seen ``d0 / d`` times as far from the principal point as in the parallel view, d0 the
    distance of the head's origin. Distances are those of the fit, and beyond its outline those of the nearest skin.
    """
    camera = fit.camera
    if not isinstance(camera, PerspectiveCamera):
        return ParallelView(img, confidence, pixels, fit)
    far = _far(camera)
    growth = _growth(camera, fit, far, img.shape[:2])
    centre = camera.principal_point
    y, x = np.indices(img.shape[:2], np.float64)
    at = [(c + (pixel - c) * growth).astype(np.float32) for c, pixel in zip(centre, (x, y), strict=True)]
    seen = cv2.remap(img, at[0], at[1], cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
    if confidence is not None:
        confidence = np.asarray(cv2.remap(confidence, at[0], at[1], cv2.INTER_LINEAR), np.float32)
    near = camera.depth(fit.vertices[fit.landmark_vertices]) / camera.translation[2]
    moved = centre + (pixels - centre) * near[:, None]
    return ParallelView(np.asarray(seen, np.uint8), confidence, moved, replace(fit, camera=far))


def in_perspective(camera: HeadCamera, of: HeadCamera) -> HeadCamera:
    """The camera with the lens of ``of`` that sees the head's origin where and as large as a parallel one does."""
    if not (isinstance(of, PerspectiveCamera) and isinstance(camera, ScaledOrthographicCamera)):
        return camera
    x, y = (camera.translation - of.principal_point) / camera.scale
    place = np.array([x, -y, -of.focal_px / camera.scale])
    return PerspectiveCamera(of.focal_px, camera.rotation, place, of.principal_point)


def _far(camera: PerspectiveCamera) -> ScaledOrthographicCamera:
    scale = camera.focal_px / -camera.translation[2]
    return ScaledOrthographicCamera(scale, camera.rotation, camera.project(np.zeros((1, 3)))[0])


def _growth(camera: PerspectiveCamera, fit: FaceFit, far: ScaledOrthographicCamera, shape: tuple[int, ...]) -> Floats:
    """d0 / d (H, W) of what a parallel view shows at each of its pixels."""
    height, width = (-(-side // _STEP) for side in shape)
    skin = fit.faces[fit.region("skin")[fit.faces].all(axis=1)]
    depth = camera.depth(fit.vertices)
    points = np.column_stack([(far.project(fit.vertices) + 0.5) / _STEP - 0.5, depth])
    fragments = rasterize(points, skin, height, width)
    growth = interpolate(fragments, skin, (camera.translation[2] / depth)[:, None])[:, :, 0]
    if not fragments.mask.any():
        return np.ones(shape)
    nearest = distance_transform_edt(~fragments.mask, return_distances=False, return_indices=True)
    spread = cv2.GaussianBlur(growth[tuple(nearest)], (0, 0), _BLUR)
    return np.asarray(cv2.resize(spread, shape[::-1], interpolation=cv2.INTER_LINEAR), np.float64)
