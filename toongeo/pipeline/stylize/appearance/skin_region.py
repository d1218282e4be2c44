"""Which pixels are skin, by the landmarks and by colour."""

from dataclasses import dataclass

import cv2
import numpy as np

from toongeo.arrays import Floats, Mask, Singles
from toongeo.colour.min_cut import min_cut
from toongeo.pipeline.parse.guided_filter import guided_filter
from toongeo.pipeline.parse.masks import filled, grown
from toongeo.pipeline.stylize.appearance.head_light import HeadLight
from toongeo.pipeline.stylize.appearance.pixels import blurred, enlarged, hull_of, placed_in, reduced, soft_step

__all__ = ["SkinRegion", "may_be_beard", "skin_region"]

_WORKING = 70.0  # px of the face in which the cut is made
# In face sizes: how far the jaw-brow hull is kept from its border and from features, and how far skin may reach from
# the fitted head, below it (the neck), and beside what is above.
_INNER, _FEATURE, _NEAR, _NECK, _WIDER_NECK = 0.04, 0.05, 0.10, 0.6, 0.2
_STRIP = 0.05  # above the brows: farther up, fringes would be learned as skin
_SOCKETS = 0.03  # around eyes and brows, which are drawn anew on skin
_HOLE = 0.015  # squares of face sizes: smaller holes are drawn over
_AROUND = 0.5  # of the surroundings, which say what is not skin
_TINY = 0.02  # thinner bridges and specks are none
_BIN = (5.0, 4.0, 4.0)  # Lab, of the colour models
_EVIDENCE = 4.0  # bound of their log-odds
_PLACE, _FOREHEAD = 2.5, 1.5  # log-odds for what lies within the hull, and within the rest of the fitted face
_SURE_HAIR = 2.0  # times what is left of a pixel beside hair: one of three fourths hair is half skin
_HAIR = 5.0  # log-odds against what is known to be hair
_SMOOTHNESS, _SURE = 3.0, 6.0  # of the cut
_ROUNDS = 3
_FRINGE, _LIKE_HAIR = 0.06, 0.5  # how far strands end beyond the mask (face sizes), and their log-odds
_STRANDS, _FEWEST = (
    0.7,
    0.05,
)  # hair so sure, of which there must be so much (squares of face sizes), has colours of its own
_UNLIKE = 0.25  # likelihood of skin below which hair may grow on it
_LIPS = 0.02  # face sizes around the lips that are drawn anew
# The skin's colour: deviations from its median count in these tolerances (Lab; at most, offset, times).
_MOST, _LEAST, _TIMES = (12.0, 6.0, 6.0), (4.0, 3.0, 3.0), (2.0, 1.6, 1.6)
_FEATURES = (range(36, 42), range(42, 48), range(48, 60), range(17, 22), range(22, 27))
_EYES_AND_BROWS = ((17, 18, 19, 20, 21, 39, 40, 41, 36), (22, 23, 24, 25, 26, 45, 46, 47, 42))


