"""What hair can be: no brows, no crumbs, and below the chin only what hangs from above."""

from __future__ import annotations

import cv2
import numpy as np

from toongeo.arrays import Singles
from toongeo.pipeline.parse.hair.head_zones import HeadZones
from toongeo.pipeline.parse.masks import Mask, grown, signed_distance

__all__ = ["growth_rules"]


# Shares of the head's size, or of its square for areas.
_OPEN = 0.008  # thinner lines are no hair
_SMOOTH = 0.006  # of the outline
_LEAST = 0.003  # area of a piece
_HOLE = 0.006  # area of a hole that is closed
_LINK = 0.02  # half the breadth of a link between head and what hangs
_HANG = 0.9  # how far hair hangs below the chin
_INWARDS, _OUTWARDS = 0.35, 1.0  # px that the edges of hanging hair move a row, towards the neck and away from it


def growth_rules(mask: Mask, zones: HeadZones, posterior: Singles) -> Mask:
    """A mask (h, w) without what cannot be hair or hat."""
    mask = _opened(mask, _OPEN * zones.head)
    mask &= ~(zones.hull & (zones.up < -0.25) & grown(zones.hull, -0.06 * zones.head))
    mask = _without_brows(mask, zones)
    mask = _large_pieces(mask, zones, posterior)
    mask = _filled(mask, zones)
    if mask.any():
        mask = _linked(_hanging(_linked(mask, zones), zones), zones)
    away = np.clip(signed_distance(mask), -8, 8)
    return _large_only(np.asarray(cv2.GaussianBlur(away, (0, 0), _SMOOTH * zones.head) > 0), zones)


def _opened(mask: Mask, radius: float) -> Mask:
    size = 2 * max(1, round(radius)) + 1
    disc = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (size, size))
    return np.asarray(cv2.morphologyEx(mask.astype(np.uint8), cv2.MORPH_OPEN, disc) > 0)


def _without_brows(mask: Mask, zones: HeadZones) -> Mask:
    """Brows stay only where hair falls into them from above."""
    band = grown(zones.brow, 0.05 * zones.unit) & mask
    rest = mask & ~band
    for row in np.flatnonzero(band.any(axis=1)):
        if row:
            above = np.pad(rest[row - 1], 1)
            rest[row] |= band[row] & (above[:-2] | above[1:-1] | above[2:])
    return rest


def _large_pieces(mask: Mask, zones: HeadZones, posterior: Singles) -> Mask:
    """Pieces that are large, likely, and on or beside the head, not only below it."""
    count, pieces, stats, _ = cv2.connectedComponentsWithStats(mask.astype(np.uint8), connectivity=4)
    largest = stats[1:, cv2.CC_STAT_AREA].max(initial=0)
    kept = np.zeros(count, bool)
    near = grown(zones.skull, 0.25 * zones.head)
    for k in range(1, count):
        piece, area = pieces == k, stats[k, cv2.CC_STAT_AREA]
        kept[k] = (
            area > max(_LEAST * zones.head**2, 0.02 * largest)
            and posterior[piece].mean() > 0.55
            and (zones.up[piece].max() > -0.3 or bool((piece & near).any()))
            and (piece & (zones.up > -0.75)).sum() > 0.05 * area
        )
    return kept[pieces]


def _large_only(mask: Mask, zones: HeadZones) -> Mask:
    count, pieces, stats, _ = cv2.connectedComponentsWithStats(mask.astype(np.uint8), connectivity=4)
    area = stats[:, cv2.CC_STAT_AREA]
    kept = area > max(_LEAST * zones.head**2, 0.02 * area[1:].max(initial=0))
    kept[0] = False
    return kept[pieces] if count > 1 else mask


def _filled(mask: Mask, zones: HeadZones) -> Mask:
    """Small holes closed, but not over the face."""
    _, pieces, stats, _ = cv2.connectedComponentsWithStats((~mask).astype(np.uint8), connectivity=4)
    small = stats[:, cv2.CC_STAT_AREA] < _HOLE * zones.head**2
    small[0] = False
    return mask | (small[pieces] & ~zones.core)


def _linked(mask: Mask, zones: HeadZones) -> Mask:
    """Without parts mostly below the chin that hang on the head by a thread."""
    solid = _opened(mask, _LINK * zones.head)
    count, pieces, stats, _ = cv2.connectedComponentsWithStats(solid.astype(np.uint8), connectivity=4)
    low = np.zeros(count, bool)
    for k in range(1, count):
        piece = pieces == k
        below = (piece & (zones.up < -1)).sum() > 0.55 * stats[k, cv2.CC_STAT_AREA]
        low[k] = below and not (piece & (zones.up > 0)).any()
    if not low.any():
        return mask
    off = (~solid).astype(np.uint8)
    _, nearest = cv2.distanceTransformWithLabels(off, cv2.DIST_L2, 5, labelType=cv2.DIST_LABEL_PIXEL)
    owner = np.zeros(nearest.max() + 1, np.int64)
    owner[nearest[solid]] = pieces[solid]
    return mask & ~low[owner[nearest]]


def _hanging(mask: Mask, zones: HeadZones) -> Mask:
    """Below the chin each row keeps what continues the row above: hair falls, coats and collars come from the side."""
    height, width = mask.shape
    start = int(np.clip(zones.chin[1] + 0.02 * zones.head, 1, height))
    result = mask.copy()
    if start >= height:
        return result
    open_row = mask[start - 1]
    for row in range(start, height):
        step = row - start
        if step > _HANG * zones.head:
            result[row:] = False
            break
        inwards, outwards = (int((step + 1) * rate) - int(step * rate) for rate in (_INWARDS, _OUTWARDS))
        change = np.diff(np.pad(open_row.astype(np.int8), 1))
        allowed = np.zeros(width, bool)
        for i, j in zip(np.flatnonzero(change == 1), np.flatnonzero(change == -1), strict=True):
            left, right = (outwards, inwards) if (i + j) / 2 < zones.chin[0] else (inwards, outwards)
            allowed[max(0, i - left) : j + right] = True
        open_row = result[row] = allowed & mask[row]
    return result
