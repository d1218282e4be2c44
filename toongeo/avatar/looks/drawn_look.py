"""Whether an avatar comes from a drawing."""

from __future__ import annotations

import cv2
import numpy as np

from toongeo.avatar.stages import AvatarStages
from toongeo.model import atlas_coordinates
from toongeo.render import ScaledOrthographicCamera, interpolate, rasterize, sample_image, uv_to_px

__all__ = ["drawn_look", "flatness"]

_SIZE = 160  # px: at which outlines of a pixel or two remain, and grain of paper and camera does not
_LINES = 0.1  # of the pixels: about what outlines and features cover
# Midway between the three clean cartoons of the choosing pictures (0.87 and more) and the photographs and paintings
# among them (0.41 at most).
_FLAT = 0.64


def drawn_look(avatar: AvatarStages) -> bool:
    """Whether the skin of the texture is flat between lines, as in cartoons, and so has no light of its own to lose."""
    return flatness(avatar) > _FLAT


def flatness(avatar: AvatarStages) -> float:
    """The share in [0.1, 1] of all steps between neighbouring pixels that the strongest tenth of them holds.

    Of the face as it is seen from the front, without light and without hair: near 1 of clean lines between flat
    colours, a half of photographs.
    """
    model, vertices = avatar.face.model, avatar.rig.neutral
    faces = model.faces[model.region("face")[model.faces].all(axis=1)]
    shown = vertices[np.unique(faces)]
    low, high = shown.min(0), shown.max(0)
    camera = ScaledOrthographicCamera.look(size=_SIZE, centre=(low + high) / 2, extent=float((high - low)[:2].max()))
    points = np.column_stack([camera.project(vertices), camera.depth(vertices)])
    found = rasterize(points, model.faces, _SIZE, _SIZE, cull_back=True)
    atlas = atlas_coordinates(model)
    grey = cv2.cvtColor(avatar.texture, cv2.COLOR_RGB2GRAY)
    scale = max(1, round(grey.shape[0] / (2 * _SIZE)))
    grey = cv2.resize(grey, None, fx=1 / scale, fy=1 / scale, interpolation=cv2.INTER_AREA)
    texels = interpolate(found, atlas.uv_faces, uv_to_px(atlas.uv, *grey.shape)).reshape(-1, 2)
    picture = np.rint(sample_image(grey, texels)).reshape(_SIZE, _SIZE).astype(np.float32)
    inside = model.region("face")[model.faces].all(axis=1)[found.face_ids] & found.mask
    inside = cv2.erode(inside.astype(np.uint8), np.ones((5, 5), np.uint8)).astype(bool)
    across, down = (cv2.Sobel(picture, cv2.CV_32F, *order) for order in ((1, 0), (0, 1)))
    steps = np.sort((np.abs(across) + np.abs(down))[inside])
    total = float(steps.sum())
    return float(steps[-max(1, int(_LINES * len(steps))) :].sum()) / total if total else 1.0
