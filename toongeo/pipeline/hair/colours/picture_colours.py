"""The colours of hair over the plane: as drawn, and smoothed out to where none is seen."""

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from toongeo.arrays import Mask, Reals
from toongeo.pipeline.hair.plane.masks import nearest_set
from toongeo.pipeline.hair.plane.working_plane import CELL_MM, WorkingPlane
from toongeo.pipeline.parse.colour_share import ColourCodes, colour_codes, colour_share

__all__ = ["PictureColours", "picture_colours"]


_EDGE_MM = 0.8  # along the hair's edge the picture is mixed with what is beside it
_RARE = 0.0015  # of the hair: colours that are rarer are of something else
_MIXED_MM = 12.0  # so far inside its edge curly hair lets the ground through
_CLEAR_MM, _BESIDE_MM = 2.0, 15.0  # from and to where outside the hair its surroundings are looked at
_OTHERS = 4.0  # so much commoner beside the hair than inside it a colour is not the hair's
_OUTLINES_MM = np.arange(1.0, 7.0, 0.5)  # breadths of drawn outlines that are looked for
_DARKER = 0.6  # of the hair's lightness: a drawn outline is below
_STROKE_MM = 4.0  # half the window of a median that removes strokes
_BROAD_MM = 6.0  # what of the picture is its shading; the rest is strands
_PLAIN_MM = 25.0  # what is no light on one place


@dataclass(frozen=True, eq=False)
class PictureColours:
    """Colours over the plane, rows up.

    Attributes
    ----------
    drawn : (h, w, 3) float32, 0..255
        The picture where it shows hair, elsewhere continued from the nearest hair.
    broad : (h, w, 3) float32
        Without strands, continued smoothly.
    plain : (h, w, 3) float32
        The same without lights and shades, for what lies behind.
    known : (h, w) bool
        Where the picture shows hair well.
    inside : (h, w) float32, mm
        Signed distance to the outline of the hair.
    cell_mm : float
    """

    drawn: NDArray[np.float32]
    broad: NDArray[np.float32]
    plain: NDArray[np.float32]
    known: Mask
    inside: NDArray[np.float32]
    cell_mm: float


def picture_colours(
    plane: WorkingPlane, img: NDArray[np.uint8], inside: Reals, outer: Reals, density: float
) -> PictureColours:
    """Colours of the hair at so many cells per mm.

    ``inside`` (rows, columns) is the signed distance, mm, to the outline of the hair in the plane's raster, ``outer``
    the distance to the outline that lies before the background: drawings have a dark line there, which is left out.
    """
    cell = 1.0 / density
    source = img
    if plane.scale > 1.5 * density:
        source = np.asarray(cv2.GaussianBlur(img, (0, 0), 0.4 * plane.scale / density), np.uint8)
    picture = plane.warp(source, cell)
    h, w = picture.shape[:2]
    pictured = plane.warp(np.ones(img.shape[:2], np.uint8), cell, nearest=True)
    pictured = cv2.erode(pictured, np.ones((3, 3), np.uint8), borderValue=0) > 0
    deep, edge = (_resampled(layer, (h, w), cell) for layer in (inside, outer))
    line = _outline_mm(picture, deep, edge)
    known = (deep > _EDGE_MM) & pictured & ~((edge < line + 2.0) & (deep < line))
    core = known & (deep > 3.0)
    core = core if core.sum() > 0.3 * known.sum() else known
    codes = colour_codes(picture)
    known &= colour_share(codes, core) > _RARE
    known &= ~_strange(codes, core, deep, pictured)
    if not known.any():
        known = (deep > 0) & pictured
    if not known.any():
        known = pictured
    drawn = nearest_set(picture, known)
    soft = cv2.GaussianBlur(drawn, (0, 0), 1.5 * density)
    drawn = np.where(known[..., None], picture, soft)
    pure = known & (deep > max(2.0, 2.0 * cell))  # beside the skin the picture mixes both
    pure = pure if pure.any() else known
    # The median leaves the ground between strokes, where the mean would leave their shadow.
    window = 2 * max(1, round(_STROKE_MM * density)) + 1
    ground = np.asarray(cv2.medianBlur(drawn, window), np.uint8)
    broad, plain = (_pushed(ground, pure, sigma * density) for sigma in (_BROAD_MM, _PLAIN_MM))
    return PictureColours(drawn.astype(np.float32), broad, plain, known, deep, cell)


def _strange(codes: ColourCodes, core: Mask, deep: Reals, pictured: Mask) -> Mask:
    """Near the edge what has the colours of what is beside the hair and not of its inside: ground between curls."""
    inner = core & (deep > _MIXED_MM)
    beside = pictured & (deep < -_CLEAR_MM) & (deep > -_BESIDE_MM)
    if not inner.any() or not beside.any():
        return np.zeros_like(core)
    return np.asarray((deep < _MIXED_MM) & (colour_share(codes, beside) > _OTHERS * colour_share(codes, inner)))


def _resampled(layer: Reals, shape: tuple[int, int], cell: float) -> NDArray[np.float32]:
    scale = cell / CELL_MM
    affine = np.array([[scale, 0, 0], [0, scale, 0]])
    flags = cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP
    return np.asarray(
        cv2.warpAffine(layer.astype(np.float32), affine, shape[::-1], flags=flags, borderMode=cv2.BORDER_REPLICATE)
    )


def _outline_mm(picture: NDArray[np.uint8], deep: Reals, edge: Reals) -> float:
    """Breadth of a drawn outline, mm; it is darker than what it bounds."""
    light = cv2.cvtColor(picture, cv2.COLOR_RGB2GRAY)
    inner = (deep > 8) & (deep < 25)
    usual = np.median(light[inner]) if inner.any() else 128.0
    breadth = 1.0
    for outermost in _OUTLINES_MM:
        band = (deep > outermost - 0.5) & (deep < outermost) & (edge < outermost + 2)
        if band.sum() > 50 and np.median(light[band]) < _DARKER * usual:
            breadth = float(outermost) + 1.0
    return breadth


def _pushed(picture: NDArray[np.uint8], known: Mask, sigma: float) -> NDArray[np.float32]:
    """Colours blurred within a mask, and continued outside it by ever broader blurs."""
    reduce = max(1, int(sigma / 3))
    size = (max(1, picture.shape[1] // reduce), max(1, picture.shape[0] // reduce))
    weight = known.astype(np.float32)
    layers = cv2.resize(np.dstack([picture * weight[..., None], weight]), size, interpolation=cv2.INTER_AREA)
    total = layers.mean((0, 1)) * np.float32(1e-9)
    for k, share in enumerate((1.0, 1e-3, 1e-6)):
        total = total + np.float32(share) * cv2.GaussianBlur(layers, (0, 0), sigma / reduce * 3**k)
    colours = total[..., :3] / np.maximum(total[..., 3:], 1e-20)
    return np.asarray(cv2.resize(colours, picture.shape[1::-1], interpolation=cv2.INTER_LINEAR), np.float32)
