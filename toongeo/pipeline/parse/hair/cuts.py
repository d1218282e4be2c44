"""Masks from a posterior: by its own odds with colours learned on the way, by GrabCut, and by the picture's edges."""

from __future__ import annotations

import cv2
import numpy as np
from skimage.segmentation import watershed

from toongeo.arrays import Singles
from toongeo.colour.min_cut import min_cut
from toongeo.pipeline.parse.hair.colour_evidence import colour_evidence
from toongeo.pipeline.parse.hair.head_zones import HeadZones
from toongeo.pipeline.parse.masks import Mask, grown, signed_distance
from toongeo.pipeline.parse.working_view import WorkingView

__all__ = ["colour_cut", "edge_cut", "grab_cut"]


# Weights of colours and smoothness were looked for on the pictures of benchmarks/hair_mask.py; both halves agreed.
_COLOUR = 1.0  # weight of the colours' evidence beside the posterior's log-odds
_LOW_COLOUR = 0.3  # the same about the chin and below: coats often have the hair's colour
_EVIDENCE = 3.5  # the most that a colour may say
_SMOOTHNESS = 6.0
_BELOW = 0.15  # how much the colours below the brows count, where ears and collars may pass for hair
_CLIP = 0.02  # posteriors are believed up to here
_SURE = 4.3  # log-odds; the posterior alone gives 3.9 at most
_NEVER = -6.0
_LIKELY = 0.6  # posterior of hair from which a flood of the ground is not believed
_COARSE = 2  # the first cuts are of a picture reduced by this: ten times faster
_ROUNDS = 2  # of coarse cuts
_BAND = 0.03  # head sizes about the coarse outline in which the last cut looks for the fine one
_FEWEST = 30  # px that either side of GrabCut needs
_PASSES = 3  # of GrabCut
_SEEDS = 0.8, 0.1  # posteriors of hair and of what is none from which the watershed starts
_FINE = 1.0  # px: changes of colour over less are noise
_ROOM = 0.15  # head sizes about the likely hair that GrabCut looks at


def colour_cut(lab: Singles, zones: HeadZones, posterior: Singles, ground: Mask | None) -> Mask:
    """Hair or hat (h, w) bool: cuts whose colours are learned from the cut before, and whose odds keep the posterior.

    ``ground`` are pixels that a flood has reached; it leaks into dark hair on dark ground, so a high posterior wins.
    """
    barred = (zones.core & (posterior < 0.3)) | _ground(ground, posterior)
    smooth = np.asarray(cv2.bilateralFilter(lab, 5, 8, 2), np.float32)
    small = smooth.shape[1] // _COARSE, smooth.shape[0] // _COARSE
    reduced = np.asarray(cv2.resize(smooth, small, interpolation=cv2.INTER_AREA), np.float32)
    weight, cut = posterior, posterior > 0.5
    for _ in range(_ROUNDS):
        odds = np.where(barred, _NEVER, _odds(lab, zones, posterior, weight)).astype(np.float32)
        coarse = np.asarray(cv2.resize(odds, small, interpolation=cv2.INTER_AREA), np.float32)
        part = min_cut(coarse, reduced, _SMOOTHNESS, _SURE).astype(np.float32)
        cut = cv2.resize(part, cut.shape[::-1], interpolation=cv2.INTER_LINEAR) > 0.5
        weight = 0.5 * posterior + 0.5 * cut.astype(np.float32)
    away = signed_distance(cut)
    odds = _odds(lab, zones, posterior, weight)
    odds = np.where(np.abs(away) > _BAND * zones.head, -_NEVER * np.sign(away), odds)
    return min_cut(np.where(barred, _NEVER, odds).astype(np.float32), smooth, _SMOOTHNESS, _SURE)


def _odds(lab: Singles, zones: HeadZones, posterior: Singles, weight: Singles) -> Singles:
    """Log-odds (h, w) of hair or hat by the posterior, and by colours learned with weights (h, w) of hair."""
    clipped = np.clip(posterior, _CLIP, 1 - _CLIP)
    inside = np.clip(weight - 0.1, 0, 1) ** 2 * np.where(zones.up > 0, 1, _BELOW)
    near = np.where(grown(posterior > 0.3, 0.3 * zones.head), 1, 0.3)
    outside = np.clip(0.7 - weight, 0, 1) ** 2 * near
    evidence = colour_evidence(lab, inside.astype(np.float32), outside.astype(np.float32))
    voice = np.where(zones.up > -0.9, _COLOUR, _LOW_COLOUR)
    odds = np.log(clipped / (1 - clipped)) + voice * np.clip(evidence, -_EVIDENCE, _EVIDENCE)
    return odds.astype(np.float32)


def grab_cut(view: WorkingView, zones: HeadZones, posterior: Singles, ground: Mask | None) -> Mask:
    """Hair or hat (h, w) bool by GrabCut (Rother et al. 2004), whose seeds are where the posterior is sure."""
    mask = np.where(posterior > 0.5, cv2.GC_PR_FGD, cv2.GC_PR_BGD).astype(np.uint8)
    mask[grown(posterior > 0.9, -0.02 * zones.head)] = cv2.GC_FGD
    mask[(posterior < 0.05) | (zones.core & (posterior < 0.3))] = cv2.GC_BGD
    mask[_ground(ground, posterior)] = cv2.GC_BGD
    front = (mask == cv2.GC_FGD) | (mask == cv2.GC_PR_FGD)
    if min(front.sum(), (~front).sum()) < _FEWEST:
        return front
    near = grown(front, _ROOM * zones.head)
    rows, columns = (_extent(np.asarray(near.any(axis=axis))) for axis in (1, 0))
    part = np.ascontiguousarray(mask[rows, columns])
    smooth = np.ascontiguousarray(cv2.bilateralFilter(view.pixels, 5, 20, 3)[rows, columns])
    cv2.setRNGSeed(0)  # its k-means starts at random
    models = np.zeros((2, 1, 65))
    cv2.grabCut(smooth, part, (0, 0, 0, 0), models[0], models[1], _PASSES, cv2.GC_INIT_WITH_MASK)
    result = np.zeros_like(front)
    result[rows, columns] = (part == cv2.GC_FGD) | (part == cv2.GC_PR_FGD)
    return result


def edge_cut(lab: Singles, posterior: Singles) -> Mask:
    """Hair or hat (h, w) bool by a watershed (Meyer 1994): doubtful pixels go to the side no edge parts them from.

    It knows no colours, so that hair before a wall of the same tone does not mislead it as it does the other cuts.
    """
    smooth = cv2.GaussianBlur(lab, (0, 0), _FINE)
    slopes = [cv2.Sobel(smooth, cv2.CV_32F, dx, 1 - dx) for dx in (0, 1)]
    seeds = np.where(posterior > _SEEDS[0], 1, np.where(posterior < _SEEDS[1], 2, 0)).astype(np.int32)
    if not (seeds == 1).any():
        return np.zeros(posterior.shape, bool)
    change = np.sqrt((slopes[0] ** 2 + slopes[1] ** 2).sum(axis=2))
    return np.asarray(watershed(change, seeds) == 1)


def _ground(ground: Mask | None, posterior: Singles) -> Mask:
    return np.zeros(posterior.shape, bool) if ground is None else ground & (posterior < _LIKELY)


def _extent(line: Mask) -> slice:
    where = np.flatnonzero(line)
    return slice(int(where[0]), int(where[-1]) + 1)
