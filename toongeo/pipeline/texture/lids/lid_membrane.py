"""Skin stretched over a lid from what surrounds it.

Constants were chosen on one half of the pictures (``benchmarks/looks.py``).
"""

import cv2
import numpy as np
import scipy.sparse as sp

from toongeo.geometry import vertex_normals
from toongeo.geometry.operators.factor import factor_spd, solve
from toongeo.model import MorphableModel
from toongeo.model.anatomy.lid_rings import lid_rings

__all__ = ["lid_membrane", "lid_ring"]

_AROUND = 6  # edges: breadth of the ring that a lid takes its colour from
_BARE = 0.1  # of a zone: skin of the ring is hardly stretched
_LIGHTER = 40  # percent of the ring's lightness: what is darker has no say in what its skin looks like
# Lightness below and above the ring's skin, and chroma beside it: so many deviations, or at least so many CIELAB units,
# off it a vertex is no skin but line, lash, shadow or gloss.
_DARK, _LIGHT, _TINTED = (2.5, 8.0), (3.0, 12.0), (4.0, 12.0)
_LEAST_DEVIATION = (3.0, 2.0, 2.0)  # CIELAB
_SHADE = 0.35  # by how much a lid is lighter where it faces the light than where it does not
_LIGHT_FROM = (0.0, 0.6, 0.8)  # above and before the face, where painters have it
_SHADED = (0.72, 1.08)  # limits of that
_LOOSE = 1e-6  # weight of the ring's mean: decides only where nothing of the ring is known


def lid_ring(model: MorphableModel, side: str, zone: np.ndarray, edges: sp.csr_array) -> tuple[np.ndarray, np.ndarray]:
    """Vertices (n,) bool of a lid with its surroundings, and those of them whose skin keeps its place in a blink."""
    near = zone > 0
    for _ in range(_AROUND):
        near = near | (edges @ near > 0)
    near &= model.region("face") & ~model.region(f"socket_{side}")
    rims = np.isin(np.arange(len(zone)), lid_rings(model, side).vertices)
    ring = near & (zone < _BARE) & ~(rims | (edges @ rims > 0))
    if model.has(f"brow_{side}"):
        ring &= ~model.region(f"brow_{side}")
    return near, ring


def lid_membrane(
    model: MorphableModel,
    side: str,
    zone: np.ndarray,
    edges: sp.csr_array,
    colours: np.ndarray,
    closed: np.ndarray,
    relief: float = 1.0,
) -> np.ndarray:
    """Colours (n, 3) whose lid is skin as its surroundings have it, without lashes, lines and shadows.

    A membrane (the harmonic function on the mesh's edges) through the plain skin of the ring around the lid, shaded by
    the normals of the closed lid against those of the ring.

    Parameters
    ----------
    model : MorphableModel
    side : {"left", "right"}
    zone : (n,) float
        From :func:`~toongeo.pipeline.texture.lids.lid_zones.lid_zone`.
    edges : (n, n) sparse
        Of the front skin.
    colours : (n, 3) float, sRGB, 0-255
        Of the texture.
    closed : (n, 3) float, mm
        The face with this eye shut.
    relief : float
        How much of the shading there is: in a drawing without shadows a shaded lid would be a stain.
    """
    near, ring = lid_ring(model, side, zone, edges)
    if not ring.any():
        return colours
    known = ring.copy()
    known[ring] = _plain(colours[ring])
    at = np.flatnonzero(near)
    joined = edges[at][:, at]
    held = known[at].astype(float)
    A = sp.diags_array(np.asarray(joined.sum(1)).ravel() + held + _LOOSE) - joined
    mean = colours[known].mean(0)
    filled = solve(factor_spd(sp.csc_matrix(A)), held[:, None] * colours[at] + _LOOSE * mean)
    facing = vertex_normals(closed, model.faces) @ np.array(_LIGHT_FROM)
    shade = np.clip(1 + _SHADE * zone[at] * (facing[at] - np.median(facing[known])), *_SHADED)
    shade = 1 + relief * (shade - 1)
    shade = np.minimum(shade, 255 / np.maximum(filled.max(1), 1))  # light skin keeps its hue
    painted = np.array(colours, float)
    painted[at] = filled * shade[:, None]
    return painted


def _plain(colours: np.ndarray) -> np.ndarray:
    """Which (k,) of some colours are the skin that most of the lighter ones are."""
    lab = cv2.cvtColor((colours[None] / 255).astype(np.float32), cv2.COLOR_RGB2LAB)[0]
    lighter = lab[lab[:, 0] >= np.percentile(lab[:, 0], _LIGHTER)]
    middle = np.median(lighter, axis=0)
    deviation = np.maximum(np.median(np.abs(lab - middle), axis=0), _LEAST_DEVIATION)
    above = lab[:, 0] - middle[0]
    low, high = (max(count * deviation[0], least) for count, least in (_DARK, _LIGHT))
    beside = np.hypot(*(lab - middle)[:, 1:].T) < max(_TINTED[0] * np.hypot(*deviation[1:]), _TINTED[1])
    return np.asarray((above > -low) & (above < high) & beside)
