"""What the first guess says about a superpixel's surroundings: further numbers for the second trees."""

from __future__ import annotations

import cv2
import numpy as np

from toongeo.arrays import Singles
from toongeo.pipeline.parse.hair.colour_evidence import colour_evidence
from toongeo.pipeline.parse.hair.head_zones import HeadZones
from toongeo.pipeline.parse.hair.superpixels import LIGHTNESS, Superpixels

__all__ = ["context"]


_NEAR, _WIDE = 6.0, 20.0  # px of the view
_SURE, _NOT = 0.6, 0.05  # posterior of sure hair and of what is surely none


def context(zones: HeadZones, patches: Superpixels, guess: Singles) -> dict[str, Singles]:
    """Numbers (k,) by name, from the first posterior (k, 3) of other, hair and hat."""
    cover = guess[:, 1] + guess[:, 2]
    field = cover[patches.labels]
    mean = patches.mean
    weight = cover**2 * patches.area
    colour = (patches.colours * weight[:, None]).sum(0) / max(float(weight.sum()), 1e-6)
    high = float(np.percentile(cover, 97))
    mirrored = _mirrored(zones, np.dstack([field, patches.lab]).astype(np.float32))
    above = np.maximum.accumulate(cv2.GaussianBlur(field, (0, 0), 1.5), axis=0)
    hat = guess[:, 2][patches.labels]
    return {
        "cover": cover,
        "hat": guess[:, 2],
        "evidence": mean(colour_evidence(patches.lab, field**2, 1 - field**2)),
        "near": mean(cv2.GaussianBlur(field, (0, 0), _NEAR)),
        "wide": mean(cv2.GaussianBlur(field, (0, 0), _WIDE)),
        "near hat": mean(cv2.GaussianBlur(hat, (0, 0), _NEAR)),
        "wide hat": mean(cv2.GaussianBlur(hat, (0, 0), _WIDE)),
        "way hair": patches.way(cover > max(_SURE, 0.9 * high)),
        "way other": patches.way(cover < _NOT),
        "away hair": np.linalg.norm((patches.colours - colour) * LIGHTNESS, axis=1).astype(np.float32),
        "above": mean(above),
        "mirrored cover": mean(mirrored[..., 0]),
        "mirrored colour": mean(np.linalg.norm((mirrored[..., 1:] - patches.lab) * LIGHTNESS, axis=2)),
        "amount": np.full(len(cover), (weight * (mean(zones.up) > 0)).sum() / zones.head**2, np.float32),
        "highest": np.full(len(cover), high, np.float32),
    }


def _mirrored(zones: HeadZones, layers: Singles) -> Singles:
    """Layers (h, w, c) as they are on the other side of the face's middle line."""
    height, width = zones.across.shape
    # across and up are linear in x and y: across = gx x + gy y + c, with a gradient of one over the face's length
    gx, gy = zones.across[0, 1] - zones.across[0, 0], zones.across[1, 0] - zones.across[0, 0]
    square = max(float(gx * gx + gy * gy), 1e-12)
    y, x = np.mgrid[:height, :width].astype(np.float32)
    shift = 2 * zones.across / square
    return np.asarray(
        cv2.remap(layers, x - shift * gx, y - shift * gy, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
    )
