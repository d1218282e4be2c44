"""Lids that do not enter the eyeballs."""

import dataclasses
import time

import numpy as np

from toongeo.pipeline.align.align_face import AlignedFace
from toongeo.pipeline.rig.fit_eyes import CLEARANCE, SIDES, Eyes
from toongeo.pipeline.rig.rig import Rig

NEAR = 3.0  # radii from an eyeball's centre: skin farther from it does not come to it


def clear_lids(face: AlignedFace, rig: Rig, eyes: Eyes) -> Rig:
    """Keep the skin off the eyeballs, in each expression at weight 1.

    Vertices that an expression takes into the front half of an eyeball are moved out to its surface. Several
    expressions at once add their deltas and may still touch it.

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
    deltas, skin = rig.deltas.copy(), face.region("skin")
    for side in range(len(SIDES)):
        near = np.linalg.norm(rig.neutral - eyes.centres[side], axis=1) < NEAR * eyes.radii[side]
        lids = np.flatnonzero(skin & near)
        offsets = rig.neutral[lids] + deltas[:, lids] - eyes.centres[side]
        deltas[:, lids] += _outward(offsets, eyes.radii[side] * (1 + CLEARANCE))
    return dataclasses.replace(
        rig, deltas=deltas, report={"seconds": rig.report["seconds"] + time.perf_counter() - started}
    )


def _outward(offsets: np.ndarray, radius: float) -> np.ndarray:
    """Shifts (..., 3) that bring offsets from a sphere's centre out of its front half to its surface."""
    distance = np.linalg.norm(offsets, axis=-1, keepdims=True)
    inside = (distance < radius) & (offsets[..., 2:] > 0)
    return np.where(inside, offsets * (radius / np.maximum(distance, 1e-9) - 1), 0.0)
