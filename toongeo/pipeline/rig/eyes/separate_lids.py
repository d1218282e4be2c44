"""Upper and lower lids that do not pass through each other.

Constants were chosen on the seven examples and 15 caricatures (``benchmarks/contacts.py``).
"""

import time

import numpy as np

from toongeo.geometry.polyline import arc_shares, interpolated
from toongeo.model.anatomy.eye_patch import eye_patch
from toongeo.model.anatomy.lid_rings import LidRings, lid_rings
from toongeo.model.anatomy.parts import SIDES
from toongeo.pipeline.align.align_face import AlignedFace
from toongeo.pipeline.rig.eyes.fit_eyes import Eyes
from toongeo.pipeline.rig.eyes.lid_closure import across_opening, opening_gaps
from toongeo.pipeline.rig.rig import Rig

__all__ = ["separate_lids"]

_LEFT = 0.02  # of the eyeball's radius: opening that an expression leaves, where the neutral face has as much
_TAPER = 0.15  # of the way from corner to corner over which corrections die out


def separate_lids(face: AlignedFace, rig: Rig, eyes: Eyes) -> Rig:
    """Let no expression but the blinks close an eye further than it is open.

    The expressions of the template fit its own eyes; those of a face with narrow ones would push the lower lid through
    the upper one. What is too much is taken off either lid by half, and the skin around follows by Laplacian
    deformation. Lids that touch in the neutral face move together.

    Parameters
    ----------
    face : AlignedFace
    rig : Rig
    eyes : Eyes

    Returns
    -------
    Rig
        A new one; only the skin around the eyes differs, in expressions that closed them too far.
    """
    started = time.perf_counter()
    deltas, gaze = rig.deltas.copy(), rig.gaze.copy()
    for side, name in enumerate(SIDES):
        rings, patch = lid_rings(face.model, name), eye_patch(face.model, name)
        blinks = rig.names.index(f"eyeBlink{name.capitalize()}")
        least, up, at = _LEFT * eyes.radii[side], across_opening(rings, rig.neutral), rings.vertices
        for shapes in (deltas, gaze):
            for k, shape in enumerate(shapes):
                if shapes is deltas and k == blinks:
                    continue
                if not shape[at].any():
                    continue
                change = _parting(rings, rig.neutral, shape, up, least)
                if not change.any():
                    continue
                shapes[k, patch.vertices] += patch.followed(at, change[at])
    return rig.changed(started, deltas=deltas, gaze=gaze)


def _parting(rings: LidRings, V: np.ndarray, shape: np.ndarray, up: np.ndarray, least: float) -> np.ndarray:
    """Change (n, 3) of a shape that leaves an opening of ``least`` mm, or what there was; zero off the lids' edges."""
    at_upper, at_lower = arc_shares(V[rings.upper[0]]), arc_shares(V[rings.lower[0]])
    opening = opening_gaps(rings, V, up)
    widening = (shape[rings.upper[0]] - interpolated(at_upper, at_lower, shape[rings.lower[0]])) @ up
    taper = np.minimum(1.0, np.minimum(at_upper, 1 - at_upper) / _TAPER)
    lack = taper * np.maximum(0.0, -np.maximum(opening - least, 0.0) - widening)
    change = np.zeros(V.shape)
    if lack.max() > 0.1 * least:
        change[rings.upper] = 0.5 * lack[:, None] * up
        change[rings.lower] = -0.5 * np.interp(at_lower, at_upper, lack)[:, None] * up
    return change
