"""Lids that lie on their eyeballs."""

import dataclasses
import time

import numpy as np

from toongeo.pipeline.align.align_face import AlignedFace
from toongeo.pipeline.rig.eye_patch import eye_patch
from toongeo.pipeline.rig.fit_eyes import SIDES, Eyes, clearances
from toongeo.pipeline.rig.lid_rings import lid_rings
from toongeo.pipeline.rig.rig import Rig

CLEARANCE = 0.04  # of the radius: how far the skin around the lids' edges stays off
ROUNDS = 4  # of laying onto the eyeball what is still inside
GRAZING = 0.25  # cosine at the sphere below which a line of sight is taken to miss it


def seat_lids(face: AlignedFace, rig: Rig, eyes: Eyes) -> Rig:
    """Bend the neutral lids onto the eyeballs, along the lines of sight of the picture.

    The edges of the lids come to lie where :func:`~toongeo.pipeline.rig.fit_eyes.clearances` says, and the skin around
    them follows by Laplacian deformation and stays outside. Only the depth changes: in the picture no vertex moves.

    Parameters
    ----------
    face : AlignedFace
        For its camera.
    rig : Rig
    eyes : Eyes

    Returns
    -------
    Rig
        A new one; only the neutral face differs, and only before the eyes.
    """
    started = time.perf_counter()
    V, camera = rig.neutral.copy(), face.camera
    px, depth = camera.project(V), camera.depth(V)
    sight = camera.unproject(px, depth + 1.0) - V  # one mm of depth
    for side, name in enumerate(SIDES):
        centre, radius = eyes.centres[side], eyes.radii[side]
        rings, patch = lid_rings(face.model, name), eye_patch(face.model, name)
        off = np.full(len(V), CLEARANCE)
        off[rings.vertices] = clearances(rings)
        moves = _to_sphere(V - centre, sight, radius * (1 + off))
        anchors = rings.vertices
        for _ in range(ROUNDS):
            bent = V.copy()
            bent[patch.vertices] = patch.pulled(V, anchors, V[anchors] + moves[anchors, None] * sight[anchors])
            bent = camera.unproject(px, camera.depth(bent))
            inside = np.linalg.norm(bent - centre, axis=1) < radius * (1 + off)
            below = patch.vertices[inside[patch.vertices]]
            anchors = np.union1d(anchors, below)
        V = bent
    neutral = V
    report = {"seconds": rig.report["seconds"] + time.perf_counter() - started}
    return dataclasses.replace(rig, neutral=neutral, report=report)


def _to_sphere(offset: np.ndarray, sight: np.ndarray, radius: np.ndarray) -> np.ndarray:
    """Steps (k,) along lines of sight (k, 3) that bring offsets (k, 3) from a centre onto the front of a sphere.

    A line that misses the sphere, or nearly, is followed to where it comes nearest to being that far from the centre.
    """
    length = np.linalg.norm(sight, axis=1)
    along = (offset * sight).sum(1) / length
    beside = (offset**2).sum(1) - along**2
    ahead = np.sqrt(np.maximum(radius**2 - beside, (GRAZING * radius) ** 2))
    return np.asarray((ahead - along) / length)
