"""The face of a fit as its light and albedo paint it."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toongeo.geometry.operators.vertex_normals import vertex_normals
from toongeo.pipeline.fit.face_fit import FaceFit
from toongeo.render.paint_table import Shading
from toongeo.render.render_mesh import render_mesh
from toongeo.render.surface import Surface

__all__ = ["face_surface", "rendered_picture"]


def rendered_picture(
    fit: FaceFit, shape: tuple[int, ...], *, background: ArrayLike = (0.5, 0.5, 0.5), lit: bool = True
) -> NDArray[np.uint8]:
    """The front of the face, albedo times light, where it lies in its picture.

    Parameters
    ----------
    fit : FaceFit
        From `photometric_fit`.
    shape : (H, W) or (H, W, 3)
        Of the picture.
    background : array_like, shape (3,), or a uint8 picture of the same shape
        sRGB, 0..1.
    lit : bool
        False leaves the light out and shows the albedo.

    Returns
    -------
    ndarray of uint8, shape (H, W, 3)

    Raises
    ------
    ValueError
        If the fit has no albedo and light.

    Examples
    --------
    >>> import toongeo as tg
    >>> from toongeo.model import data_path
    >>> img = tg.read_image(data_path("examples/portraits/astronaut.png"))
    >>> landmarks = tg.read_landmarks(data_path("examples/portraits/astronaut.pts"))
    >>> fit = tg.photometric_fit(img, tg.fit_3dmm(None, landmarks), landmarks)
    >>> tg.rendered_picture(fit, img.shape).shape
    (512, 512, 3)
    """
    size = (int(shape[0]), int(shape[1]))
    shading: Shading = "lit" if lit else "unlit"
    return render_mesh(face_surface(fit), fit.camera, size, light=fit.light, background=background, shading=shading)


def face_surface(fit: FaceFit) -> Surface:
    """Front skin of a fit in the colours of its albedo (Pan et al. 2024, Eq. 2).

    Raises
    ------
    ValueError
        If the fit has no albedo and light.
    """
    if fit.albedo is None or fit.light is None:
        raise ValueError("fit: expected one with albedo and light, as photometric_fit gives, got landmarks only")
    model = fit.model
    colours = model.albedo_mean + np.tensordot(fit.albedo, model.albedo, 1)
    faces = model.faces[model.region("face")[model.faces].all(axis=1)]
    # Normals of the whole mesh: those of the cut-out face would be wrong along its border.
    whole = vertex_normals(fit.vertices, model.faces)
    return Surface(fit.vertices, faces, colours=np.clip(colours, 0.0, 1.0), normals=whole)
