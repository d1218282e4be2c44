"""Where the grey levels of a picture rise, and in which direction."""

import cv2
import numpy as np

__all__ = ["DIRECTIONS", "orientation_maps"]

DIRECTIONS = 8  # multiples of 45 degrees, from x (right) towards y (down)
_COS = np.float32(np.sqrt(0.5))  # of 45 degrees: a gradient counts for its two neighbours at most, as in a histogram
_SOBEL = 1 / 4  # of Sobel's sums, which are eight times the slope


def orientation_maps(grey: np.ndarray, cell: int, blur: float) -> tuple[np.ndarray, np.ndarray]:
    """Gradient strength by direction, averaged over cells: two arrays (h // cell, w // cell, 4) float32.

    A gradient g counts for the direction d with ``max(0, g.d - |g| cos 45) / (1 - cos 45)``: nearly the soft
    histogram of N. Dalal, B. Triggs (CVPR 2005) at a fraction of its cost.

    Parameters
    ----------
    grey : (h, w) uint8
    cell : int
        Side of a cell in px; h and w are its multiples.
    blur : float
        Standard deviation in px of the blur before.

    Returns
    -------
    (h // cell, w // cell, 4) float32, twice
        The directions 0, 45, 90, 135 degrees, and those opposite to them; twice the grey levels a px.

    Examples
    --------
    >>> ramp = np.tile(np.arange(0, 64, 2, dtype=np.uint8), (32, 1))
    >>> ahead, back = orientation_maps(ramp, 8, 0.8)
    >>> ahead[1, 1].round(3) + 0, back[1, 1].max()  # 2 grey levels a px to the right
    (array([4., 0., 0., 0.], dtype=float32), np.float32(0.0))
    """
    smooth = cv2.GaussianBlur(grey, (0, 0), blur)
    scale = _SOBEL / (1 - float(_COS))
    across = cv2.Sobel(smooth, cv2.CV_32F, 1, 0, scale=scale)
    down = cv2.Sobel(smooth, cv2.CV_32F, 0, 1, scale=scale)
    # cv2.magnitude would give other last bits for other addresses of its arrays.
    least = np.sqrt(across * across + down * down) * _COS
    along = (across, (across + down) * _COS, down, (down - across) * _COS)
    size = grey.shape[1] // cell, grey.shape[0] // cell

    def averaged(strength: np.ndarray) -> np.ndarray:
        np.maximum(strength, 0, out=strength)
        return cv2.resize(strength, size, interpolation=cv2.INTER_AREA)

    ahead = cv2.merge([averaged(a - least) for a in along])
    back = cv2.merge([averaged(-a - least) for a in along])
    return ahead, back
