"""Hats on a random head."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from noise import Floats, Rng, chance, clouds, rounded
from random_head import Head, Mask

__all__ = ["Hat", "random_hat"]


@dataclass(frozen=True, eq=False)
class Hat:
    """mask (h, w) bool, look (h, w, 3) 0-255, and the height in the head frame above which it leaves no hair."""

    mask: Mask
    look: Floats
    rim: float


def random_hat(rng: Rng, head: Head, hair: Floats) -> Hat:
    """A cap, beanie, cylinder, brimmed hat, hood or beret; its colour is at times the hair's."""
    half = float(np.abs(head.across[head.skull]).max())
    rim = rng.uniform(0.08, 0.3)
    tilt = rng.normal(0, 0.12)
    kind = [_cap, _beanie, _cylinder, _brimmed, _hood, _beret][int(rng.choice(6, p=[0.24, 0.2, 0.12, 0.2, 0.14, 0.1]))]
    body, trim = kind(rng, head, half * rng.uniform(1.02, 1.2), rim, tilt)
    colour = (
        hair * rng.uniform(0.6, 1.5)
        if chance(rng, 0.15)
        else np.clip(rng.uniform(10, 240) + rng.normal(0, rng.choice([8, 50]), 3), 0, 255)
    )
    look = np.broadcast_to(colour, (*head.seen.shape, 3)).astype(np.float32)
    look = look * (1 + rng.uniform(0, 0.25) * (head.across / half))[..., None]
    look += clouds(rng, head.seen.shape, 0.9)[..., None] * rng.uniform(0, 14)
    if chance(rng, 0.3):  # knitted, or pieces sewn together
        rays = np.sin(np.arctan2(head.across, head.up - rim + 0.5) * rng.uniform(20, 120))
        look = look * (1 + rng.uniform(0, 0.25) * rays)[..., None]
    other = np.clip(rng.uniform(0, 255, 3) if chance(rng, 0.4) else colour * rng.uniform(0.4, 0.9), 0, 255)
    look = np.where(trim[..., None], other, look).astype(np.float32)
    if chance(rng, 0.25):  # a badge
        x, y = head.place(np.array([[rng.normal(0, 0.08), rim + 0.12]]))[0]
        badge = tuple(float(c) for c in rng.uniform(0, 255, 3))
        look = np.ascontiguousarray(look)
        cv2.circle(look, (int(x), int(y)), int(head.size * rng.uniform(0.03, 0.09)), badge, -1, cv2.LINE_AA)
    return Hat(body | trim, np.clip(look, 0, 255), rim + 0.03)


def _polygon(head: Head, points: list[tuple[float, float]], smooth: bool) -> Mask:
    ring = np.array(points, float)
    ring = head.place(rounded(ring) if smooth else ring)
    canvas = np.zeros(head.seen.shape, np.uint8)
    cv2.fillPoly(canvas, [np.rint(ring * 8).astype(np.int32)], 1, shift=3)
    return canvas > 0


def _ellipse(head: Head, middle: tuple[float, float], axes: tuple[float, float], tilt: float) -> Mask:
    x, y = head.across - middle[0], head.up - middle[1]
    u, v = x * np.cos(tilt) + y * np.sin(tilt), -x * np.sin(tilt) + y * np.cos(tilt)
    return np.asarray((u / axes[0]) ** 2 + (v / axes[1]) ** 2 < 1)


def _above(head: Head, rim: float, tilt: float, sag: float) -> Mask:
    return np.asarray(head.up > rim + tilt * head.across - sag * head.across**2)


def _cap(rng: Rng, head: Head, half: float, rim: float, tilt: float) -> tuple[Mask, Mask]:
    body = _ellipse(head, (0, rim), (half, rng.uniform(0.3, 0.55)), tilt) & _above(head, rim, tilt, rng.uniform(-1, 1))
    aim = rng.normal(0, 0.15)
    axes = half * rng.uniform(0.7, 1.2), rng.uniform(0.05, 0.17)
    visor = _ellipse(head, (aim, rim), axes, tilt + rng.normal(0, 0.1))
    return body, visor & (body | ~_above(head, rim + 0.05, tilt, 0))


def _beanie(rng: Rng, head: Head, half: float, rim: float, tilt: float) -> tuple[Mask, Mask]:
    sag = rng.uniform(0, 1.5)
    body = _ellipse(head, (0, 0.05), (half * rng.uniform(1, 1.12), rng.uniform(0.45, 0.7)), tilt)
    body &= _above(head, rim, tilt, sag)
    band = body & ~_above(head, rim + rng.uniform(0.06, 0.14), tilt, sag) & chance(rng, 0.6)
    if chance(rng, 0.3):
        body |= _ellipse(head, (0, rng.uniform(0.5, 0.65)), (0.1, 0.1), 0)
    return body, band


def _cylinder(rng: Rng, head: Head, half: float, rim: float, tilt: float) -> tuple[Mask, Mask]:
    tall, top = rng.uniform(0.3, 0.9), rng.uniform(0.75, 1.15) * half
    body = _polygon(head, [(-half, rim), (-top, rim + tall), (top + tilt, rim + tall), (half, rim)], chance(rng, 0.2))
    brim = _ellipse(head, (0, rim), (half * rng.uniform(1.1, 1.7), rng.uniform(0.03, 0.1)), tilt)
    return body, brim


def _brimmed(rng: Rng, head: Head, half: float, rim: float, tilt: float) -> tuple[Mask, Mask]:
    tall, top = rng.uniform(0.3, 0.6), rng.uniform(0.45, 0.95) * half
    dent = rng.uniform(0, 0.12)
    points = [(-half, rim), (-top, rim + tall), (0, rim + tall - dent), (top, rim + tall), (half, rim)]
    body = _polygon(head, points, True) | _polygon(head, [points[0], points[2], points[4]], False)
    curve = rng.uniform(-0.3, 0.5)
    brim = np.abs(head.up - rim - tilt * head.across - curve * head.across**2) < rng.uniform(0.03, 0.1)
    return body, brim & (np.abs(head.across) < half * rng.uniform(1.4, 2.4))


def _hood(rng: Rng, head: Head, half: float, rim: float, tilt: float) -> tuple[Mask, Mask]:
    """A hood, a headscarf or a helmet: all around the face."""
    outer = _ellipse(head, (0, 0), (half * rng.uniform(1.15, 1.5), rng.uniform(0.55, 0.8)), tilt)
    if chance(rng, 0.6):
        outer |= (np.abs(head.across) < half * rng.uniform(1.1, 1.5) - 0.2 * head.up) & (head.up < 0)
        outer &= head.up > -rng.uniform(0.7, 1.3)
    hole = _ellipse(head, (0, -0.2), (half * rng.uniform(0.7, 0.95), rng.uniform(0.4, 0.55)), tilt)
    inner = _ellipse(head, (0, -0.2), (half, 0.6), tilt)
    return outer & ~hole, outer & inner & ~hole & chance(rng, 0.3)


def _beret(rng: Rng, head: Head, half: float, rim: float, tilt: float) -> tuple[Mask, Mask]:
    side = rng.normal(0, 0.12)
    body = _ellipse(head, (side, rim + 0.16), (half * rng.uniform(1.0, 1.5), rng.uniform(0.16, 0.3)), tilt + side)
    body &= _above(head, rim - 0.02, tilt, 0.3)
    return body, body & ~_above(head, rim + 0.05, tilt, 0.3)
