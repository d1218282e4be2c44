"""How many tones a part of a drawing has, and a picture's part in as many."""

from dataclasses import dataclass

import numpy as np

from toongeo.arrays import Floats, Singles
from toongeo.pipeline.stylize.appearance.pixels import soft_step

__all__ = ["Tones", "in_tones", "tones_of"]

_MOST, _LEAST_SHARE = 4, 0.06  # tones of a part; a tone covers so much of it at least
_WIDTH = 2.0  # L* to either side that still are one flat tone
# Of the part that flat tones cover; else it is shaded smoothly. Of normally spread skin (8 L*) four tones cover 0.68.
_FLAT = 0.8
_ROUNDS = 20  # of k-means in one dimension
_STEP = 0.6  # L*, of the step between tones: a pixel or two of an edge


@dataclass(frozen=True, eq=False)
class Tones:
    """Flat tones, from dark to light.

    Attributes
    ----------
    colours : (k, 3) float, CIELAB
    """

    colours: Floats


def tones_of(lab: Singles) -> Tones | None:
    """The tones of pixels (n, 3), CIELAB, or None if they are shaded smoothly."""
    lightness, left = lab[:, 0], np.ones(len(lab), bool)
    found: list[Floats] = []
    while len(found) < _MOST and left.any():
        counts = np.bincount(np.clip(lightness[left] * 2, 0, 200).astype(int), minlength=201)
        sums = np.convolve(counts, np.ones(round(4 * _WIDTH) + 1), "same")
        middle = np.argmax(sums) / 2 + 0.25
        own = left & (np.abs(lightness - middle) <= _WIDTH)
        if own.sum() < _LEAST_SHARE * len(lab):
            break
        found.append(lab[own].mean(axis=0))
        left &= ~own
    if not found or 1 - left.mean() < _FLAT:
        return None
    return Tones(np.array(sorted(found, key=lambda colour: float(colour[0])), np.float64))


def in_tones(lab: Singles, known: Floats, tones: Tones) -> Singles:
    """A picture (h, w, 3), CIELAB, in the tones of another: the darkest of as many clusters of its lightness takes the
    darkest tone, and so on (optimal transport between sorted clusters). ``known`` (n,) L* are the part's."""
    centres = np.quantile(known, (np.arange(len(tones.colours)) + 0.5) / len(tones.colours))
    for _ in range(_ROUNDS):
        nearest = np.abs(known[:, None] - centres).argmin(axis=1)
        held = np.bincount(nearest, minlength=len(centres))
        sums = np.bincount(nearest, known, len(centres))
        centres = np.sort(np.where(held > 0, sums / np.maximum(held, 1), centres))
    result = np.broadcast_to(tones.colours[0].astype(np.float32), lab.shape).copy()
    for border, colour in zip((centres[1:] + centres[:-1]) / 2, tones.colours[1:], strict=True):
        above = soft_step(lab[..., 0] - np.float32(border), _STEP)[..., None]
        result += above * (colour.astype(np.float32) - result)
    return result
