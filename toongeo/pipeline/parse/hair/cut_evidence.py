"""What the parser's cuts of head and skin add to a posterior of hair."""

from __future__ import annotations

import numpy as np

from toongeo.arrays import Mask, Singles
from toongeo.pipeline.parse.hair.head_zones import HeadZones
from toongeo.pipeline.parse.head_and_skin import HeadAndSkin
from toongeo.pipeline.parse.masks import signed_distance

__all__ = ["cut_evidence"]

# Log-odds, chosen on CHOOSING of benchmarks/pictures.py among 0 to 4 and 0 to 3: with less, ears and foreheads stay.
# The same off the head cost strands that its cut misses, and gained nothing.
_SKIN, _LEFT = 2.5, 1.0
_CLIP = 0.02  # posteriors are believed up to here, as in the cuts
_SOFT = 0.02  # head sizes on either side of an outline over which it speaks for less
_SURE = 0.7  # posterior of hair that a head must hold
_HELD = 0.7  # share of the sure hair: a head that holds less was cut out without its hair
_TAKEN = 0.5  # share of the sure hair: skin that takes more is white hair beside a pale face, say
_ALIEN = 0.5  # unlikeness to skin from which what is left of a head is rather hair


def cut_evidence(zones: HeadZones, cut: HeadAndSkin, posterior: Singles) -> Singles:
    """Posterior (h, w) of hair or hat, lower on skin, higher on what of the head above the brows is no skin.

    A head that leaves out most of what is surely hair says nothing, nor does skin that takes most of it.
    """
    sure = (posterior > _SURE) & (zones.up > 0)
    held, taken = (int((sure & part).sum()) / max(int(sure.sum()), 1) for part in (cut.head, cut.skin))
    clipped = np.clip(posterior, _CLIP, 1 - _CLIP)
    odds = np.log(clipped / (1 - clipped))
    if taken <= _TAKEN:
        odds = odds - _SKIN * _soft(cut.skin, zones) * (zones.up > -1)
    if held >= _HELD or not sure.any():
        left = cut.head & ~cut.skin & (zones.up > 0) & ~zones.hull & ~zones.ears & (cut.non_skin > _ALIEN)
        odds = odds + _LEFT * _soft(left, zones)
    return np.asarray(1 / (1 + np.exp(-odds)), np.float32)


def _soft(mask: Mask, zones: HeadZones) -> Singles:
    return np.clip(0.5 + signed_distance(mask) / np.float32(2 * _SOFT * zones.head), 0, 1)
