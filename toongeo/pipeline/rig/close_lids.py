"""Lids that close over this face's eyes."""

import dataclasses
import time

import numpy as np
from scipy.spatial import cKDTree

from toongeo.geometry import laplacian_align
from toongeo.pipeline.align.align_face import AlignedFace
from toongeo.pipeline.align.carry_inner_parts import opening_rim
from toongeo.pipeline.align.rim_anchors import rim_path
from toongeo.pipeline.rig.rig import Rig

WEIGHT = 1e3  # of the anchors: they are met to about a hundredth of a millimetre


def close_lids(face: AlignedFace, rig: Rig) -> Rig:
    """Make ``eyeBlinkLeft`` and ``eyeBlinkRight`` close the eyes of this face.

    Deformation transfer keeps rotations and stretches, not contacts: an eye that is drawn taller than the template's
    stays open when it blinks. At weight 1 of the blink the upper lid is therefore brought down onto the lower one by
    Laplacian deformation of the skin around the eye.

    Parameters
    ----------
    face : AlignedFace
    rig : Rig

    Returns
    -------
    Rig
        A new one; only the two blinks differ, and only around the eyes.
    """
    started = time.perf_counter()
    deltas = rig.deltas.copy()
    for side in ("left", "right"):
        blink = rig.names.index(f"eyeBlink{side.capitalize()}")
        deltas[blink] = _closed(face, side, rig.neutral + deltas[blink]) - rig.neutral
    return dataclasses.replace(
        rig, deltas=deltas, report={"seconds": rig.report["seconds"] + time.perf_counter() - started}
    )


def _closed(face: AlignedFace, side: str, V: np.ndarray) -> np.ndarray:
    """Vertices with the upper lid of one eye brought down onto the lower one; only those around the eye move."""
    upper, lower = (rim_path(face.model, f"lid_{lid}_{side}") for lid in ("upper", "lower"))
    around = face.region(f"eye_{side}") | face.region(f"socket_{side}")
    patch = around[face.faces].all(1)
    used, local = np.unique(face.faces[patch], return_inverse=True)
    border = np.intersect1d(used, face.faces[~patch])  # where the patch is joined to the rest
    still = np.union1d(border, lower)
    # Upper and lower rim are paired by how far along them one is, from corner to corner: of rims that are steep at the
    # corners, as those of round eyes are, no part is left out.
    at_upper, at_lower = _along(V[upper]), _along(V[lower])
    landing = np.column_stack([np.interp(at_upper, at_lower, V[lower, axis]) for axis in range(3)])
    lands = ~np.isin(upper, still)
    # The edge of the upper lid has a thickness: its inner side comes to lie behind the lower lid, not before it.
    edge = np.setdiff1d(opening_rim(face.model, f"socket_{side}"), np.union1d(still, upper))
    thickness, nearest = cKDTree(V[upper]).query(V[edge])
    moving = np.r_[upper[lands], edge]
    targets = np.vstack([landing[lands], landing[nearest] - thickness[:, None] * [0, 0, 1]])
    closed = V.copy()
    closed[used] = laplacian_align(
        V[used],
        local.reshape(-1, 3),
        np.searchsorted(used, np.r_[still, moving]),
        np.vstack([V[still], targets]),
        weight=WEIGHT,
    )
    return closed


def _along(path: np.ndarray) -> np.ndarray:
    """Length along a path of points (k, 3) up to each, as a share of the whole."""
    length = np.r_[0, np.cumsum(np.linalg.norm(np.diff(path, axis=0), axis=1))]
    return np.asarray(length / length[-1])