@dataclass(frozen=True, eq=False)
class _Planes:
    """Planes (h, w) of the picture in which the cut is made: `lab` has three channels, the others lie in [0, 1]."""

    lab: Singles
    likely: Singles
    inner: Singles
    hull: Singles
    head: Singles
    face: Singles
    hair: Singles


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
        Of the cheeks' skin, and of its lighter half.
    lightness : float, L*
        Between that of the cheeks and that of the whole face, which may lie in shadow.
    """

    drawn: Singles
    seen: Singles
    hull: Singles
    median: Singles
    lit: Singles
    lightness: float


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
    box = _box(lab.shape, landmarks, size, light.head)
    corner = np.array([part.start for part in box[::-1]], float)
    near = HeadLight(light.head[box], light.face[box], light.shade[box], light.from_right)
    region = _region(np.ascontiguousarray(lab[box]), landmarks - corner, size, near, hair[box])
    drawn, seen, hull = (np.zeros(lab.shape[:2], np.float32) for _ in range(3))
    drawn[box], seen[box], hull[box] = region.drawn, region.seen, region.hull
    return SkinRegion(drawn, seen, hull, region.median, region.lit, region.lightness)


def _box(shape: tuple[int, ...], landmarks: Floats, size: float, head: Singles) -> tuple[slice, slice]:
    """Rows and columns around head and neck, with enough of what surrounds them for its colours to be known."""
    x, y, width, height = cv2.boundingRect((head > 0.5).astype(np.uint8))
    corners = np.vstack([landmarks, [[x, y], [x + width, y + height]] if width else landmarks[:1]])
    low = np.clip(np.floor(corners.min(axis=0) - _AROUND * size), 0, None).astype(int)
    high = np.ceil(corners.max(axis=0) + _AROUND * size + [1, _NECK * size]).astype(int)
    high = np.maximum(np.minimum(high, shape[1::-1]), low + 1)
    return np.s_[low[1] : high[1], low[0] : high[0]]


def _region(lab: Singles, landmarks: Floats, size: float, light: HeadLight, hair: Singles) -> SkinRegion:
    hull = _hull(lab.shape, landmarks)
    inner = _eroded(hull, _INNER * size)
    for feature in _FEATURES:
        inner &= ~grown(filled(lab.shape, hull_of(landmarks[list(feature)])), _FEATURE * size)
    inner &= hair < 0.5
    cheeks = inner & ~may_be_beard(lab.shape, landmarks, size)
    pixels = lab[cheeks if cheeks.any() else hull]
    median = np.median(pixels, axis=0)
    lit = np.median(pixels[pixels[:, 0] >= median[0]], axis=0)
    deviation = np.minimum(np.percentile(np.abs(pixels - median), 80, axis=0), _MOST)
    distance = (lab - median) / ((deviation + _LEAST) * _TIMES)
    likely = np.exp(-0.5 * np.square(distance).sum(axis=-1)).astype(np.float32)
    factor = min(1.0, _WORKING / size)
    planes = (likely, inner, hull, light.head, light.face, hair)
    small = _Planes(reduced(lab, factor), *(reduced(np.asarray(plane, np.float32), factor) for plane in planes))
    cut = _cut(small, placed_in(landmarks, factor), size * factor)
    soft = guided_filter(np.asarray(lab / 100, np.float32), enlarged(cut, lab.shape), max(2, round(0.03 * size)), 2e-3)
    soft = np.minimum(np.clip(blurred(soft, 0.006 * size), 0, 1), np.clip(_SURE_HAIR * (1 - hair), 0, 1))
    soft *= 1 - _fringe(lab, soft > 0.5, hair, size)
    covered = _covered(lab.shape, landmarks, size)
    face = lab[..., 0][hull & (soft > 0.5)]
    whole = float(np.median(face)) if len(face) else float(median[0])
    return SkinRegion(
        np.maximum(soft, covered),
        soft,
        blurred(hull.astype(np.float32), 0.01 * size),
        median.astype(np.float32),
        lit.astype(np.float32),
        0.5 * (float(median[0]) + whole),
    )


def _fringe(lab: Singles, skin: Mask, hair: Singles, size: float) -> Singles:
    """Cover (h, w) of what lies along sure hair and has its colours: ends of strands, too fine for the cut."""
    strands = hair > _STRANDS
    if not strands.sum() > _FEWEST * size**2:
        return np.zeros(lab.shape[:2], np.float32)
    near = (grown(hair > 0.5, _FRINGE * size) & skin).astype(np.float32)
    odds = blurred(_colour_odds(lab, skin & ~strands, strands), 0.004 * size)
    return near * soft_step(-odds - _LIKE_HAIR, 0.5)


def _cut(small: _Planes, landmarks: Floats, size: float) -> Singles:
    """Skin (h, w) of 0 and 1 in a small picture."""
    low = np.maximum(small.head, small.hull) > 0.5
    chin = np.arange(len(small.lab))[:, None] > landmarks[8, 1]
    body = np.zeros((2 * round(_NECK * size) + 1, 2 * round(_WIDER_NECK * size) + 1), np.uint8)
    body[: round(_NECK * size) + 1] = 1
    neck = cv2.dilate((low & chin).astype(np.uint8), body) > 0
    low |= neck
    near, far = grown(low, _INNER * size), ~grown(low, _NEAR * size)
    brows = landmarks[17:27].mean(axis=0)
    down = landmarks[8] - brows
    down = down / np.linalg.norm(down)
    rows, columns = np.mgrid[: small.lab.shape[0], : small.lab.shape[1]]
    below = ((columns - brows[0]) * down[0] + (rows - brows[1]) * down[1]) / size > 0
    strip = grown(small.hull > 0.5, _STRIP * size)
    sure = (small.inner > 0.6) & (small.likely > 0.25)
    skin = sure | ((small.likely > 0.35) & near & (below | strip) & (small.hair < 0.5))
    beard = may_be_beard(small.lab.shape, landmarks, size) & (small.likely < _UNLIKE)
    place = np.where(
        small.hull > 0.5, _PLACE, np.where((small.face > 0.5) & (small.hair < 0.5), _FOREHEAD, 0.0)
    ).astype(np.float32)
    place = np.where(beard, 0, place) - _HAIR * small.hair
    outside = (~skin & (small.likely < 0.1) & (small.hull < 0.5)) | far | (small.hair > 0.5) | beard
    strands = small.hair > _STRANDS
    for _ in range(_ROUNDS):
        odds = _colour_odds(small.lab, skin, outside)
        if strands.sum() > _FEWEST * size**2:  # among all that is no skin, colours of little hair would count little
            odds = np.minimum(odds, _colour_odds(small.lab, skin, strands))
        odds = odds + place
        odds = np.where(far, -9.0, np.where(sure, 9.0, odds)).astype(np.float32)
        skin = min_cut(odds, small.lab, _SMOOTHNESS, _SURE)
        outside = ~skin & ((small.hull < 0.5) | beard)
    skin = _tidied(skin, sure, size)
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


def may_be_beard(shape: tuple[int, ...], landmarks: Floats, size: float) -> Mask:
    """Where beards and moustaches grow: below the nose within the jaw, but for the lips."""
    wings = landmarks[[31, 35]] + 0.06 * (landmarks[[31, 35]] - landmarks[33])
    lower = filled(shape, np.vstack([landmarks[2:15], wings[1], landmarks[33], wings[0]]))
    lips = filled(shape, hull_of(landmarks[48:60]))
    return lower & ~grown(lips, _LIPS * size)


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
    for part, margin in (*((part, _SOCKETS) for part in _EYES_AND_BROWS), (tuple(range(48, 60)), _LIPS)):
        mask |= grown(filled(shape, hull_of(landmarks[list(part)])), margin * size)
    return np.clip(
        blurred((mask & _eroded(_hull(shape, landmarks), 0.01 * size)).astype(np.float32), 0.008 * size), 0, 1
    )


def _eroded(mask: Mask, radius: float) -> Mask:
    return ~grown(~mask, radius)
