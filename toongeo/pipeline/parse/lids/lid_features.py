"""What speaks for and against a contour being the lids of an eye.

Constants were chosen on the seven examples and 15 caricatures (``benchmarks/snapping.py``).
"""

from __future__ import annotations

import numpy as np

from toongeo.arrays import Singles
from toongeo.pipeline.parse.lids.lid_candidates import ARC, LidCandidates
from toongeo.pipeline.parse.lids.lid_patch import CHANNELS

__all__ = ["lid_features"]

# px along the outward normal; two bands are the mean of two lines
_INSIDE, _LINE, _OUTSIDE, _BEYOND = (-4.5, -2.5), (0.0,), (1.0, 3.0), (7.0,)
_FULL_OPENING = 9.0  # px; in narrower eyes the samples inside move closer to the lid
_SHUT = 4.0  # px; how fast an eye counts as open
_RINGS = np.array([0.2, 0.45, 0.7, 0.9], np.float32)  # of the way from the middle to the contour
# Samples of the contour that belong to each part; corners are 0 (outer) and ARC (inner).
_PARTS = {
    "upper": np.arange(2, ARC - 1),
    "lower": np.arange(ARC + 2, 2 * ARC - 1),
    "outer": np.array([2 * ARC - 1, 0, 1]),
    "inner": np.array([ARC - 1, ARC, ARC + 1]),
}
_EYE, _NON_SKIN, _STROKE, _LIGHT, _RED, _YELLOW, _BROW = range(len(CHANNELS))


