"""Lids that close over this face's eyes and never enter them."""

import dataclasses
import time

import numpy as np

from toongeo.geometry import laplacian_align
from toongeo.model import MorphableModel
from toongeo.pipeline.align.align_face import AlignedFace
from toongeo.pipeline.align.rim_anchors import rim_path
from toongeo.pipeline.rig.build_rig import Rig
from toongeo.pipeline.rig.fit_eyes import CLEARANCE, SIDES, Eyes

# Upper and lower lid from corner to corner, as iBUG-68 points.
LIDS = {"left": ((42, 43, 44, 45), (42, 47, 46, 45)), "right": ((36, 37, 38, 39), (36, 41, 40, 39))}
WEIGHT = 1e3  # of the anchors: they are met to about a hundredth of a millimetre


def fit_lids(face: AlignedFace, rig: Rig, eyes: Eyes) -> Rig:
    """Make ``eyeBlink*`` close the eyes of this face, and every expression keep its lids off the eyeballs.

    Deformation transfer keeps rotations and stretches, not contacts: an eye that is drawn taller than the template's
    stays open when it blinks. At weight 1 of the blink the upper lid is therefore brought onto the lower one, by
    Laplacian deformation of the skin around the eye; then, in all expressions, lid vertices inside an eyeball are moved
    out to its surface.

    Parameters
    ----------
    face : AlignedFace
    rig : Rig
    eyes : Eyes

    Returns
    -------
    Rig
        A new one; only vertices around the eyes differ.
    """
    started = time.perf_counter()
    deltas = rig.deltas.copy()
    for side, name in enumerate(SIDES):
        blink = rig.names.index(f"eyeBlink{name.capitalize()}")
        around = face.region(f"eye_{name}") | face.region(f"socket_{name}")
        deltas[blink] = _closed(face.model, name, around, rig.neutral + deltas[blink]) - rig.neutral
        lids = np.flatnonzero(face.region(f"eye_{name}"))
        posed = rig.neutral[lids] + deltas[:, lids]
        deltas[:, lids] += _outward(posed - eyes.centres[side], eyes.radii[side] * (1 + 2 * CLEARANCE))
    seconds = rig.report["seconds"] + time.perf_counter() - started
    return dataclasses.replace(rig, deltas=deltas, report={"seconds": seconds})


def _closed(model: MorphableModel, side: str, around: np.ndarray, V: np.ndarray) -> np.ndarray:
    """Vertices with the upper lid of one eye brought down onto the lower one; all but ``around`` stay."""
    upper, lower = (rim_path(model, rim) for rim in LIDS[side])
    faces = model.faces[around[model.faces].all(1)]
    used, local = np.unique(faces, return_inverse=True)
    edges = np.isin(used, model.faces[~around[model.faces].all(1)])  # where the patch is joined to the rest
    still = np.union1d(used[edges], lower)
    moving = np.setdiff1d(upper, still)
    # Upper and lower rim are paired by how far along the eye they are, from corner to corner.
    along = V[upper[-1]] - V[upper[0]]
    at_lower, at_upper = V[lower] @ along, V[moving] @ along
    order = np.argsort(at_lower)
    targets = np.column_stack([np.interp(at_upper, at_lower[order], V[lower][order, axis]) for axis in range(3)])
    anchors = np.searchsorted(used, np.r_[still, moving])
    closed = V.copy()
    closed[used] = laplacian_align(
        V[used], local.reshape(-1, 3), anchors, np.vstack([V[still], targets]), weight=WEIGHT
    )
    return closed


def _outward(offsets: np.ndarray, radius: float) -> np.ndarray:
    """Shifts (..., 3) that bring offsets from a sphere's centre out of its front half to its surface."""
    distance = np.linalg.norm(offsets, axis=-1, keepdims=True)
    inside = (distance < radius) & (offsets[..., 2:] > 0)
    return np.where(inside, offsets * (radius / np.maximum(distance, 1e-9) - 1), 0.0)
