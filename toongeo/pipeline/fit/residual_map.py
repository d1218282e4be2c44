"""What a fit does not explain of its picture."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from toongeo.io.check_image import check_image
from toongeo.pipeline.fit.face_fit import FaceFit
from toongeo.pipeline.fit.rendered_picture import face_surface, rendered_picture
from toongeo.render.rasterize import rasterize

__all__ = ["residual_map"]


def residual_map(img: NDArray[np.uint8], fit: FaceFit) -> NDArray[np.float32]:
    """Rendering minus picture in sRGB, each 0..1.

    Parameters
    ----------
    img : (H, W, 3) uint8
    fit : FaceFit
        From `photometric_fit`.

    Returns
    -------
    ndarray of float32, shape (H, W, 3)
        NaN where no front skin of the face is.

    Raises
    ------
    ValueError
        If the picture is not (H, W, 3) uint8, or the fit has no albedo and light.

    Examples
    --------
    >>> import numpy as np
    >>> import toongeo as tg
    >>> from toongeo.model import data_path
    >>> img = tg.read_image(data_path("examples/portraits/astronaut.png"))
    >>> landmarks = tg.read_landmarks(data_path("examples/portraits/astronaut.pts"))
    >>> fit = tg.photometric_fit(img, tg.fit_3dmm(None, landmarks), landmarks)
    >>> bool(np.nanmean(abs(tg.residual_map(img, fit))) < 0.15)  # sRGB, 0..1
    True
    """
    check_image(img)
    surface = face_surface(fit)
    points = np.column_stack([fit.camera.project(surface.vertices), fit.camera.depth(surface.vertices)])
    covered = rasterize(points, surface.faces, *img.shape[:2]).mask
    difference = rendered_picture(fit, img.shape, background=img).astype(np.float32) - img
    difference /= 255.0
    difference[~covered] = np.nan
    return difference