def lid_features(channels: Singles, candidates: LidCandidates) -> dict[str, Singles]:
    """Numbers (k,) by name for k candidates: contrast across lids and corners, what is inside, how far they moved.

    Parameters
    ----------
    channels : (h, w, 7) float32
        Of a `LidPatch`.
    candidates : LidCandidates
    """
    contours = candidates.contours.astype(np.float32)
    opening = np.linalg.norm(contours[:, ARC // 2] - contours[:, ARC + ARC // 2], axis=1)
    bands = _bands(channels, contours, opening)
    middle = contours.mean(axis=1, keepdims=True)[:, None]
    rings = _taken(channels, middle + (contours[:, None] - middle) * _RINGS[:, None, None])  # (k, 4, 32, c)
    found: dict[str, Singles] = {}
    for part, where in _PARTS.items():
        contrast = _contrast(*(band[:, where] for band in bands))
        found |= {f"{part} {name}": value for name, value in contrast.items()}
    content = _content(rings)
    shut = {f"shut {name}": np.exp(-opening / _SHUT) * value for name, value in _slit(bands, content).items()}
    return found | content | _near_brow(bands) | shut | _moved(candidates)


def _bands(channels: Singles, contours: Singles, opening: Singles) -> list[Singles]:
    """Channels (k, 32, c) just inside, on, just outside and farther outside the contours."""
    along = np.roll(contours, -1, axis=1) - np.roll(contours, 1, axis=1)
    normal = np.stack([along[..., 1], -along[..., 0]], axis=2)
    normal /= np.linalg.norm(normal, axis=2, keepdims=True) + np.float32(1e-9)
    outwards = ((contours - contours.mean(axis=1, keepdims=True)) * normal).sum(axis=(1, 2))
    normal *= np.sign(outwards)[:, None, None]
    narrow = np.minimum(1.0, opening / _FULL_OPENING)[:, None, None].astype(np.float32)
    lines = [
        [
            _taken(channels, contours + normal * (offset * narrow if offset < 0 else np.float32(offset)))
            for offset in band
        ]
        for band in (_INSIDE, _LINE, _OUTSIDE, _BEYOND)
    ]
    return [sum(band[1:], band[0]) / np.float32(len(band)) for band in lines]


def _taken(channels: Singles, points: Singles) -> Singles:
    """Channels at the nearest pixels; beyond the border the last ones go on."""
    height, width, count = channels.shape
    column = np.clip(points[..., 0] + np.float32(0.5), 0, width - 1).astype(np.int32)
    row = np.clip(points[..., 1] + np.float32(0.5), 0, height - 1).astype(np.int32)
    return channels.reshape(-1, count).take(row * width + column, axis=0)


def _contrast(inside: Singles, line: Singles, outside: Singles, beyond: Singles) -> dict[str, Singles]:
    """Contrast across a part of the contour, from its samples (k, m, c) in each band."""
    edge = inside - outside
    step = edge.mean(axis=1)
    valley = line[..., _LIGHT] - 0.5 * (inside[..., _LIGHT] + outside[..., _LIGHT])
    return {
        "eye": step[:, _EYE],
        "eye outside": outside[..., _EYE].mean(axis=1),
        "non_skin": step[:, _NON_SKIN],
        "light": step[:, _LIGHT],
        "redness": step[:, _RED],
        "yellowness": step[:, _YELLOW],
        "valley": valley.mean(axis=1),
        "stroke": line[..., _STROKE].mean(axis=1),
        "edge": np.abs(edge[..., _LIGHT]).mean(axis=1),
        "hue edge": np.hypot(edge[..., _RED], edge[..., _YELLOW]).mean(axis=1),
        "non_skin beyond": beyond[..., _NON_SKIN].mean(axis=1),
    }


def _content(rings: Singles) -> dict[str, Singles]:
    """What lies inside, from samples (k, 4, 32, c) on smaller copies of the contour."""
    means = rings.mean(axis=2)
    area = np.tensordot(means, _RINGS / _RINGS.sum(), axes=(1, 0))  # rings count by their length
    core, rim = means[:, 0], means[:, -1]
    return {
        "area eye": area[:, _EYE],
        "area non_skin": area[:, _NON_SKIN],
        "area stroke": area[:, _STROKE],
        "area light": area[:, _LIGHT],
        "area redness": area[:, _RED],
        "area yellowness": area[:, _YELLOW],
        "area brow": area[:, _BROW],
        "core non_skin": core[:, _NON_SKIN],
        "core light": core[:, _LIGHT],
        "rim non_skin": rim[:, _NON_SKIN],
        "rim light": rim[:, _LIGHT],
        "area contrast": (rings[..., _LIGHT] ** 2).mean(axis=(1, 2)),
        "dark core": core[:, _LIGHT] * area[:, _NON_SKIN],
    }


def _near_brow(bands: list[Singles]) -> dict[str, Singles]:
    _, line, _, beyond = bands
    upper = _PARTS["upper"]
    return {
        "brow on upper": line[:, upper, _BROW].mean(axis=1),
        "brow beyond upper": beyond[:, upper, _BROW].mean(axis=1),
    }


def _slit(bands: list[Singles], content: dict[str, Singles]) -> dict[str, Singles]:
    """What a shut eye shows: a dark line rather than an opening."""
    _, line, outside, beyond = (band[..., _LIGHT] for band in bands)
    upper, lower = (
        line[:, _PARTS[lid]].mean(axis=1) - outside[:, _PARTS[lid]].mean(axis=1) for lid in ("upper", "lower")
    )
    return {
        "eye": np.ones_like(upper),
        "upper line": upper,
        "lower line": lower,
        "area eye": content["area eye"],
        "area non_skin": content["area non_skin"],
        "area light": content["area light"],
        "core line": content["core light"] - beyond[:, _PARTS["upper"]].mean(axis=1),
    }


def _moved(candidates: LidCandidates) -> dict[str, Singles]:
    """How far a candidate is from the given contour; 1 is a tenth of the outer-eye distance."""
    x, y = candidates.shifts.T / 10.0
    grown, far = candidates.growths * 10.0, np.hypot(x, y)
    size = np.log(candidates.radius * candidates.scales[:, 0])
    taller = np.log(candidates.scales[:, 1] / candidates.scales[:, 0])
    found = {
        "moved": far,
        "moved²": far**2,
        "moved x": x,
        "moved y": y,
        "moved y²": y**2,
        "unmoved": (far < 0.1).astype(np.float64),
        "grown": grown,
        "grown²": grown**2,
        "|grown|": np.abs(grown),
        "moved |grown|": far * np.abs(grown),
        "size": size,
        "taller": taller,
        "taller |grown|": taller * np.abs(grown),
        "taller moved": taller * far,
    }
    return {name: value.astype(np.float32) for name, value in found.items()}
