"""Painted masks of the source (face, lips, eyelids, ears) read at the cage vertices, and vertex weights made
of them."""

from __future__ import annotations

import cv2
import numpy as np
from cage import PARTS, Cage
from source import Floats, Source

NAMES = ("face", "lips", "eyelids", "ears")


def painted_masks(source: Source, cage: Cage) -> dict[str, Floats]:
    """Mask name -> (n,) values in [0, 1]; zero off the skin."""
    uv = np.zeros((len(cage.rest), 2))
    uv[cage.quads["skin"].ravel()] = cage.uv[cage.uv_quads["skin"].ravel()]
    on_skin = cage.part == PARTS.index("skin")
    out = {}
    for name in NAMES:
        image = cv2.GaussianBlur(source.mask(name).astype(np.float32), (0, 0), 2)
        height, width = image.shape
        x, y = uv[:, 0] * width - 0.5, (1 - uv[:, 1]) * height - 0.5
        value = cv2.remap(image, x[None].astype(np.float32), y[None].astype(np.float32), cv2.INTER_LINEAR)[0]
        value = np.clip(value.astype(float), 0, 1) * on_skin
        out[name] = (value + value[cage.mirror]) / 2
    return out


def vertex_area(vertices: Floats, cage: Cage) -> Floats:
    """A third of the area of the triangles round each vertex."""
    quads = np.vstack(list(cage.quads.values()))
    triangles = np.vstack([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    a, b, c = vertices[triangles].swapaxes(0, 1)
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1) / 6
    return np.bincount(triangles.ravel(), np.repeat(area, 3), len(vertices))


def mode_weight(vertices: Floats, cage: Cage, masks: dict[str, Floats]) -> Floats:
    """Weight (n,) of each vertex in the principal component analyses: the face counts most, the neck
    least."""
    importance = 0.15 + 0.85 * masks["face"]
    importance[masks["ears"] > 0.5] = 0.35
    importance[cage.part == PARTS.index("neck")] = 0.08
    importance[cage.part >= 2] = 0.25
    importance[cage.part == len(PARTS)] = 0.0
    area = vertex_area(vertices, cage)
    weight = importance * np.sqrt(area / area.mean())
    return (weight + weight[cage.mirror]) / (2 * weight.mean())


def alignment_weight(vertices: Floats, cage: Cage, masks: dict[str, Floats]) -> Floats:
    """Weight (n,) of each vertex in the Procrustes alignment: the face without the ears, by area."""
    chosen = (masks["face"] > 0.6) & (masks["ears"] <= 0.5) & (cage.part == 0)
    area = vertex_area(vertices, cage)
    return chosen * (area + area[cage.mirror]) / 2
