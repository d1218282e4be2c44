"""Where the lids are: the mean over many contours, each weighted by how likely it is.

Constants were chosen on the seven examples and 15 caricatures (``benchmarks/snapping.py``).
"""

from __future__ import annotations

import csv
from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

from toongeo.arrays import Floats
from toongeo.geometry.one_thread import one_thread
from toongeo.model.data_path import data_path
from toongeo.pipeline.parse.lids.lid_candidates import LidCandidates, lid_candidates, lid_contour
from toongeo.pipeline.parse.lids.lid_features import lid_features
from toongeo.pipeline.parse.lids.lid_patch import RESOLUTION, LidPatch, lid_patch
from toongeo.pipeline.parse.lids.refine_lids import refine_lids

__all__ = ["Lids", "LidWeights", "candidate_probabilities", "find_lids", "lid_weights"]

_DOUBT = 0.05  # outer-eye distances: a scatter of the likely contours that leaves 1/e of the confidence


@dataclass(frozen=True, eq=False)
class Lids:
    """The opening of an eye.

    Attributes
    ----------
    contour : (32, 2) float64, px of the picture
        From one corner over the upper lid to the other and back over the lower one.
    confidence : float in [0, 1]
    """

    contour: Floats
    confidence: float


@dataclass(frozen=True, eq=False)
class LidWeights:
    """A linear model of log-probability: ``sum weight * (feature - mean) / deviation``.

    Attributes
    ----------
    names : tuple of str
    mean, deviation, weight : (f,) float64
    """

    names: tuple[str, ...]
    mean: Floats
    deviation: Floats
    weight: Floats


@cache
def lid_weights() -> LidWeights:
    """The weights that come with the library; ``data_templates/build/lid_weights.py`` makes them."""
    with open(data_path("data_templates/lid_weights.csv"), encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    columns = (np.array([float(row[key]) for row in rows]) for key in ("mean", "deviation", "weight"))
    return LidWeights(tuple(row["feature"] for row in rows), *columns)


def candidate_probabilities(patch: LidPatch, candidates: LidCandidates, weights: LidWeights) -> Floats:
    """How likely each of k candidates is, (k,), summing to 1."""
    features = lid_features(patch.channels, candidates)
    rows = np.column_stack([features[name] for name in weights.names]).astype(np.float64)
    score = ((rows - weights.mean) / weights.deviation) @ weights.weight
    likely = np.exp(score - score.max())
    return likely / likely.sum()


def find_lids(img: NDArray[np.uint8], landmarks: Floats, side: str, weights: LidWeights | None = None) -> Lids:
    """The lids of one eye near landmarks that may be shifted or shrunken.

    Shifted and scaled copies of the given eye are weighed by what the picture shows inside them and across their
    line. Their mean is the answer, which stays close to the landmarks where the picture does not say; a closed
    active contour then moves it to the edge.

    Parameters
    ----------
    img : (H, W, 3) uint8 RGB
    landmarks : (68, 2) float64, px, none missing
    side : {"left", "right"}
        Of the subject.
    weights : LidWeights, optional
        `lid_weights` if None.
    """
    with one_thread():
        patch = lid_patch(img, landmarks, side)
        contour = lid_contour(patch.lids)
        candidates = lid_candidates(contour)
        likely = candidate_probabilities(patch, candidates, weights or lid_weights())
    middle = contour.mean(axis=0)
    found = middle + likely @ candidates.shifts + (likely @ candidates.scales) * (contour - middle)
    away = ((candidates.contours - found) ** 2).sum(axis=2).mean(axis=1)  # px²
    scatter = float(np.sqrt(likely @ away)) / RESOLUTION
    return Lids(patch.to_picture(refine_lids(patch.channels, found)), float(np.exp(-scatter / _DOUBT)))
