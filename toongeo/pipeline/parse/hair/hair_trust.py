"""When a hair mask is good enough to build hair from it."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np

from toongeo.arrays import Singles
from toongeo.pipeline.parse.hair.head_zones import HeadZones
from toongeo.pipeline.parse.masks import Mask, grown

__all__ = ["RULES", "HairMeasures", "distrust", "hair_measures"]


_EDGE = 1.5  # px: colours are blurred by this before their change is measured
_ACROSS = 4.0  # px over which they change
_CHANGE = 4.0  # CIELAB units: a smaller change is no outline
_TOP = 0.3  # faces above the brows that hair must reach to top a column of the head


@dataclass(frozen=True)
class HairMeasures:
    """What a rule of trust looks at.

    Attributes
    ----------
    area : of the mask, in squares of the head's size
    agreement : intersection over union of two masks that were cut in different ways
    inside : mean posterior in the mask, of both sets of trees
    outside : the same in a ring about it
    topped : share of the columns over the crown that hair tops
    border : share of the outline that is the picture's border
    hat : how much of what is likely hair or hat in the mask is rather hat
    outlined : share of the outline along which the colours change
    """

    area: float
    agreement: float
    inside: float
    outside: float
    topped: float
    border: float
    hat: float
    outlined: float

    @property
    def certainty(self) -> float:
        """Agreement of the cuts, and how far the posterior falls across the outline: 2 at best."""
        return self.agreement + self.inside - self.outside


def hair_measures(
    lab: Singles, mask: Mask, other: Mask, zones: HeadZones, posterior: Singles, hat: Singles
) -> HairMeasures:
    """Measures of a mask of hair and hat (h, w) in a CIELAB picture (h, w, 3), and of another mask.

    The posteriors (h, w) are of hair and hat together, and of hats alone.
    """
    union = int((mask | other).sum())
    ring = grown(mask, 0.06 * zones.head) & ~grown(mask, 0.015 * zones.head)
    columns = np.flatnonzero((zones.skull & (zones.up > 0.25)).any(axis=0))
    sixth = len(columns) // 6
    middle = columns[sixth : len(columns) - sixth]
    top = np.where(mask[:, middle], zones.up[:, middle], -9).max(axis=0, initial=-9) > _TOP
    edge = cv2.morphologyEx(mask.astype(np.uint8), cv2.MORPH_GRADIENT, np.ones((3, 3), np.uint8)) > 0
    cut = int(mask[0].sum() + mask[:, 0].sum() + mask[:, -1].sum())
    return HairMeasures(
        area=float(mask.sum()) / zones.head**2,
        agreement=float((mask & other).sum()) / union if union else 1.0,
        inside=float(posterior[mask].mean()) if mask.any() else 0.0,
        outside=float(posterior[ring].mean()) if ring.any() else 0.0,
        topped=float(top.mean()) if len(top) else 0.0,
        border=cut / max(1, int((edge & mask).sum())),
        hat=float(hat[mask].sum()) / max(float(posterior[mask].sum()), 1e-6),
        outlined=float((_change(lab)[edge] > _CHANGE).mean()) if edge.any() else 0.0,
    )


def _change(lab: Singles) -> Singles:
    """How much the colours change (h, w) over a few pixels."""
    smooth = cv2.GaussianBlur(lab, (0, 0), _EDGE)
    slopes = [cv2.Sobel(smooth, cv2.CV_32F, dx, 1 - dx, scale=_ACROSS / 8) for dx in (0, 1)]
    return np.sqrt((slopes[0] ** 2 + slopes[1] ** 2).sum(axis=2)).astype(np.float32)


# Name of the measure, least and largest value that is trusted, what is said otherwise. Hat was set on renders: half of
# their hats pass for hair, and hair of drawings reaches 0.19. Certainty and outlined were set on 120 fresh renders: 40
# are trusted instead of 37, and 26 instead of 23 of these overlap the true hair by 0.85. The limits of agreement and
# inside only keep out what is good in one of them alone.
RULES = (
    ("area", 0.08, 9.0, "there is hardly any hair"),
    ("hat", 0.0, 0.2, "a hat covers the hair"),
    ("topped", 0.5, 1.0, "hair does not top the head"),
    ("agreement", 0.85, 1.0, "two ways to cut the hair disagree"),
    ("inside", 0.65, 1.0, "what looks like hair is doubtful"),
    ("certainty", 1.58, 2.0, "hair is hard to tell from what is around it"),
    ("outlined", 0.9, 1.0, "the picture shows no outline where the hair would end"),
    ("border", 0.0, 0.35, "the picture's border cuts the hair"),
)


def distrust(measures: HairMeasures) -> tuple[str, ...]:
    """Why a mask is not to be trusted; empty if it is."""
    return tuple(text for name, least, most, text in RULES if not least <= getattr(measures, name) <= most)
