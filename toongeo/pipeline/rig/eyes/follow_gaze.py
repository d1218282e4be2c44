"""Lids that follow the gaze.

Constants were chosen on the seven examples and 15 caricatures (``benchmarks/contacts.py``).
"""

import time

import numpy as np
from scipy.spatial.transform import Rotation

from toongeo.geometry.polyline import arc_shares
from toongeo.model.anatomy.eye_patch import eye_patch
from toongeo.model.anatomy.gaze import GAZE_NAMES, gaze_names, gaze_rotation
from toongeo.model.anatomy.lid_rings import lid_rings, opening_height
from toongeo.model.anatomy.parts import SIDES
from toongeo.pipeline.align.align_face import AlignedFace
from toongeo.pipeline.rig.eyes.fit_eyes import Eyes
from toongeo.pipeline.rig.rig import Rig

__all__ = ["follow_gaze"]

# How much of the eyeball's turn the middle of the upper and of the lower lid make, by DIRECTIONS of gaze. Looking down,
# the upper lid stays with the iris and the lower one gives way; looking aside, the cornea takes both a little along.
_FOLLOWS = ((0.1, 0.1), (0.1, 0.1), (0.35, 0.1), (0.7, 0.25))
_MOST = 0.5  # of the opening: how far a lid moves
_TAPER = 0.4  # of the way from corner to corner over which lids follow less and less


def follow_gaze(face: AlignedFace, rig: Rig, eyes: Eyes) -> Rig:
    """Shapes of the eight ``eyeLook*`` names: lids that turn about the eyeball by a part of its turn.

    Parameters
    ----------
    face : AlignedFace
    rig : Rig
    eyes : Eyes

    Returns
    -------
    Rig
        A new one; only ``gaze`` differs, and is zero but around the eyes. Apply
        :func:`~toongeo.pipeline.rig.eyes.keep_lids_outside.keep_lids_outside` to it.
    """
    started = time.perf_counter()
    gaze = np.zeros(rig.gaze.shape, np.float32)
    for side, name in enumerate(SIDES):
        rings, patch = lid_rings(face.model, name), eye_patch(face.model, name)
        offset, at = rig.neutral - eyes.centres[side], rings.vertices
        for look, follows in zip(gaze_names(name), _FOLLOWS, strict=True):
            turn = Rotation.from_matrix(gaze_rotation(name, {look: 1.0}, eyes.turn[side])).as_rotvec()
            most = _MOST * opening_height(offset[rings.upper[0]], offset[rings.lower[0]]) / eyes.radii[side]
            scale = min(1.0, most / (max(follows) * np.linalg.norm(turn)))
            turned = offset.copy()
            for lid, share in zip((rings.upper, rings.lower), follows, strict=True):
                way = arc_shares(offset[lid[0]])
                taper = np.sin(0.5 * np.pi * np.minimum(1.0, np.minimum(way, 1 - way) / _TAPER))
                for row in lid:
                    turned[row] = Rotation.from_rotvec(np.outer(scale * share * taper, turn)).apply(offset[row])
            gaze[GAZE_NAMES.index(look), patch.vertices] = patch.followed(at, turned[at] - offset[at])
    return rig.changed(started, gaze=gaze)
