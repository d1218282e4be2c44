"""Skin and lash lines of closed lids.

Constants were judged on the seven examples (``benchmarks/editing.py``).
"""

import cv2
import numpy as np

from toongeo.geometry import adjacency
from toongeo.model import MorphableModel
from toongeo.model.anatomy.lid_rings import lid_rings
from toongeo.model.anatomy.parts import SIDES
from toongeo.pipeline import Rig
from toongeo.render import uv_to_px

__all__ = ["LINE", "lash_colour", "lash_lines", "lid_zones"]

_STRETCHED = 1.2  # growth by which a blink spreads what is drawn beside the eye over the lid
_SOFTEN = 3  # passes over the border of the lid
LINE = 0.045  # of the eye's width: thickness of a lash line
_FINE = 4  # subtexels a side for lines


def lid_zones(model: MorphableModel, rig: Rig) -> np.ndarray:
    """For the left and right eye, how far (2, n) a vertex shows new skin when the eye closes."""
    edges = adjacency(model.faces, len(model.mean)).astype(float)
    degree = np.maximum(np.asarray(edges.sum(1)).ravel(), 1)
    zones = np.zeros((2, len(model.mean)), np.float32)
    for side, name in enumerate(SIDES):
        region = model.region(f"eye_{name}") & ~model.region(f"brow_{name}") & ~model.region(f"socket_{name}")
        triangles = model.faces[region[model.faces].all(1)]
        blink = rig.deltas[rig.names.index(f"eyeBlink{name.capitalize()}")]
        growth = _areas(rig.neutral + blink, triangles) / np.maximum(_areas(rig.neutral, triangles), 1e-9)
        zone = np.zeros(len(model.mean))
        zone[triangles[growth > _STRETCHED]] = 1
        zone[lid_rings(model, name).upper] = 1
        core = np.minimum(edges @ zone, 1)
        zone = core
        for _ in range(2 * _SOFTEN):
            zone = np.maximum(core * (region | (zone > 0.5)), (edges @ zone) / degree)
        zones[side] = zone
    return zones


def lash_lines(model: MorphableModel, V: np.ndarray, size: int) -> np.ndarray:
    """Cover (2, size, size) float32 of a line along the outer edge of the left and the right upper lid."""
    vertex_uv = np.zeros((len(model.mean), 2))
    vertex_uv[model.faces] = model.uv[model.uv_faces]
    lines = np.zeros((2, size, size), np.float32)
    for side, name in enumerate(SIDES):
        rings = lid_rings(model, name)
        path = 0.5 * (vertex_uv[rings.upper[1]] + vertex_uv[rings.upper[2]])
        px = uv_to_px(path, size * _FINE, size * _FINE)
        length = np.linalg.norm(np.diff(V[rings.upper[2]], axis=0), axis=1).sum()
        texels = np.linalg.norm(np.diff(px, axis=0), axis=1).sum()
        width = float(np.linalg.norm(V[rings.upper[0, 0]] - V[rings.upper[0, -1]]))
        thick = max(1, round(LINE * width * texels / length))
        canvas = np.zeros((size * _FINE, size * _FINE), np.uint8)
        cv2.polylines(canvas, [np.rint(px).astype(np.int32)], False, 255, thick)
        lines[side] = cv2.resize(canvas, (size, size), interpolation=cv2.INTER_AREA) / 255.0
    return lines


def lash_colour(model: MorphableModel, colours: np.ndarray, skin: np.ndarray) -> np.ndarray:
    """sRGB (3,), 0-255: the darkest that is drawn along the upper lids and brows, or darkened skin where none is."""
    rows = np.unique(np.concatenate([lid_rings(model, name).upper[1:].ravel() for name in SIDES]))
    brows = np.flatnonzero(model.region("brow_left") | model.region("brow_right"))
    near = colours[np.concatenate([rows, brows])]
    dark = near[np.argsort(near.sum(1))[: max(len(near) // 8, 1)]].mean(0)
    return np.asarray(np.minimum(dark, 0.45 * np.median(colours[skin], axis=0)))


def _areas(V: np.ndarray, F: np.ndarray) -> np.ndarray:
    return np.asarray(np.linalg.norm(np.cross(V[F[:, 1]] - V[F[:, 0]], V[F[:, 2]] - V[F[:, 0]]), axis=1))
