"""Light on the fragments of a head: lamps, cast shadows, occlusion, highlights."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from renders.canvas import between
from toongeo.render.rasterize import rasterize

__all__ = ["Surface", "shaded"]

_SHADOW_SIZE = 192  # px of the shadow map
_SHADOW_BIAS = 6.0  # mm


@dataclass(frozen=True, eq=False)
class Surface:
    """What the camera sees: `mask` (s, s); for its k pixels `face_ids` (k,), `normals` (k, 3) in the camera frame,
    `corners` (k, 3) vertex rows and `weights` (k, 3); `shine` (k,) 0-255 of a full highlight; `depth` (s, s) mm, the
    farthest where there is nothing; and the `vertices` (n, 3) in the camera frame with the `casting` faces (m, 3)."""

    mask: NDArray[np.bool_]
    face_ids: NDArray[np.int32]
    normals: NDArray[np.float32]
    corners: NDArray[np.int64]
    weights: NDArray[np.float32]
    shine: NDArray[np.float32]
    depth: NDArray[np.float32]
    vertices: NDArray[np.float64]
    casting: NDArray[np.int64]


def shaded(rng: np.random.Generator, colours: NDArray[np.float32], surface: Surface, plain: bool) -> NDArray:
    """Colours (k, 3) under random light; `plain` light has a few steps at most, as in flat drawings."""
    ambient, count = between(rng, 0.25, 0.75), int(rng.integers(1, 4))
    light = np.full(colours.shape, ambient, np.float32)
    glint = np.zeros(len(colours), np.float32)
    for k in range(count):
        direction = _lamp(rng)
        strength = between(rng, 0.3, 1) * (1.15 - ambient) * 1.5 / np.sqrt(count)
        facing = np.maximum(surface.normals @ direction.astype(np.float32), 0)
        if k == 0 and not plain and rng.random() < 0.45:
            facing = facing * _lit(surface, direction)
        tint = 1 + rng.normal(0, 0.12, 3) * (rng.random() < 0.5)
        light += (facing * strength)[:, None] * tint.astype(np.float32)
        half = direction + [0, 0, 1]
        half /= np.linalg.norm(half)
        glint += np.maximum(surface.normals @ half.astype(np.float32), 0) ** between(rng, 8, 50) * strength
    occlusion = _occlusion(rng, surface)
    if plain:
        if rng.random() < 0.6:
            steps = rng.integers(1, 4)
            light = np.round(light * steps) / steps * between(rng, 0.6, 1) + 0.25
        else:
            light = 0.75 + 0.25 * light
        occlusion = occlusion * between(rng, 0, 0.6)
    out = colours * np.clip(light * (1 - np.clip(occlusion, 0, 0.85))[:, None], 0.05, 1.6)
    if not plain:
        out += (glint * surface.shine)[:, None]
    if rng.random() < 0.35:  # dark towards the outline
        rim = (1 - np.clip(surface.normals[:, 2:], 0, 1)) ** 2
        out *= 1 - between(rng, 0.2, 0.9) * rim
    return out


def _lamp(rng: np.random.Generator) -> NDArray[np.float64]:
    direction = rng.normal(size=3)
    direction[2] = abs(direction[2]) + rng.choice([0.15, 0.6, 1.2])
    direction[1] += between(rng, 0, 1)
    return direction / np.linalg.norm(direction)


def _occlusion(rng: np.random.Generator, surface: Surface) -> NDArray[np.float32]:
    """Darkness of what lies deeper than its surroundings, at two sizes."""
    size = len(surface.depth)
    total = np.zeros(len(surface.normals), np.float32)
    for blur, depth, most in ((0.018, 14.0, 1.1), (0.006, 6.0, 1.0)):
        around = cv2.GaussianBlur(surface.depth, (0, 0), blur * size)
        total += np.clip((around - surface.depth) / depth, 0, 1)[surface.mask] * between(rng, 0, most)
    return total


def _lit(surface: Surface, direction: NDArray[np.float64]) -> NDArray[np.float32]:
    """1 where the lamp is seen, 0 in the shadow, with soft edges."""
    side = np.cross([0, 1, 0], direction)
    side /= np.linalg.norm(side)
    seen = surface.vertices @ np.column_stack([side, np.cross(direction, side), direction])
    low, span = seen[:, :2].min(0), np.ptp(seen[:, :2], axis=0).max()
    scale = (_SHADOW_SIZE - 4) / span
    flat = np.column_stack([(seen[:, :2] - low) * scale + 2, seen[:, 2]])
    flat[:, 1] = _SHADOW_SIZE - flat[:, 1]
    fragments = rasterize(flat, surface.casting, _SHADOW_SIZE, _SHADOW_SIZE, cull_back=True)
    nearest = np.einsum("yxk,yxk->yx", fragments.barycentrics, flat[:, 2][surface.casting[fragments.face_ids]])
    nearest[~fragments.mask] = -np.inf
    here = np.einsum("pk,pkc->pc", surface.weights, flat[surface.corners])
    x, y = np.clip(np.rint(here[:, :2]).astype(int), 0, _SHADOW_SIZE - 1).T
    picture = np.zeros(surface.mask.shape, np.float32)
    picture[surface.mask] = nearest[y, x] - here[:, 2] < _SHADOW_BIAS
    return cv2.GaussianBlur(picture, (0, 0), 0.005 * len(picture))[surface.mask]
