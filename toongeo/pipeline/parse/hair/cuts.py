"""Masks from a posterior: by its own odds with colours learned on the way, and by GrabCut."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from toongeo.pipeline.parse.hair.colour_evidence import colour_evidence
from toongeo.pipeline.parse.hair.head_zones import HeadZones
from toongeo.pipeline.parse.hair.min_cut import min_cut
from toongeo.pipeline.parse.masks import Mask, grown
from toongeo.pipeline.parse.working_view import WorkingView

__all__ = ["colour_cut", "grab_cut"]

Field = NDArray[np.float32]

_ROUNDS = 3
_PLACE, _COLOUR = 0.7, 0.6  # weights of the posterior's log-odds and of the colours' evidence
_CLIP = 0.02  # posteriors are believed up to here
_EVIDENCE = 4.0  # the most that a colour may say
_SMOOTHNESS = 6.0
_SURE = 3.2  # log-odds; about the largest that the posterior alone gives is 2.7
_NEVER = -6.0


def colour_cut(lab: Field, zones: HeadZones, posterior: Field, never: Mask | None) -> Mask:
    """Hair or hat (h, w) bool: cuts whose colours are learned from the cut before, and whose odds keep the posterior.

    ``never`` are pixels that are ground for sure.
    """
    clipped = np.clip(posterior, _CLIP, 1 - _CLIP)
    place = np.log(clipped / (1 - clipped))
    smooth = cv2.bilateralFilter(lab, 5, 8, 2)
    near = np.where(grown(posterior > 0.3, 0.3 * zones.head), 1, 0.3).astype(np.float32)
    weight = posterior
    cut = posterior > 0.5
    for _ in range(_ROUNDS):
        inside = np.clip(weight - 0.1, 0, 1) ** 2
        outside = np.clip(0.7 - weight, 0, 1) ** 2 * near
        odds = _PLACE * place + _COLOUR * np.clip(colour_evidence(lab, inside, outside), -_EVIDENCE, _EVIDENCE)
        odds[zones.core & (posterior < 0.3)] = _NEVER
        if never is not None:
            odds[never] = _NEVER
        cut = min_cut(odds.astype(np.float32), np.asarray(smooth, np.float32), _SMOOTHNESS, _SURE)
        if not cut.any():
            break
        weight = 0.5 * posterior + 0.5 * cut.astype(np.float32)
    return cut


def grab_cut(view: WorkingView, zones: HeadZones, posterior: Field, never: Mask | None) -> Mask:
    """Hair or hat (h, w) bool by GrabCut (Rother et al. 2004), whose seeds are where the posterior is sure."""
    mask = np.where(posterior > 0.5, cv2.GC_PR_FGD, cv2.GC_PR_BGD).astype(np.uint8)
    mask[grown(posterior > 0.9, -0.02 * zones.head)] = cv2.GC_FGD
    mask[(posterior < 0.05) | (zones.core & (posterior < 0.3))] = cv2.GC_BGD
    if never is not None:
        mask[never] = cv2.GC_BGD
    front = (mask == cv2.GC_FGD) | (mask == cv2.GC_PR_FGD)
    if min(front.sum(), (~front).sum()) < 30:
        return front
    cv2.setRNGSeed(0)  # its k-means starts at random
    models = np.zeros((2, 1, 65))
    smooth = np.ascontiguousarray(cv2.bilateralFilter(view.pixels, 5, 20, 3))
    cv2.grabCut(smooth, mask, (0, 0, 0, 0), models[0], models[1], 3, cv2.GC_INIT_WITH_MASK)
    return np.asarray((mask == cv2.GC_FGD) | (mask == cv2.GC_PR_FGD))
