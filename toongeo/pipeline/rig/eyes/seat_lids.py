"""Lids that lie on their eyeballs.

Constants were chosen on the seven examples and 15 caricatures (``benchmarks/contacts.py``).
"""

import time

import numpy as np

from toongeo.model.anatomy.eye_patch import EyePatch, eye_patch, sagitta
from toongeo.model.anatomy.lid_rings import LidRings, lid_rings, opening_height
from toongeo.model.anatomy.parts import SIDES
from toongeo.pipeline.align.align_face import AlignedFace
from toongeo.pipeline.rig.eyes.fit_eyes import Eyes
from toongeo.pipeline.rig.eyes.keep_lids_outside import outwards
from toongeo.pipeline.rig.rig import Rig
from toongeo.pipeline.rig.skin.crossing_triangles import resolve_crossings
from toongeo.protocols import Camera

__all__ = ["SKIN", "seat_lids"]

# Of the radius: how far off the eyeball the rows of LidRings lie, from the inner edge outwards. The upper lid lies
# before the lower one, so that closed lids keep their order, and lids that have far to go lie farther off: a straight
# way around the eyeball sets out the flatter.
_UPPER, _LOWER, _FAR = np.array([[0.03, 0.04, 0.05], [0.02, 0.025, 0.03], [0.055, 0.06, 0.065]])
_OPEN = np.radians([40.0, 80.0])  # about the eyeball: openings from and to which lids have farther and farther to go
_CORNER = 4  # columns over which upper and lower become the same towards a corner
SKIN = 0.03  # of the radius: how far off the eyeball the skin around the lids' edges stays
_GAPS = (0.015, 0.07)  # of the radius: how far off the lids' edges lie, at least and at most
_RELIEF = 0.03  # of the radius: over which the edges move alike
_ROUNDS = 5  # of laying onto the eyeball what is still inside
_GRAZING = 0.25  # cosine at the sphere below which a line of sight is taken to miss it


def seat_lids(face: AlignedFace, rig: Rig, eyes: Eyes) -> Rig:
    """Bend the neutral lids onto the eyeballs, along the lines of sight of the picture.

    The edges of the lids come to lie a few hundredths of the radius off the sphere, and the skin around them follows by
    Laplacian deformation and stays outside. Only the depth changes: in the picture the face stays as
    it was aligned.

    Parameters
    ----------
    face : AlignedFace
        For its camera.
    rig : Rig
    eyes : Eyes

    Returns
    -------
    Rig
        A new one; only the neutral face differs, and only around the eyes.
    """
    started = time.perf_counter()
    V, skin, dips = rig.neutral, face.region("skin"), sagitta(face.model, rig.neutral)
    for side, name in enumerate(SIDES):
        centre, radius = eyes.centres[side], eyes.radii[side]
        rings = lid_rings(face.model, name)
        sight = face.camera.unproject(face.project(V), face.camera.depth(V) + 1.0) - V  # one mm of depth
        moves = _to_sphere(V - centre, sight, np.full(len(V), radius * (1 + SKIN)), miss=-np.inf)
        at = rings.vertices
        off = _clearances(rings, V, radius)
        moves[at] = _edge_moves(face.camera.view(V[at])[:, :2], V[at] - centre, sight[at], radius, off)
        patch = eye_patch(face.model, name)
        bent = _bent(face.camera, patch, V, at, moves)
        bent = V + resolve_crossings(face.model, patch, V, bent - V, 0)
        V = bent + np.where(skin[:, None], outwards(bent - centre, radius * (1 + _GAPS[0]) + dips / radius), 0.0)
    return rig.changed(started, neutral=V)


def _clearances(rings: LidRings, V: np.ndarray, radius: float) -> np.ndarray:
    """How far off the eyeball each of ``rings.vertices`` shall lie, (k,), of its radius."""
    height = opening_height(V[rings.upper[0]], V[rings.lower[0]])
    far = np.interp(2 * np.arcsin(min(1.0, height / (2 * radius))), _OPEN, [0.0, 1.0])
    off, middle = np.zeros(len(V)), (_UPPER + _LOWER) / 2
    for lid, wanted in ((rings.upper, _UPPER), (rings.lower, _LOWER)):
        column = np.arange(lid.shape[1])
        share = np.minimum(1.0, np.minimum(column, column[::-1]) / _CORNER)
        near = middle[:, None] + share * (wanted - middle)[:, None]
        off[lid] = near + far * (_FAR[:, None] - near)
    return off[rings.vertices]


def _bent(camera: Camera, patch: EyePatch, V: np.ndarray, edges: np.ndarray, moves: np.ndarray) -> np.ndarray:
    """Vertices (n, 3) with the lids' edges moved in depth by their ``moves`` (n,), and skin by what it lacks."""
    px, depth = camera.project(V), camera.depth(V)
    anchors = edges
    for _ in range(_ROUNDS):
        targets = camera.unproject(px[anchors], depth[anchors] + moves[anchors])
        pulled = patch.pulled(V, anchors, targets)
        bent = V.copy()
        bent[patch.vertices] = camera.unproject(px[patch.vertices], camera.depth(pulled))
        lacks = camera.depth(bent) - depth < moves
        beneath = np.setdiff1d(patch.vertices[lacks[patch.vertices]], anchors)
        if not len(beneath):
            break
        anchors = np.union1d(anchors, beneath)
    return bent


def _edge_moves(view: np.ndarray, offset: np.ndarray, sight: np.ndarray, radius: float, off: np.ndarray) -> np.ndarray:
    """Steps (k,) along the lines of sight that lay the lids' edges onto the eyeball and keep their relief.

    Vertices that are close to each other in the picture, ``view`` (k, 2) in mm, move alike: where lids are nearly shut,
    the one that lay before the other stays there.
    """
    distance2 = ((view[:, None] - view) ** 2).sum(2)
    weights = np.exp(-0.5 * distance2 / (_RELIEF * radius) ** 2)
    moves = weights @ _to_sphere(offset, sight, radius * (1 + off)) / weights.sum(1)
    least, most = (_to_sphere(offset, sight, np.full(len(off), radius * (1 + gap))) for gap in _GAPS)
    return np.clip(moves, least, most)


def _to_sphere(offset: np.ndarray, sight: np.ndarray, radius: np.ndarray, miss: float | None = None) -> np.ndarray:
    """Steps (k,) along lines of sight (k, 3) that bring offsets (k, 3) from a centre onto the front of a sphere.

    A line that misses the sphere, or nearly, is followed to just before its middle, or the step is ``miss``.
    """
    length = np.linalg.norm(sight, axis=1)
    along = (offset * sight).sum(1) / length
    beside2 = (offset**2).sum(1) - along**2
    depth2, least2 = radius**2 - beside2, (_GRAZING * radius) ** 2
    steps = (np.sqrt(np.maximum(depth2, least2)) - along) / length
    return steps if miss is None else np.where(depth2 < least2, miss, steps)
