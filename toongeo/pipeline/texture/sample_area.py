"""Area-filtered sampling of a picture."""

import cv2
import numpy as np

from toongeo.render import sample_image

__all__ = ["sample_area"]


def sample_area(img: np.ndarray, px: np.ndarray, footprint: np.ndarray) -> np.ndarray:
    """Values of a picture between its pixels, averaged over about ``footprint`` pixels.

    Bilinear in a pyramid of means over 2 x 2 pixels, and linear between its levels; where a sample covers a pixel or
    less, bilinear in the picture. A linear ramp is reproduced exactly away from the border.

    Parameters
    ----------
    img : (H, W) or (H, W, c), uint8 or float
    px : (k, 2) float
        x right, y down; integers are pixel centres. Outside, the nearest pixel of the border counts.
    footprint : (k,) float
        Side of the area of each sample, px.

    Returns
    -------
    (k,) or (k, c) float32 or float64

    Raises
    ------
    ValueError
        If there is not one positive footprint a sample.

    Examples
    --------
    >>> ramp = np.tile(np.arange(16.0), (16, 1))
    >>> sample_area(ramp, np.array([[7.25, 8.0]]), np.array([3.0]))
    array([7.25])
    """
    footprint = np.asarray(footprint, float)
    if footprint.shape != (len(px),) or not (footprint > 0).all():
        raise ValueError(f"footprint: expected {len(px)} positive numbers, got shape {footprint.shape}")
    values = sample_image(img, px)
    levels = np.log2(np.maximum(footprint, 1.0))
    step, scale, finest = 0, 1.0, values
    while True:
        step += 1
        rows = np.flatnonzero(levels > step - 1)
        if not len(rows) or min(img.shape[:2]) < 2:
            return values
        # An odd row or column is repeated, so that every level has exactly half the pixels.
        img = np.pad(img, [(0, img.shape[0] % 2), (0, img.shape[1] % 2)] + [(0, 0)] * (img.ndim - 2), mode="edge")
        img = cv2.resize(img.astype(finest.dtype), (img.shape[1] // 2, img.shape[0] // 2), interpolation=cv2.INTER_AREA)
        scale *= 0.5
        coarser = sample_image(img, (px[rows] + 0.5) * scale - 0.5)
        share = np.clip(levels[rows] - (step - 1), 0, 1).astype(finest.dtype)
        share = share.reshape(-1, *[1] * (values.ndim - 1))
        # Samples beyond this level are replaced altogether; those between are mixed with the finer level.
        values[rows] = (1 - share) * values[rows] + share * coarser
