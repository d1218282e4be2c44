"""An avatar of a fitted face that was not aligned: the rival in pair sheets."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from toongeo.avatar.avatar import Avatar
from toongeo.avatar.report import AvatarReport, landmark_errors
from toongeo.metrics import mesh_quality
from toongeo.pipeline import (
    AlignedFace,
    AlignReport,
    FaceFit,
    aim_eyes,
    bake_eyes,
    bake_texture,
    build_rig,
    find_irises,
    fit_lids,
    fit_mouth,
)
from toongeo.protocols import FaceParse

__all__ = ["plain_avatar"]


def plain_avatar(
    img: NDArray[np.uint8], landmarks: NDArray[np.float64], fit: FaceFit, parse: FaceParse, *, texture_size: int = 1024
) -> Avatar:
    """Rig, eyes and texture as `make_avatar` makes them, on the face of a fit as it is.

    Parameters
    ----------
    img : (H, W, 3) uint8 RGB
    landmarks : (68, 2) float, px
    fit : FaceFit
        From `fit_3dmm` or `adjust_coefficients`.
    parse : FaceParse
        Of the same picture.
    texture_size : int
        Side of the atlas, texels.
    """
    face = AlignedFace(fit.vertices, fit.camera, fit.landmark_vertices, fit.model, fit, report=AlignReport())
    rig, eyes = fit_lids(face, fit_mouth(face, build_rig(face)))
    irises = find_irises(img, landmarks)
    eyes = aim_eyes(face, eyes, irises)
    texture = bake_texture(img, face, rig=rig, size=texture_size, parse=parse)
    texture = bake_eyes(img, face, eyes, texture, irises)
    errors = landmark_errors(fit, landmarks)
    quality = mesh_quality(face.vertices, face.faces[face.region("face")[face.faces].all(1)])
    report = AvatarReport(coarse=errors, aligned=errors, quality=quality, seconds={}, warnings=())
    return Avatar(fit=fit, parse=parse, face=face, rig=rig, eyes=eyes, texture=texture, report=report)
