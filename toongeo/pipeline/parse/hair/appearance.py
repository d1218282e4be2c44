"""What each superpixel looks like and where it lies: the numbers from which the first trees tell hair."""

from __future__ import annotations

import cv2
import numpy as np

from toongeo.arrays import Singles
from toongeo.pipeline.parse.hair.head_zones import HeadZones
from toongeo.pipeline.parse.hair.superpixels import LIGHTNESS, Superpixels
from toongeo.pipeline.parse.masks import grown, signed_distance

__all__ = ["appearance"]


_FAR = 0.15  # head sizes off the skull: there is ground, or clothes
_RING = 0.05  # head sizes about the skull, where hair begins
_BORDER = 3  # px of the view along its border
_CHEST = -1.25  # faces: below this there are clothes
_HIGH = 0.45  # faces above the brows: certainly not forehead
_ALIKE = 8.0  # CIELAB units within which a colour counts as another
_FEWEST = 20  # px for a sample of colours
_SAMPLES = 3000  # px at most for a sample


def appearance(zones: HeadZones, patches: Superpixels) -> dict[str, Singles]:
    """Numbers (k,) by name. Left and right are alike in all, so that a mirrored picture gives the same."""
    lab, mean = patches.lab, patches.mean
    edge = np.zeros(zones.skull.shape, bool)
    edge[:_BORDER] = edge[:, :_BORDER] = edge[:, -_BORDER:] = True
    off = ~grown(zones.skull, _FAR * zones.head)
    ground = edge & (zones.up > -0.9)
    ground = ground & off if (ground & off).sum() >= _FEWEST else ground
    chest = (zones.up < _CHEST) & off
    skin = lab[zones.plain] if zones.plain.sum() >= _FEWEST else lab[zones.hull]
    skin = skin if len(skin) else lab.reshape(-1, 3)
    tone = np.median(skin, axis=0)
    ring = grown(zones.skull, _RING * zones.head) & (zones.up > 0.25) & ~zones.hull
    top = ring & (zones.up > _HIGH)
    brow = lab[zones.brow]
    dark = brow[brow[:, 0] <= np.percentile(brow[:, 0], 40)] if len(brow) else brow
    away = {
        "skin": _distance(lab, _tones(skin, 4)),
        "ground": _distance(lab, _tones(lab[ground], 5)),
        "chest": _distance(lab, _tones(lab[chest], 4)),
        "brow": _distance(lab, _tones(dark, 2)),
        "top": _distance(lab, _tones(lab[top if top.sum() > 30 else ring], 4)),
    }
    colours = patches.colours
    found = {
        "aside": mean(np.abs(zones.across)),
        "up": mean(zones.up),
        "off skull": mean(signed_distance(zones.skull) / zones.head),
        "off hull": mean(signed_distance(zones.hull) / zones.head),
        **{name: mean(getattr(zones, name)) for name in ("skull", "crown", "ears", "brow")},
        **{f"colour {c}": colours[:, k] for k, c in enumerate("Lab")},
        **{f"from skin {c}": colours[:, k] - tone[k] for k, c in enumerate("Lab")},
        "chroma": np.hypot(colours[:, 1], colours[:, 2]),
        **{f"away {name}": mean(field) for name, field in away.items()},
        **{f"share {name}": mean(away[name] < _ALIKE) for name in ("skin", "ground", "chest", "top")},
        "way ground": patches.way(mean(ground) > 0.3),
        "way face": patches.way(mean(zones.plain) > 0.8),
        "way crown": patches.way((mean(zones.crown) > 0.8) & (mean(zones.up) > _HIGH)),
        "way chest": patches.way(mean(chest) > 0.8),
        "edge ground": patches.way(mean(ground) > 0.3, 3),
        "edge face": patches.way(mean(zones.plain) > 0.8, 3),
        "border": mean(edge),
    }
    found |= {name: mean(field) for name, field in _texture(lab[..., 0], zones).items()}
    plain = float((away["ground"][ground] < 4).mean()) if ground.any() else 0.0
    whole = {
        "plain ground": plain / max(1, len(_tones(lab[ground], 5))),
        "light skin": tone[0],
        "light ground": float(np.median(lab[ground][:, 0])) if ground.any() else 0.0,
        "colourful": float(np.hypot(lab[..., 1], lab[..., 2]).mean()),
        "strange top": float(np.median(away["skin"][top])) if top.any() else 0.0,
    }
    return found | {name: np.full(len(colours), value, np.float32) for name, value in whole.items()}


def _tones(sample: Singles, count: int) -> Singles:
    """A few colours (m, 3) that stand for a sample (n, 3); rare ones are left out."""
    if len(sample) < 12:
        return np.zeros((0, 3), np.float32)
    sample = np.ascontiguousarray(sample[:: max(1, len(sample) // _SAMPLES)], np.float32)
    cv2.setRNGSeed(0)  # k-means starts at random
    stop = (cv2.TERM_CRITERIA_COUNT + cv2.TERM_CRITERIA_EPS, 15, 0.5)
    labels = np.zeros((len(sample), 1), np.int32)
    _, label, centres = cv2.kmeans(sample, min(count, len(sample)), labels, stop, 1, cv2.KMEANS_PP_CENTERS)
    share = np.bincount(np.ravel(label), minlength=len(centres)) / len(sample)
    return np.asarray(centres[share > 0.06], np.float32)


def _distance(lab: Singles, tones: Singles) -> Singles:
    """To the nearest of some colours (h, w); far from all if there are none."""
    if len(tones) == 0:
        return np.full(lab.shape[:2], 60, np.float32)
    points, centres = (lab * LIGHTNESS).reshape(-1, 3), tones * LIGHTNESS
    square = (points**2).sum(axis=1) + np.min((centres**2).sum(axis=1) - 2 * points @ centres.T, axis=1)
    return np.sqrt(np.maximum(square, 0)).reshape(lab.shape[:2]).astype(np.float32)


def _texture(light: Singles, zones: HeadZones) -> dict[str, Singles]:
    """Contrast, and how far it runs in one direction (structure tensor), and in that of hair from the crown."""
    smooth = cv2.GaussianBlur(light, (0, 0), 0.8)
    gx, gy = cv2.Sobel(smooth, cv2.CV_32F, 1, 0), cv2.Sobel(smooth, cv2.CV_32F, 0, 1)
    outwards = np.arctan2(-zones.up, np.abs(zones.across)) - np.pi / 2
    found: dict[str, Singles] = {"rough fine": np.abs(light - cv2.GaussianBlur(light, (0, 0), 1.5))}
    for name, scale in (("fine", 2.0), ("broad", 5.0)):
        xx, yy, xy = (cv2.GaussianBlur(g, (0, 0), scale) for g in (gx * gx, gy * gy, gx * gy))
        energy = xx + yy
        coherence = np.sqrt((xx - yy) ** 2 + 4 * xy**2) / (energy + 20)
        # The picture is folded along the middle line, where the direction of gradients is mirrored too.
        direction = 0.5 * np.arctan2(2 * xy * np.where(zones.across < 0, -1, 1), xx - yy)
        found[f"energy {name}"] = np.log1p(np.sqrt(energy))
        found[f"coherence {name}"] = coherence
        found[f"flow {name}"] = coherence * np.cos(2 * (direction - outwards))
    level = cv2.GaussianBlur(light, (0, 0), 5)
    found["rough broad"] = np.sqrt(np.maximum(cv2.GaussianBlur(light * light, (0, 0), 5) - level * level, 0))
    return found
