"""Superpixels of a picture with known hair, as the trees see them."""

from __future__ import annotations

from dataclasses import dataclass
from types import SimpleNamespace

import cv2
import numpy as np
from noise import Floats
from numpy.typing import NDArray
from random_picture import Picture

from toongeo.colour.cielab import cielab
from toongeo.pipeline.fit.fit_3dmm import fit_3dmm
from toongeo.pipeline.parse.hair.appearance import appearance
from toongeo.pipeline.parse.hair.context import context
from toongeo.pipeline.parse.hair.hair_view import hair_view
from toongeo.pipeline.parse.hair.head_zones import head_zones
from toongeo.pipeline.parse.hair.superpixels import Superpixels, superpixels

__all__ = ["TrainingRows", "training_rows"]


@dataclass(frozen=True, eq=False)
class TrainingRows:
    """Superpixels of a view, their numbers (k, f), and shares (k, 3) of other, hair and hat; kept small."""

    across: NDArray[np.float16]
    up: NDArray[np.float16]
    head: float
    labels: NDArray[np.int16]
    lab: NDArray[np.float16]
    numbers: Floats
    shares: Floats

    def context(self, guess: Floats) -> Floats:
        """Numbers (k, g) of the superpixels' surroundings by a first guess (k, 3)."""
        zones = SimpleNamespace(across=self.across.astype(np.float32), up=self.up.astype(np.float32), head=self.head)
        patches = Superpixels(self.labels.astype(np.intp), self.lab.astype(np.float32))
        return np.column_stack(list(context(zones, patches, guess).values()))

    @property
    def area(self) -> Floats:
        return np.bincount(self.labels.ravel()).astype(np.float32)


def training_rows(picture: Picture) -> TrainingRows:
    fit = fit_3dmm(None, picture.landmarks)
    view = hair_view(picture.img, fit)
    zones = head_zones(view, picture.landmarks, fit)
    patches = superpixels(cielab(view.pixels))
    numbers = np.column_stack(list(appearance(zones, patches).values()))
    height, width = zones.skull.shape
    labels = cv2.resize(picture.labels[view.window()], (width, height), interpolation=cv2.INTER_NEAREST)
    shares = np.stack([patches.mean(labels == k) for k in range(3)], axis=1)
    half = lambda field: field.astype(np.float16)  # noqa: E731
    labels = patches.labels.astype(np.int16)
    return TrainingRows(half(zones.across), half(zones.up), zones.head, labels, half(patches.lab), numbers, shares)
