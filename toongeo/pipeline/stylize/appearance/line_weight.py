"""The lines of a drawing: where they are, how broad, and a picture with lines of another breadth."""

from dataclasses import dataclass

import cv2
import numpy as np

from toongeo.arrays import Floats, Mask, Singles
from toongeo.pipeline.stylize.appearance.edge_flow import line_response, streamlines, tangent_flow
from toongeo.pipeline.stylize.appearance.pixels import blurred, enlarged, reduced

__all__ = ["Lines", "drawn_lines", "lines_as_broad", "without_lines"]

_MEASURED = 300.0  # px of the face at which lines are measured: those of drawings are 2 to 10 px broad then
_BROADEST = 0.045  # face sizes; broader darkness is no line
_DARKER = 18.0  # L*, than what is on both sides
_FEWEST = 0.002  # of the face's square that lines cover, or it has none
# L* of a photograph's lines, sigmas of their flow, and how long they are at least, face sizes.
_RESPONSE, _FLOW, _ALONG, _SHORTEST = 2.5, 0.014, 0.022, 0.1


@dataclass(frozen=True, eq=False)
class Lines:
    """Lines of a picture.

    Attributes
    ----------
    cover : (H, W) bool
    width : float, face sizes
        0 without lines.
    colour : (3,) float, CIELAB
    """

    cover: Mask
    width: float
    colour: Floats


def drawn_lines(lab: Singles, size: float) -> Lines:
    """Thin dark lines of a picture (H, W, 3), CIELAB, whose face has a size in px."""
    factor = _MEASURED / size
    lightness = reduced(np.ascontiguousarray(lab[..., 0]), factor)
    side = 2 * round(_BROADEST * _MEASURED / 2) + 1
    disc = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (side, side))
    lines = (cv2.morphologyEx(lightness, cv2.MORPH_CLOSE, disc) - lightness > _DARKER).astype(np.uint8)
    cover = cv2.resize(lines.astype(np.float32), lab.shape[1::-1], interpolation=cv2.INTER_LINEAR) > 0.5
    if lines.sum() < _FEWEST * _MEASURED**2 or not cover.any():
        return Lines(np.zeros(lab.shape[:2], bool), 0.0, np.zeros(3))
    return Lines(cover, _breadth(lines, _MEASURED), np.median(lab[cover], axis=0).astype(np.float64))


def lines_as_broad(lab: Singles, own: Lines, width: float, size: float) -> Singles:
    """Cover (H, W) of a picture's lines once they are as broad (face sizes); of its edges if it has no lines."""
    cover, breadth = (own.cover, own.width) if own.width else _edge_lines(lab, size)
    if not width or not cover.any():
        return np.zeros(lab.shape[:2], np.float32)
    more = np.float32(0.5 * (width - breadth) * size)
    # a pixel's centre is half a pixel from its border
    outside = cv2.distanceTransform((~cover).astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_5)
    inside = cv2.distanceTransform(cover.astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_5)
    return np.asarray(np.clip(more + inside - outside + ~cover, 0, 1), np.float32)


def without_lines(lab: Singles, lines: Lines, size: float) -> Singles:
    """A picture (H, W, 3), CIELAB, without its lines: the mean of what is beside them."""
    if not lines.width:
        return lab
    sigma = max(2.0, lines.width * size)
    beside = cv2.dilate(lines.cover.astype(np.uint8), np.ones((3, 3), np.uint8)) == 0
    weight = blurred(beside.astype(np.float32), sigma)[..., None]
    mean = blurred(lab * beside[..., None], sigma) / np.maximum(weight, np.float32(1e-4))
    return np.where(beside[..., None] | (weight < 1e-3), lab, mean).astype(np.float32)


def _edge_lines(lab: Singles, size: float) -> tuple[Mask, float]:
    """Where the line response of a picture without lines is strong over some length, and how broad that is."""
    factor = min(1.0, _MEASURED / size)
    lightness = np.asarray(reduced(np.ascontiguousarray(lab[..., 0]), factor), np.float32)
    along = streamlines(tangent_flow(lightness, _FLOW * size * factor), _ALONG * size * factor)
    strong = (line_response(lightness, along, size * factor) > _RESPONSE).astype(np.uint8)
    _, parts, stats, _ = cv2.connectedComponentsWithStats(strong, connectivity=8)
    long = np.hypot(stats[:, cv2.CC_STAT_WIDTH], stats[:, cv2.CC_STAT_HEIGHT]) > _SHORTEST * size * factor
    long[0] = False
    kept = long[parts]
    breadth = _breadth(kept.astype(np.uint8), size * factor) if kept.any() else 0.0
    return enlarged(kept.astype(np.float32), lab.shape) > 0.5, breadth


def _breadth(lines: np.ndarray, size: float) -> float:
    """Of lines (h, w) uint8, face sizes: four times the mean distance from the border of a strip."""
    inside = cv2.distanceTransform(lines, cv2.DIST_L2, cv2.DIST_MASK_5)[lines > 0] - 0.5
    return 4 * float(inside.mean()) / size
