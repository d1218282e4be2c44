"""Named regions of the refined head, as masks of its vertices."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from cage import PARTS
from contacts import LIP_BORDER, LIP_RIM, skin_quads_within, skin_walk
from head import Head
from lids import lid_rings
from scipy.spatial import cKDTree
from source import Floats

# The regions in the order of the file, with what they hold.
DESCRIPTIONS = {
    "face": "front skin: lids and lips up to their margins, not their inner sides; no ears, scalp, neck",
    "skin": "face, scalp and ears; no neck, no inner side of lips and lids",
    "neck": "neck",
    "scalp": "skin behind the face region, without the ears",
    "ears": "both ears",
    "ear_left": "left ear",
    "ear_right": "right ear",
    "mouth_cavity": "inside of the mouth, with the inner side of the lips",
    "socket_left": "inner side of the left lids behind their margins, and the lining of the socket",
    "socket_right": "the same on the right",
    "teeth_upper": "upper row of teeth",
    "teeth_lower": "lower row of teeth",
    "tongue": "tongue",
    "lips": "red of the lips, up to the line where they meet",
    "lip_upper": "upper lip",
    "lip_lower": "lower lip",
    "mouth": "lips and the skin within 12 mm of them",
    "eye_left": "skin within 14 mm of the left lid margins, with the lids",
    "eye_right": "skin within 14 mm of the right lid margins, with the lids",
    "eyelid_upper_left": "left upper lid: within 7 mm of the margins, above the line between the eye corners",
    "eyelid_lower_left": "left lower lid: within 7 mm of the margins, below the line between the eye corners",
    "eyelid_upper_right": "right upper lid, as on the left",
    "eyelid_lower_right": "right lower lid, as on the left",
    "brow_left": "within 5 mm of the line through landmarks 22-26",
    "brow_right": "within 5 mm of the line through landmarks 17-21",
    "nose": "nose from its root to the columella, with the wings",
    "cheek_left": "left cheek between lower lid, nose and mouth line",
    "cheek_right": "right cheek between lower lid, nose and mouth line",
    "jaw": "face below the mouth line, without the lips",
    "forehead": "face above the brows",
}


def regions(head: Head, masks: dict[str, Floats], landmarks: np.ndarray) -> dict[str, np.ndarray]:
    """Region name -> (n1,) bool. `masks` holds the painted masks at the cage."""
    x = head.fine(head.mean)
    painted = {name: head.fine(head.from_cage(value)) for name, value in masks.items()}
    out = {name: head.part1 == i for i, name in enumerate(PARTS)}
    on_skin = out["skin"]
    inside = inside_lips(head)
    out["ears"] = on_skin & (painted["ears"] > 0.5)
    out["ear_left"], out["ear_right"] = out["ears"] & (x[:, 0] > 0), out["ears"] & (x[:, 0] < 0)
    out["mouth_cavity"] = out["mouth_cavity"] | inside
    out["skin"] = on_skin & ~inside
    out["face"] = out["skin"] & (painted["face"] > 0.5) & ~out["ears"]
    _lips(head, x, landmarks, out)
    for side in ("left", "right"):
        _eye(head, x, landmarks, side, out)
    out["face"] |= out["lips"]
    out["scalp"] = out["skin"] & ~out["face"] & ~out["ears"]
    _features(x, landmarks, out)
    return {name: _symmetric(name, out, head.mirror1) for name in DESCRIPTIONS}


def _symmetric(name: str, masks: dict[str, np.ndarray], mirror: np.ndarray) -> np.ndarray:
    """The mask with ties on the middle line settled alike on both sides."""
    other = name.replace("left", "right") if "left" in name else name.replace("right", "left")
    return masks[name] | masks[other][mirror]


def _skin_within(head: Head, loop: list[int], beyond: np.ndarray) -> np.ndarray:
    """Skin vertices (n1,) inside a closed loop of base-mesh ids, on the side where the cage vertices `beyond`
    lie."""
    inside = np.zeros(head.subdivision.shape[0], dtype=bool)
    # Skin quads come first among the quads of the head, in the same order.
    inside[head.children(skin_quads_within(head.cage, loop, beyond))] = True
    return inside & (head.part1 == 0)


def inside_lips(head: Head) -> np.ndarray:
    """Skin vertices (n1,) behind the line where the lips meet."""
    rim = skin_walk(head.cage).loop(*LIP_RIM)
    inside = _skin_within(head, rim, head.cage.vertices_of("mouth_cavity"))
    inside[head.fine_loop(rim)] = False
    return inside


def inside_lids(head: Head, side: str) -> tuple[np.ndarray, np.ndarray]:
    """Skin vertices (n1,) behind the lid margins, and the margins themselves."""
    rings = lid_rings(head.cage, side)
    loop = head.cage.source[rings[3]].tolist()
    inside = _skin_within(head, loop, rings[0])
    margin = np.zeros_like(inside)
    margin[head.fine_loop(loop)] = True
    return inside & ~margin, margin


def _lips(head: Head, x: Floats, landmarks: np.ndarray, out: dict[str, np.ndarray]) -> None:
    within = _skin_within(head, skin_walk(head.cage).loop(*LIP_BORDER), head.cage.local(LIP_RIM))
    out["lips"] = within & out["skin"]
    # Upper and lower lip: above or below the line from the corner to the middle of the slit.
    slit = np.interp(
        np.abs(x[:, 0]),
        [0, abs(x[landmarks[60], 0])],
        [x[landmarks[[62, 66]], 1].mean(), x[landmarks[60], 1]],
    )
    out["lip_upper"] = out["lips"] & (x[:, 1] >= slit)
    out["lip_lower"] = out["lips"] & (x[:, 1] <= slit)
    out["mouth"] = out["face"] & (_distance(x, x[out["lips"]]) < 12) | out["lips"]


def _eye(head: Head, x: Floats, landmarks: np.ndarray, side: str, out: dict[str, np.ndarray]) -> None:
    behind, margin = inside_lids(head, side)
    gap = _distance(x, x[margin])
    out[f"socket_{side}"] |= behind
    out["skin"] &= ~behind
    out["face"] = (out["face"] | margin) & ~behind
    out[f"eye_{side}"] = out["face"] & (gap < 14)
    corners = x[landmarks[[36, 39] if side == "right" else [45, 42]]]
    line = np.interp(np.abs(x[:, 0]), np.abs(corners[::-1, 0]), corners[::-1, 1])
    lid = out["face"] & (gap < 7)
    out[f"eyelid_upper_{side}"] = lid & (x[:, 1] >= line)
    out[f"eyelid_lower_{side}"] = lid & (x[:, 1] < line)


def _features(x: Floats, landmarks: np.ndarray, out: dict[str, np.ndarray]) -> None:
    p, face = x[landmarks], out["face"]
    left = x[:, 0] >= 0
    brow = np.minimum(_polyline_distance(x, p[17:22]), _polyline_distance(x, p[22:27])) < 5
    out["brow_left"], out["brow_right"] = face & brow & left, face & brow & ~left
    # The nose widens from its root to its wings, and ends under the columella.
    half = np.interp(-x[:, 1], [-p[27, 1], -p[29, 1], -p[31, 1]], [8.0, 14.0, abs(p[31, 0]) + 3.5])
    out["nose"] = (
        face & (x[:, 1] < p[27, 1] + 2) & (x[:, 1] > p[33, 1] - 2.5) & (np.abs(x[:, 0]) < half) & (x[:, 2] > 0)
    )
    lids = out["eyelid_upper_left"] | out["eyelid_lower_left"] | out["eyelid_upper_right"] | out["eyelid_lower_right"]
    mouth_line = p[48, 1]
    cheek = (
        face
        & (x[:, 1] < p[41, 1] - 3)
        & (x[:, 1] >= mouth_line)
        & ~out["nose"]
        & ~out["lips"]
        & ~lids
        & (np.abs(x[:, 0]) > 10)
    )
    out["cheek_left"], out["cheek_right"] = cheek & left, cheek & ~left
    out["jaw"] = face & (x[:, 1] < mouth_line) & ~out["lips"]
    brow_line = np.interp(np.abs(x[:, 0]), np.abs(p[21:16:-1, 0]), p[21:16:-1, 1])
    out["forehead"] = face & (x[:, 1] > brow_line + 3) & ~brow


def _distance(x: Floats, points: Floats) -> Floats:
    return cKDTree(points).query(x)[0]


def _polyline_distance(x: Floats, points: Floats) -> Floats:
    gaps = []
    for a, b in pairwise(points):
        t = np.clip((x - a) @ (b - a) / ((b - a) @ (b - a)), 0, 1)
        gaps.append(np.linalg.norm(x - a - t[:, None] * (b - a), axis=1))
    return np.min(gaps, axis=0)
