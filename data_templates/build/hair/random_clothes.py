"""What shows below a random head: shoulders, collars, coats, scarves."""

from __future__ import annotations

import cv2
import numpy as np
from noise import Floats, Rng, chance, clouds
from random_head import Head, Mask

__all__ = ["random_clothes"]


def random_clothes(rng: Rng, head: Head, hair: Floats, drawn: bool) -> tuple[Mask, Floats]:
    """Pixels (h, w) bool of clothes, face excepted, and their look (h, w, 3), 0-255."""
    empty = np.zeros(head.seen.shape, bool)
    colour = _colour(rng, hair)
    look = np.broadcast_to(colour, (*empty.shape, 3)).astype(np.float32)
    if chance(rng, 0.12):
        return empty, look
    neck = float(np.abs(head.across[head.neck]).max(initial=0.25))
    base, drop = -rng.uniform(0.66, 0.95), rng.uniform(0.1, 0.5)
    wide = rng.uniform(0.75, 1.3)
    neckline = [(-neck, base), (0, base - rng.uniform(0, 0.4)), (neck, base)]
    shoulders = [(wide, base - drop), (1.4 * wide, -3), (-1.4 * wide, -3), (-wide, base - drop)]
    body = _filled(head, neckline + shoulders)
    if not drawn or chance(rng, 0.6):
        folds = clouds(rng, empty.shape, 0.7)
        look = look * (1 + rng.uniform(0.05, 0.4) * folds)[..., None]
    if chance(rng, 0.2):  # stripes, checks
        period = rng.uniform(0.02, 0.2)
        wave = np.sin(head.across * 2 * np.pi / period) + chance(rng, 0.5) * np.sin(head.up * 2 * np.pi / period)
        look = np.where((wave > 0.3)[..., None], np.clip(colour + rng.normal(0, 50, 3), 0, 255), look)
    if chance(rng, 0.4):  # a shirt under a coat
        tip = rng.uniform(-1.6, -1.1)
        shirt = _filled(head, [(-neck, base), (neck, base), (rng.normal(0, 0.05), tip)])
        look = np.where(shirt[..., None], np.clip(rng.uniform(120, 255) + rng.normal(0, 12, 3), 0, 255), look)
        body |= shirt
        if chance(rng, 0.5):
            tie = _filled(head, [(-0.06, base - 0.1), (0.06, base - 0.1), (0.1, -2), (-0.1, -2)])
            look = np.where((tie & shirt)[..., None], rng.uniform(0, 200, 3), look)
    if chance(rng, 0.4):  # a collar that stands up, a scarf, a ruff
        tall, flare = rng.uniform(0.05, 0.45), rng.uniform(0.0, 0.3)
        outer = neck * rng.uniform(1.0, 1.5)
        for side in (-1, 1):
            inner = side * neck * rng.uniform(0.0, 0.8)
            tips = [(side * (outer + flare), base + tall), (side * neck * rng.uniform(0.7, 1.0), base + tall * 0.8)]
            body |= _filled(head, [(inner, base - 0.25), (side * outer, base - 0.2), *tips])
        if chance(rng, 0.4):
            scarf = (np.abs(head.across) < outer) & (head.up < base + tall * 0.6) & (head.up > base - 0.25)
            wool = _colour(rng, hair) * (1 + 0.1 * np.sin(head.up * 90))[..., None]
            look = np.where(scarf[..., None], wool, look)
            body |= scarf
    bare = (head.face & (head.up > base + 0.02)) | head.scalp | head.ears
    return body & ~bare, np.clip(look, 0, 255).astype(np.float32)


def _colour(rng: Rng, hair: Floats) -> Floats:
    """Dark often, the hair's own at times."""
    kind = rng.random()
    if kind < 0.25:
        return np.clip(hair * rng.uniform(0.6, 1.3) + rng.normal(0, 8, 3), 0, 255).astype(np.float32)
    level = rng.uniform(5, 60) if kind < 0.55 else rng.uniform(20, 250)
    return np.clip(level + rng.normal(0, rng.choice([6, 45]), 3), 0, 255).astype(np.float32)


def _filled(head: Head, points: list[tuple[float, float]]) -> Mask:
    canvas = np.zeros(head.seen.shape, np.uint8)
    cv2.fillPoly(canvas, [np.rint(head.place(np.array(points, float)) * 8).astype(np.int32)], 1, shift=3)
    return canvas > 0
