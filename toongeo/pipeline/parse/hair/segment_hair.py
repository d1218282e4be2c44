"""Hair and hat in a view of a head, with what speaks for and against them."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations

import cv2
import numpy as np

from toongeo.arrays import Singles
from toongeo.colour.cielab import cielab
from toongeo.pipeline.parse.hair.cut_evidence import cut_evidence
from toongeo.pipeline.parse.hair.cuts import colour_cut, edge_cut, grab_cut
from toongeo.pipeline.parse.hair.growth_rules import growth_rules
from toongeo.pipeline.parse.hair.hair_alpha import hair_alpha
from toongeo.pipeline.parse.hair.hair_model import HairModel
from toongeo.pipeline.parse.hair.hair_trust import (
    HairChances,
    HairCuts,
    HairMeasures,
    hair_measures,
    overlap,
    without_clothes,
)
from toongeo.pipeline.parse.hair.head_zones import HeadZones
from toongeo.pipeline.parse.hair.narrowed_zones import narrowed_zones
from toongeo.pipeline.parse.hair.plain_ground import plain_ground
from toongeo.pipeline.parse.hair.superpixels import superpixels
from toongeo.pipeline.parse.head_and_skin import HeadAndSkin
from toongeo.pipeline.parse.masks import Mask
from toongeo.pipeline.parse.working_view import WorkingView

__all__ = ["SegmentedHair", "alike", "segment_hair"]


_BLUR = 1.8  # px: superpixels have jagged borders
_ALIKE = 0.88  # overlap of two cuts below which a third is asked; on CHOOSING of benchmarks/pictures.py 5 of 13 are
_HAT = 0.02  # squares of the head's size: smaller hats are none
_HAT_SHARE = 0.3  # of hair and hat: a smaller hat is hair of another colour


@dataclass(frozen=True, eq=False)
class SegmentedHair:
    """hair, hat (h, w) bool, alpha (h, w) of the hair in [0, 1], and measures of their quality."""

    hair: Mask
    hat: Mask
    alpha: Singles
    measures: HairMeasures


def segment_hair(view: WorkingView, zones: HeadZones, cut: HeadAndSkin, model: HairModel) -> SegmentedHair:
    """Posterior, three cuts of it, rules of growth, and what the cuts say of each other."""
    lab = cielab(view.pixels)
    ground = plain_ground(view, zones)
    zones = narrowed_zones(zones, cut.head)
    patches = superpixels(lab)
    guess, chances = (p[patches.labels] for p in model(zones, patches))
    cover = cut_evidence(zones, cut, _cover(chances))
    one, other = (
        growth_rules(part, zones, cover)
        for part in (colour_cut(lab, zones, cover, ground), grab_cut(view, zones, cover, ground))
    )
    if overlap(one, other) < _ALIKE:
        one, other = alike([one, other, growth_rules(edge_cut(lab, cover), zones, cover)])
    one, other = (without_clothes(lab, part, zones) for part in (one, other))
    both = one | other  # each misses what the other has, more often than it strays
    hat = _hat(both, chances, zones)
    alpha = hair_alpha(view.pixels, both & ~hat, zones.head)
    mean = (guess + chances) / np.float32(2)
    measures = hair_measures(
        lab, both, HairCuts(one, other, cut.head & ~cut.skin), zones, HairChances(_cover(mean), mean[..., 2])
    )
    return SegmentedHair(both & ~hat, hat, alpha, measures)


def alike(masks: list[Mask]) -> tuple[Mask, Mask]:
    """Those two masks that overlap most: a third that went astray is outvoted."""
    return max(combinations(masks, 2), key=lambda pair: overlap(*pair))


def _cover(chances: Singles) -> Singles:
    """How likely each pixel (h, w) is hair or hat."""
    return np.asarray(cv2.GaussianBlur(chances[..., 1] + chances[..., 2], (0, 0), _BLUR), np.float32)


def _hat(mask: Mask, chances: Singles, zones: HeadZones) -> Mask:
    """The large pieces of the mask that are hat rather than hair."""
    lead = cv2.GaussianBlur(chances[..., 2] - chances[..., 1], (0, 0), 2 * _BLUR)
    _, pieces, stats, _ = cv2.connectedComponentsWithStats((mask & (lead > 0)).astype(np.uint8), connectivity=4)
    large = stats[:, cv2.CC_STAT_AREA] > _HAT * zones.head**2
    large[0] = False
    hat = np.asarray(large[pieces], np.bool_)
    return hat if hat.sum() > _HAT_SHARE * mask.sum() else np.zeros_like(mask)
