"""Where the irises are in a picture.

Constants were chosen by eye; which of the seven examples and 15 caricatures were looked at was not written down.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from skimage.filters import threshold_otsu

from toongeo._brief_repr import brief_repr
from toongeo._read_only import read_only, restored
from toongeo.arrays import Singles
from toongeo.colour.cielab import cielab
from toongeo.io import check_image
from toongeo.pipeline.fit.ibug_landmarks import ibug_landmarks
from toongeo.pipeline.texture.eyes.iris_scores import VIEW, WIDTH, iris_scores, squared_cost
from toongeo.pipeline.texture.face_picture import EYE_LEFT, EYE_RIGHT, opening_mask

__all__ = ["Iris", "find_irises"]

_TOGETHER = 0.04, 0.12  # both eyes look alike: cost and s.d., in widths, of a difference of their places
_SHIFTS = range(-12, 13, 2)  # px of a view: differences that are tried
_COLOURED = 0.8  # how much colour speaks against sclera, against lightness
_FILLS = 0.2  # of the opening: an iris that leaves less than this of it fills the eye
_LEAST_OPEN = 0.2  # height over width of an opening that shows an iris
_CONTRAST = 0.25  # of both eyes in the mean, and half of it of each
_LEAST_WIDTH = 8.0  # px of the picture


@dataclass(frozen=True, eq=False)
class Iris:
    """An iris in a picture, as an upright ellipse.

    Attributes
    ----------
    centre : (2,) float64, px
    radii : (2,) float64, px
        Semi-axes across and down. Lids may hide parts of it.
    contrast : float in [0, 1]
        How much darker or more coloured it is than the white around it; 1 is as much as the eye has.
    """

    centre: np.ndarray
    radii: np.ndarray
    contrast: float

    __repr__ = brief_repr
    __setstate__ = restored

    def __post_init__(self) -> None:
        read_only(self, "centre", "radii")


def find_irises(img: np.ndarray, landmarks: np.ndarray, *, scheme: str = "ibug68") -> tuple[Iris | None, Iris | None]:
    """Left and right iris of a picture, by the contrast of iris and sclera.

    Each eye is taken to a view of one size, whose pixels between the lids are parted by how light and colourless they
    are. Ellipses are compared by the dark pixels that they hold and by the step of darkness along their rim (as the
    integro-differential operator of Daugman 1993 does), mildly held to the size of a person's iris. Both irises have
    one size, and lie alike in their eyes unless the picture clearly says otherwise. Large irises of drawings, up to
    those that fill the eye, and bright highlights inside are allowed for.

    Parameters
    ----------
    img : (H, W, 3) uint8 RGB
    landmarks : (68, 2) float, px
        Rows of an eye that are NaN give no iris.
    scheme : str
        What the landmarks are: see :func:`toongeo.ibug_landmarks`.

    Returns
    -------
    left, right : Iris or None
        None where the eye is shut or too small, or if the two do not stand out from the white around them.

    Raises
    ------
    ValueError
        If the picture is not (H, W, 3) uint8, or the landmarks not (68, 2).

    Examples
    --------
    >>> import toongeo as tg
    >>> from toongeo.model import data_path
    >>> img = tg.read_image(data_path("examples/portraits/moustache_man.png"))
    >>> landmarks = tg.read_landmarks(data_path("examples/portraits/moustache_man.pts"))
    >>> left, right = tg.find_irises(img, landmarks)
    >>> bool(left.centre[0] > right.centre[0])  # px; left is the subject's
    True
    """
    check_image(img)
    landmarks = ibug_landmarks(landmarks, scheme)
    views = [_view(img, landmarks, rims) for rims in (EYE_LEFT, EYE_RIGHT)]
    seen = [view for view in views if view is not None]
    if not seen:
        return None, None
    best, found = -np.inf, [_Place(0.0, 0.0, 0.0, 0.0)] * len(seen)
    darkness, openings = np.stack([view.dark for view in seen]), np.stack([view.opening for view in seen])
    for scores, size, aspect in iris_scores(darkness, openings):
        if sum(view.max() for view in scores) <= best:
            continue
        score, places = _best_places(scores)
        if score > best:
            best = score
            found = [_Place(x, y, size * WIDTH, size * WIDTH * aspect) for x, y in places]
    contrasts = [view.contrast(place) for view, place in zip(seen, found, strict=True)]
    if np.mean(contrasts) < _CONTRAST or min(contrasts) < _CONTRAST / 2:
        return None, None
    irises = iter([view.iris(place, contrast) for view, place, contrast in zip(seen, found, contrasts, strict=True)])
    left, right = (None if view is None else next(irises) for view in views)
    return left, right


@dataclass(frozen=True)
class _Place:
    x: float
    y: float
    a: float
    b: float


@dataclass(frozen=True, eq=False)
class _View:
    """An eye at one size: how dark its pixels are, in [-1, 1], which of them are seen, and where it lies."""

    dark: Singles
    opening: Singles
    corner: np.ndarray
    scale: float

    def contrast(self, place: _Place) -> float:
        """How much darker the opening is inside an ellipse; of one that fills it, how dark that is."""
        y, x = np.mgrid[:VIEW, :VIEW]
        inside = ((x - place.x) / place.a) ** 2 + ((y - place.y) / place.b) ** 2 < 1
        held, rest = self.opening * inside, self.opening * ~inside
        fills = rest.sum() < _FILLS * self.opening.sum()
        beside = -1.0 if fills else (self.dark * rest).sum() / rest.sum()
        return float(((self.dark * held).sum() / max(held.sum(), 1) - beside) / 2)

    def iris(self, place: _Place, contrast: float) -> Iris:
        centre = np.array([place.x, place.y]) / self.scale + self.corner
        return Iris(centre, np.array([place.a, place.b]) / self.scale, contrast)


def _view(img: np.ndarray, landmarks: np.ndarray, rims: tuple[tuple[int, ...], tuple[int, ...]]) -> _View | None:
    points = landmarks[np.unique(np.concatenate(rims))]
    if not np.isfinite(points).all():
        return None
    width, height = np.linalg.norm(landmarks[rims[0][-1]] - landmarks[rims[0][0]]), np.ptp(points[:, 1])
    if max(width, height) < _LEAST_WIDTH or height < _LEAST_OPEN * width:
        return None
    scale = WIDTH / max(width, height)
    corner = points.mean(0) - (VIEW - 1) / 2 / scale
    if scale < 1:
        img = cv2.GaussianBlur(img, (0, 0), 0.4 / scale)
    grid = np.arange(VIEW, dtype=np.float32) / np.float32(scale)
    x, y = np.meshgrid(grid + np.float32(corner[0]), grid + np.float32(corner[1]))
    crop = cv2.remap(img, x, y, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
    opening = opening_mask((landmarks - corner) * scale, rims, (VIEW, VIEW))
    if opening.sum() < 0.05 * WIDTH**2:
        return None
    return _View(_darkness(crop, opening), opening.astype(np.float32), corner, scale)


def _darkness(crop: np.ndarray, opening: np.ndarray) -> Singles:
    """How far each pixel of an opening is from the white of this eye, in [-1, 1]; 0 outside."""
    lab = cielab(crop)
    white = lab[..., 0] - _COLOURED * np.hypot(lab[..., 1], lab[..., 2])
    values = white[opening]
    low, high = np.percentile(values, [5, 97])
    spread = max(high - low, 1.0)
    threshold = threshold_otsu(values) if np.ptp(values) > 0 else low
    return np.asarray(np.where(opening, np.clip((threshold - white) / (spread / 4), -1, 1), 0), np.float32)


def _best_places(scores: list[Singles]) -> tuple[float, list[tuple[int, int]]]:
    """Best sum of scores and where (x, y) it is in each view; two places are drawn to each other."""
    if len(scores) == 1:
        y, x = np.unravel_index(scores[0].argmax(), scores[0].shape)
        return float(scores[0].max()), [(int(x), int(y))]
    # The best partner of every place, by a search along the rows and then along the columns.
    down, rows = _best_shift(scores[1], 0)
    across, columns = _best_shift(down, 1)
    total = scores[0] + across
    y, x = np.unravel_index(total.argmax(), total.shape)
    partner_x = columns[y, x]
    return float(total[y, x]), [(int(x), int(y)), (int(partner_x), int(rows[y, partner_x]))]


def _best_shift(scores: Singles, axis: int) -> tuple[Singles, np.ndarray]:
    """Best of ``scores - _TOGETHER (shift / deviation)^2`` over shifts along an axis, and the place it is from."""
    weight, deviation = _TOGETHER
    best, origin = np.full_like(scores, -np.inf), np.zeros(scores.shape, int)
    places = np.arange(VIEW).reshape((-1, 1) if axis == 0 else (1, -1))
    for shift in _SHIFTS:
        moved = np.roll(scores, -shift, axis) - np.float32(squared_cost(shift, weight, 0, deviation * WIDTH))
        from_ = places + shift
        better = (moved > best) & (from_ >= 0) & (from_ < VIEW)
        best = np.where(better, moved, best)
        origin = np.where(better, from_, origin)
    return best, origin
