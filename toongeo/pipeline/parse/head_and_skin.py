"""A head cut out of its picture, and the skin cut out of the head.

Constants were chosen by eye on the seven examples and 15 caricatures.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray
from skimage.morphology import remove_small_holes

from toongeo.arrays import Mask
from toongeo.colour.cielab import cielab
from toongeo.pipeline.parse.colour_share import colour_codes, colour_share
from toongeo.pipeline.parse.cut_out import cut_out
from toongeo.pipeline.parse.face_zones import FaceZones
from toongeo.pipeline.parse.guided_filter import guided_filter
from toongeo.pipeline.parse.masks import grown
from toongeo.pipeline.parse.skin_surface import colour_mode, skin_surface
from toongeo.pipeline.parse.working_view import WorkingView

__all__ = ["HeadAndSkin", "border_confidence", "head_and_skin"]

# Shares of the head's size.
_HAIR = 0.12  # so far beyond the head its hair is likely
_FAR = 0.5  # so far beyond head and neck there is only background
_CORE = 0.03  # so far inside the jaw line it is face for sure
_SKIN = 0.1  # so far beyond the fitted head its skin may go on
_STROKE = 0.02  # breadth of the broadest outline
_CLEAR = 0.05  # of the border of the fitted head may be wrong
_RIM = 0.08  # breadth of the picture's border that is looked at
_EDGE = 0.015  # over so much a soft border falls off

_STEP = 2  # levels, 0-255, between neighbours of a smooth background
_RARE = 0.003  # share of the pixels that a colour must have to be one of the head's
_LIKE_SKIN = 2.5  # spreads of the skin's colour
_DARK, _VALLEY = 40.0, 20.0  # lightness below which, and depth above which, a line is an outline
_SOFTNESS = 1e-3  # of the guided filter, squared colour differences


@dataclass(frozen=True, eq=False)
class HeadAndSkin:
    """Masks (h, w) bool of a working view.

    Attributes
    ----------
    head : what belongs to the head: skin, hair, neck, what is worn
    skin : skin, without outlines
    non_skin : how unlike skin a colour is, (h, w) in [0, 1]
    outline : dark strokes
    """

    head: Mask
    skin: Mask
    non_skin: NDArray[np.float32]
    outline: Mask


def head_and_skin(view: WorkingView, zones: FaceZones) -> HeadAndSkin:
    """Two cuts: head from background, seeded by the fitted head; skin from the rest, by its own colour."""
    lab = cielab(view.pixels)
    outline = _outline(lab[..., 0], _STROKE * view.head)
    core = grown(zones.hull, -_CORE * view.head)
    features = zones.eyes | zones.brow_left | zones.brow_right | zones.inner_mouth | zones.upper_lip | zones.lower_lip
    non_skin = _non_skin(lab, core & ~features & ~outline, zones)
    colours = np.asarray(cv2.cvtColor(view.pixels, cv2.COLOR_RGB2LAB), np.uint8)
    body = zones.silhouette | zones.neck
    behind = _behind(view, body)
    likely, border = _likely_head(view, zones, behind)
    head = cut_out(
        colours,
        sure=core,
        likely=likely,
        never=~grown(body, _FAR * view.head) | border | (behind & ~core),
    )
    near = grown(body, _SKIN * view.head)
    skin = cut_out(
        colours,
        sure=core & ~features & (non_skin < 0.5) & ~outline,
        likely=near & (non_skin < 0.6) & ~outline & ~features,
        never=~near | outline | ~(head | core),
    )
    head = _one_piece(head | skin, core)
    skin = skin & ~features | (features & (non_skin < 0.5) & ~outline)
    return HeadAndSkin(head, skin, non_skin, outline)


def border_confidence(view: WorkingView, cut: HeadAndSkin) -> NDArray[np.float32]:
    """How far the cuts are to be believed, (h, w) in [0, 1]: low where the border of head or skin is doubtful."""
    return np.asarray(np.minimum(_trust(view, cut.head), _trust(view, cut.skin)))


def _behind(view: WorkingView, body: Mask) -> Mask:
    """Background that is one smooth colour: it is reached from the picture's border over tiny steps only.

    Only the upper, left and right border count, where they are clear of the fitted head: shoulders reach the lower one.
    """
    height, width = body.shape
    reached = np.zeros((height + 2, width + 2), np.uint8)
    away = grown(body, _CLEAR * view.head)
    edge = [(x, 0) for x in range(width)] + [(x, y) for y in range(height) for x in (0, width - 1)]
    smooth = cv2.bilateralFilter(view.pixels, 5, 12, 3)
    flags = 4 | (1 << 8) | cv2.FLOODFILL_MASK_ONLY
    for x, y in edge:
        if not away[y, x] and not reached[y + 1, x + 1]:
            cv2.floodFill(smooth, reached, (x, y), 0, (_STEP,) * 3, (_STEP,) * 3, flags)
    return grown(reached[1:-1, 1:-1].astype(bool), -1) & ~grown(body, -_CLEAR * view.head)


def _likely_head(view: WorkingView, zones: FaceZones, behind: Mask) -> tuple[Mask, Mask]:
    """What is likely to be head, and what of the picture's border is not, by how common colours are at either place.

    Likely are the fitted head, and around it what has the colours of its surroundings rather than of the border.
    """
    body = zones.silhouette | zones.neck
    ring = grown(zones.silhouette, _HAIR * view.head)
    width = body.shape[1]
    rim = max(2, round(_RIM * view.head))
    border = np.ones_like(body)
    border[rim:, rim : width - rim] = False
    border &= ~ring & ~body
    far = grown(body, _FAR * view.head)
    ring &= ~zones.below_chin & ~behind
    codes = colour_codes(view.pixels)
    outside, inside = colour_share(codes, border | ~far), colour_share(codes, ring)
    share = inside / np.maximum(inside + outside, 1e-9) * (inside > _RARE)
    likely = (body & ~behind) | (ring & (share > 0.3)) | (far & (share > 0.8) & ~zones.below_chin)
    return likely & ~border, border & (share < 0.8)


def _outline(lightness: NDArray[np.float32], breadth: float) -> Mask:
    """Dark lines that are narrower than some breadth, px."""
    size = 2 * max(1, round(breadth)) + 1
    kernel = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (size, size))
    valley = cv2.morphologyEx(np.ascontiguousarray(lightness), cv2.MORPH_CLOSE, kernel) - lightness
    return (valley > _VALLEY) & (lightness < _DARK)


def _non_skin(lab: NDArray[np.float32], inside: Mask, zones: FaceZones) -> NDArray[np.float32]:
    """How unlike skin each colour is; a quadratic surface follows its shading over the face."""
    samples = lab[inside] if inside.sum() > 16 else lab.reshape(-1, 3)
    seed = colour_mode(samples.astype(np.float64))
    ys, xs = np.nonzero(zones.hull)
    rows, columns = slice(ys.min(), ys.max() + 1), slice(xs.min(), xs.max() + 1)
    surface = skin_surface(lab[rows, columns], seed, inside[rows, columns])
    # Beyond the face its border colours go on: a quadratic would run away.
    pads = ((rows.start, lab.shape[0] - rows.stop), (columns.start, lab.shape[1] - columns.stop), (0, 0))
    expected = np.pad(surface.colour, pads, mode="edge")
    off = ((lab - expected) ** 2).sum(axis=2) / (_LIKE_SKIN * surface.spread) ** 2
    return (1 - np.exp(-0.5 * off)).astype(np.float32)


def _one_piece(mask: Mask, core: Mask) -> Mask:
    """The pieces of a mask that touch the core, without small holes."""
    count, pieces = cv2.connectedComponents(mask.astype(np.uint8))
    kept = np.zeros(count, bool)
    kept[np.unique(pieces[core])] = True
    kept[0] = False
    whole = kept[pieces]
    largest = math.ceil(0.02 * max(int(core.sum()), 1)) - 1  # below a fiftieth of the core
    return np.asarray(remove_small_holes(whole, max_size=largest), np.bool_)


def _trust(view: WorkingView, mask: Mask) -> NDArray[np.float32]:
    """1 where an edge-aware filter leaves the mask as it is, 0 where it leaves a half."""
    radius = max(2, round(2 * _EDGE * view.head))
    guide = view.pixels.astype(np.float32) / np.float32(255)
    soft = guided_filter(guide, mask.astype(np.float32), radius, _SOFTNESS)
    return np.clip(np.abs(2 * soft - 1), 0, 1) * ((soft > 0.5) == mask)
