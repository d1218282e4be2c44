"""Which pixels are skin, by the landmarks and by colour."""

from dataclasses import dataclass

import cv2
import numpy as np

from toongeo.arrays import Floats, Mask, Singles
from toongeo.colour.min_cut import min_cut
from toongeo.pipeline.parse.guided_filter import guided_filter
from toongeo.pipeline.parse.masks import filled, grown
from toongeo.pipeline.stylize.appearance.head_light import HeadLight
from toongeo.pipeline.stylize.appearance.pixels import blurred, enlarged, reduced

__all__ = ["SkinRegion", "skin_region"]

_WORKING = 70.0  # px of the face in which the cut is made
# In face sizes: how far the jaw-brow hull is kept from its border and from features, and how far skin may reach from
# the fitted head and below it (the neck).
_INNER, _FEATURE, _NEAR, _NECK = 0.04, 0.05, 0.10, 0.45
_STRIP = 0.05  # above the brows: farther up, fringes would be learned as skin
_SOCKETS = 0.03  # around eyes and brows, which are drawn anew on skin
_HOLE = 0.015  # squares of face sizes: smaller holes are drawn over
_TINY = 0.02  # thinner bridges and specks are none
_BIN = (5.0, 4.0, 4.0)  # Lab, of the colour models
_EVIDENCE = 4.0  # bound of their log-odds
_PLACE, _FOREHEAD = 2.5, 1.5  # log-odds for what lies within the hull, and within the rest of the fitted face
_HAIR = 5.0  # log-odds against what is known to be hair
_SMOOTHNESS, _SURE = 3.0, 6.0  # of the cut
_ROUNDS = 3
# The skin's colour: deviations from its median count in these tolerances (Lab; at most, offset, times).
_MOST, _LEAST, _TIMES = (12.0, 6.0, 6.0), (4.0, 3.0, 3.0), (2.0, 1.6, 1.6)
_FEATURES = (range(36, 42), range(42, 48), range(48, 60), range(17, 22), range(22, 27))
_EYES_AND_BROWS = ((17, 18, 19, 20, 21, 39, 40, 41, 36), (22, 23, 24, 25, 26, 45, 46, 47, 42))


@dataclass(frozen=True, eq=False)
class SkinRegion:
    """Skin of the head.

    Attributes
    ----------
    drawn : (h, w) float32 in [0, 1]
        What is painted as skin, sockets and mouth included.
    seen : (h, w) float32 in [0, 1]
        What shows skin.
    hull : (h, w) float32 in [0, 1]
        Between jaw and brows.
    median, lit : (3,) float, CIELAB
        Of the face's skin, and of its lighter half.
    """

    drawn: Singles
    seen: Singles
    hull: Singles
    median: Singles
    lit: Singles


def skin_region(lab: Singles, landmarks: Floats, size: float, light: HeadLight, hair: Singles) -> SkinRegion:
    """Skin of a face: colours of its cheeks and nose, cut out where they end (graph cut, Boykov and Jolly 2001).

    Parameters
    ----------
    lab : (h, w, 3) float32
        The abstracted picture, CIELAB.
    landmarks : (68, 2) float, px
    size : float, px
        Of the face.
    light : HeadLight
        Where the fitted head and its face are.
    hair : (h, w) float32 in [0, 1]
        What is known to be hair or hat.
    """
    hull = _hull(lab.shape, landmarks)
    inner = _eroded(hull, _INNER * size)
    for feature in _FEATURES:
        inner &= ~grown(filled(lab.shape, cv2.convexHull(landmarks[list(feature)].astype(np.float32))[:, 0]), _FEATURE * size)
    inner &= hair < 0.5
    pixels = lab[inner] if inner.any() else lab[hull]
    median = np.median(pixels, axis=0)
    lit = np.median(pixels[pixels[:, 0] >= median[0]], axis=0)
    deviation = np.minimum(np.percentile(np.abs(pixels - median), 80, axis=0), _MOST)
    distance = (lab - median) / ((deviation + _LEAST) * _TIMES)
    likely = np.exp(-0.5 * np.square(distance).sum(axis=-1)).astype(np.float32)
    factor = min(1.0, _WORKING / size)
    small = [reduced(np.asarray(plane, np.float32), factor) for plane in (lab, likely, inner, hull, light.head, light.face, hair)]
    cut = _cut(*small, (landmarks + 0.5) * factor - 0.5, size * factor)
    soft = guided_filter(np.asarray(lab / 100, np.float32), enlarged(cut, lab.shape), max(2, round(0.03 * size)), 2e-3)
    soft = np.clip(blurred(soft, 0.006 * size), 0, 1)
    covered = _covered(lab.shape, landmarks, size)
    return SkinRegion(
        np.maximum(soft, covered), soft, blurred(hull.astype(np.float32), 0.01 * size), median.astype(np.float32), lit.astype(np.float32)
    )


