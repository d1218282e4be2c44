"""The trees that tell hair and hats, from the file that travels with the library."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np

from toongeo.arrays import Singles
from toongeo.model.data_path import data_path
from toongeo.pipeline.parse.hair.appearance import appearance
from toongeo.pipeline.parse.hair.boosted_trees import BoostedTrees
from toongeo.pipeline.parse.hair.context import context
from toongeo.pipeline.parse.hair.head_zones import HeadZones
from toongeo.pipeline.parse.hair.superpixels import Superpixels

__all__ = ["HairModel", "hair_model"]


@dataclass(frozen=True, eq=False)
class HairModel:
    """Two sets of trees: the second sees what the first guessed around each superpixel (auto-context, Tu 2008)."""

    first: BoostedTrees
    second: BoostedTrees

    def __call__(self, zones: HeadZones, patches: Superpixels) -> tuple[Singles, Singles]:
        """The guess and the answer: probabilities (k, 3) of other, hair and hat for each superpixel."""
        numbers = np.column_stack(list(appearance(zones, patches).values()))
        guess = self.first(numbers)
        around = np.column_stack(list(context(zones, patches, guess).values()))
        return guess, self.second(np.column_stack([numbers, around]))


@cache
def hair_model() -> HairModel:
    """The model of ``data_templates/hair.npz``, trained on renders of the template alone."""
    with np.load(data_path("data_templates/hair.npz"), allow_pickle=False) as archive:
        stages = [
            BoostedTrees(*(archive[f"{stage}_{name}"] for name in ("features", "thresholds", "leaves", "start")))
            for stage in ("first", "second")
        ]
    return HairModel(*stages)
