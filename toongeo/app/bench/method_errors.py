"""Errors of the method and its rivals on one picture."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from toongeo.app.bench.eos_rival import EosRival
from toongeo.app.bench.face_crop import FaceCrop, face_crop
from toongeo.avatar.avatar import Avatar
from toongeo.avatar.make_avatar import make_avatar
from toongeo.metrics import landmark_distance, photometric_error
from toongeo.pipeline import AlignedFace, FaceFit, adjust_coefficients, fit_3dmm
from toongeo.pipeline.fit.rendered_picture import face_surface
from toongeo.protocols import Coefficients, HeadCamera
from toongeo.render import Surface, rasterize, render_mesh
from toongeo.render.paint_table import Shading

__all__ = ["ADJUSTED", "PHOTOMETRIC", "method_errors"]

PHOTOMETRIC = "photometric"
ADJUSTED = {"adjust exp": "expression", "adjust id+exp": "identity+expression"}


def method_errors(
    img: NDArray[np.uint8], landmarks: NDArray[np.float64], *, adjusted: bool, eos: EosRival | None = None
) -> dict[str, dict[str, float]]:
    """Landmark error by part, px of the 224 x 224 crop, and photometric error in it, of each method.

    "mean face" is posed only; "coarse" is the fit to landmarks and picture; "adjust exp" and "adjust id+exp" bend its
    coefficients onto the landmarks; "fine" is what `make_avatar` aligns and textures. All but the last are painted in
    albedo and light of the coarse fit. Colours are compared where a method draws the skin of the front; eos has none.

    Parameters
    ----------
    img : (H, W, 3) uint8 RGB
    landmarks : (68, 2) float, px
    adjusted : bool
        Whether the two adjusted faces are wanted.
    eos : EosRival, optional

    Returns
    -------
    dict of method to dict of column to float
        In the order of the tables; "photometric" is the last column.
    """
    # Without hair of its own, which would hide what the fit did.
    avatar = make_avatar(img, landmarks, photometric=True, hair=False)
    coarse, crop = avatar.fit, face_crop(img, landmarks)
    mean = fit_3dmm(None, landmarks, regressor=lambda _img, _points: Coefficients(), refine=False)
    assert coarse.albedo is not None
    fits = {
        "mean face": replace(mean, albedo=np.zeros_like(coarse.albedo), light=coarse.light),
        "coarse": coarse,
    }
    if adjusted:
        fits |= {name: adjust_coefficients(coarse, landmarks, how) for name, how in ADJUSTED.items()}
    errors = {name: _of_fit(fit, landmarks, crop) for name, fit in fits.items()}
    if eos is not None:
        height, width = img.shape[:2]
        found = landmark_distance(eos.landmarks(landmarks, (width, height)), landmarks)
        errors = {"eos": found | {PHOTOMETRIC: float("nan")}} | errors
    return errors | {"fine": _of_avatar(avatar, landmarks, crop)}


def _of_fit(fit: FaceFit, landmarks: NDArray[np.float64], crop: FaceCrop) -> dict[str, float]:
    drawn = _colour_error(face_surface(fit), crop.camera(fit.camera), crop, "lit", fit.light)
    return _landmark_errors(fit, landmarks) | {PHOTOMETRIC: drawn}


def _of_avatar(avatar: Avatar, landmarks: NDArray[np.float64], crop: FaceCrop) -> dict[str, float]:
    face, model = avatar.face, avatar.face.model
    front = model.region("face")[model.faces].all(axis=1)
    surface = Surface(
        face.vertices, model.faces[front], uv=model.uv, uv_faces=model.uv_faces[front], texture=avatar.texture
    )
    # The texture holds the light of the picture already.
    drawn = _colour_error(surface, crop.camera(avatar.face.camera), crop, "unlit", None)
    return _landmark_errors(face, landmarks) | {PHOTOMETRIC: drawn}


def _landmark_errors(face: FaceFit | AlignedFace, landmarks: NDArray[np.float64]) -> dict[str, float]:
    return landmark_distance(face.project(face.vertices[face.landmark_vertices]), landmarks)


def _colour_error(
    surface: Surface,
    camera: HeadCamera,
    crop: FaceCrop,
    shading: Shading,
    light: NDArray[np.float64] | None,
) -> float:
    size = len(crop.pixels)
    rendered = render_mesh(surface, camera, size, light=light, background=crop.pixels, shading=shading)
    points = np.column_stack([camera.project(surface.vertices), camera.depth(surface.vertices)])
    drawn = rasterize(points, surface.faces, size, size).mask
    return photometric_error(rendered, crop.pixels, drawn & crop.inside)