def _cut(
    lab: Singles,
    likely: Singles,
    inner: Singles,
    hull: Singles,
    head: Singles,
    face: Singles,
    hair: Singles,
    landmarks: Floats,
    size: float,
) -> Singles:
    """Skin (h, w) of 0 and 1 in a small picture."""
    low = np.maximum(head, hull) > 0.5
    chin = np.arange(len(lab))[:, None] > landmarks[8, 1]
    body = np.zeros((2 * round(_NECK * size) + 1, 1), np.uint8)
    body[: round(_NECK * size) + 1] = 1
    neck = cv2.dilate((low & chin).astype(np.uint8), body) > 0
    low |= neck
    near, far = grown(low, _INNER * size), ~grown(low, _NEAR * size)
    brows = landmarks[17:27].mean(axis=0)
    down = landmarks[8] - brows
    down = down / np.linalg.norm(down)
    rows, columns = np.mgrid[: lab.shape[0], : lab.shape[1]]
    below = ((columns - brows[0]) * down[0] + (rows - brows[1]) * down[1]) / size > 0
    strip = grown(hull > 0.5, _STRIP * size)
    sure = (inner > 0.6) & (likely > 0.25)
    skin = sure | ((likely > 0.35) & near & (below | strip) & (hair < 0.5))
    place = np.where(hull > 0.5, _PLACE, np.where((face > 0.5) & (hair < 0.5), _FOREHEAD, 0.0)).astype(np.float32) - _HAIR * hair
    outside = (~skin & (likely < 0.1) & (hull < 0.5)) | far | (hair > 0.5)
    for _ in range(_ROUNDS):
        odds = _colour_odds(lab, skin, outside) + place
        odds = np.where(far, -9.0, np.where(sure, 9.0, odds)).astype(np.float32)
        skin = min_cut(odds, lab, _SMOOTHNESS, _SURE)
        outside = ~skin & (hull < 0.5)
    skin = _tidied(skin, inner > 0.6, size)
    return skin.astype(np.float32)


def _colour_odds(lab: Singles, inside: Mask, outside: Mask) -> Singles:
    """Log-odds (h, w) of inside by histograms of both sides, smoothed over neighbouring colours."""
    shape = (22, 66, 66)
    cells = np.floor((lab + [0.0, 128.0, 128.0]) / _BIN).astype(np.int64)
    cells = np.ravel_multi_index(tuple(np.moveaxis(np.clip(cells, 0, np.array(shape) - 1), -1, 0)), shape)
    shares = []
    for mask in (inside, outside):
        counts = np.bincount(cells[mask], minlength=int(np.prod(shape))).reshape(shape).astype(np.float32)
        for axis in range(3):
            counts = 0.5 * counts + 0.25 * (np.roll(counts, 1, axis) + np.roll(counts, -1, axis))
        shares.append(counts.reshape(-1)[cells] / max(1, int(mask.sum())) + 1e-4)
    return np.clip(np.log(shares[0] / shares[1]), -_EVIDENCE, _EVIDENCE).astype(np.float32)


def _tidied(skin: Mask, core: Mask, size: float) -> Mask:
    """Without specks, bridges and small holes; only what hangs together with the face."""
    radius = max(1, round(_TINY * size))
    disc = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (2 * radius + 1,) * 2)
    skin = (cv2.morphologyEx(skin.astype(np.uint8), cv2.MORPH_OPEN, disc) > 0) | core
    _, parts = cv2.connectedComponents(skin.astype(np.uint8))
    skin = np.isin(parts, np.setdiff1d(parts[core], 0)) if core.any() else skin
    _, holes, stats, _ = cv2.connectedComponentsWithStats((~skin).astype(np.uint8), connectivity=4)
    tiny = stats[:, cv2.CC_STAT_AREA] < _HOLE * size**2
    tiny[0] = False
    return skin | tiny[holes]


def _hull(shape: tuple[int, ...], landmarks: Floats) -> Mask:
    """Between jaw and brows."""
    return filled(shape, np.vstack([landmarks[:17], landmarks[26:16:-1]]))


def _covered(shape: tuple[int, ...], landmarks: Floats, size: float) -> Singles:
    """Sockets and lips, where features are drawn anew: skin lies under them."""
    mask = np.zeros(shape[:2], bool)
    for part in (*_EYES_AND_BROWS, tuple(range(48, 60))):
        mask |= grown(filled(shape, cv2.convexHull(landmarks[list(part)].astype(np.float32))[:, 0]), _SOCKETS * size)
    return np.clip(blurred((mask & _eroded(_hull(shape, landmarks), 0.01 * size)).astype(np.float32), 0.008 * size), 0, 1)


def _eroded(mask: Mask, radius: float) -> Mask:
    return ~grown(~mask, radius)
