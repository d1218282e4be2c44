"""Expressions that do not fold the skin around the eyes.

Constants were chosen on the seven examples and 15 caricatures (``benchmarks/contacts.py``).
"""

import time

import numpy as np

from toongeo.model import MorphableModel
from toongeo.model.anatomy.eye_patch import EyePatch, eye_patch
from toongeo.model.anatomy.parts import SIDES
from toongeo.pipeline.align.align_face import AlignedFace
from toongeo.pipeline.rig.eyes.fit_eyes import Eyes
from toongeo.pipeline.rig.eyes.keep_lids_outside import CLEARANCE, outwards
from toongeo.pipeline.rig.rig import Rig
from toongeo.pipeline.rig.skin.affine_around import affine_around
from toongeo.pipeline.rig.skin.crossing_triangles import (
    HOPELESS,
    Sheet,
    around,
    crossing_all,
    crossing_triangles,
    resolve_crossings,
)

__all__ = ["unfold_lids"]

_MOVES = 0.3  # mm: shapes that move the skin around an eye less than this are not looked at
# Skin that passes through itself has edges nearby whose angle between the normals is this, and has grown by so much.
_SHARP, _SHARPER = np.radians([65.0, 25.0])
_REACH = 6  # edges from there within which it is looked for
_ALLOWED = 6  # triangles that may intersect others
# By how much a shape is weakened where it folds, time after time; if that did not help, around the whole eye.
_DAMPING = ((True, 0.4), (True, 0.7), (False, 0.5), (False, 0.7), (False, 1.0))
_FEW, _PRESSING = 60, (1, 3)  # so many triangles of a blink at most; edges around them (:func:`affine_around`)
_SPREADING = 12  # edges over which that fades into the surroundings


def unfold_lids(face: AlignedFace, rig: Rig, eyes: Eyes) -> Rig:
    """Weaken expressions where they make the skin around the eyes intersect itself.

    An eye that is drawn tall has little skin above it, and a brow or a lid that comes as far as the template's is
    pushed through it. There, and fading into the surroundings, the expression is weakened until it fits. Each vertex
    stays on its straight way, so what was clear of the eyeball remains so. A blink, that must still close the eye, is
    smoothed there instead.

    Parameters
    ----------
    face : AlignedFace
    rig : Rig
    eyes : Eyes

    Returns
    -------
    Rig
        A new one; only shapes that folded the skin differ.
    """
    started = time.perf_counter()
    shapes = np.concatenate([rig.deltas, rig.gaze])
    for side, name in enumerate(SIDES):
        patch, blink = eye_patch(face.model, name), rig.names.index(f"eyeBlink{name.capitalize()}")
        looked_at = _suspects(face.model, name, rig.neutral, shapes)
        everything = np.arange(len(patch.faces))
        fading = around(face.model, patch.vertices, _SPREADING)
        crossing: np.ndarray | None = None
        for local, damping in _DAMPING:
            sheets = [Sheet(rig.neutral + shapes[k], triangles) for k, triangles in looked_at.items()]
            for k, hit in zip(tuple(looked_at), crossing_triangles(patch, sheets), strict=True):
                if len(hit) > _ALLOWED:
                    crossing = crossing_all(patch, rig.neutral) if crossing is None else crossing
                    hit = np.setdiff1d(hit, crossing)
                if len(hit) <= _ALLOWED or k == blink:
                    del looked_at[k]
                if len(hit) <= _ALLOWED:
                    continue
                if k == blink:
                    way = resolve_crossings(face.model, patch, rig.neutral, shapes[k], _ALLOWED)
                    way = _pressed(face.model, patch, rig.neutral, way)
                    shapes[k] = _outside(rig.neutral, way, patch.vertices, eyes.centres[side], eyes.radii[side])
                    continue
                if len(hit) > HOPELESS * len(patch.faces):
                    shapes[k] *= 1 - fading[:, None]  # as the last time would, without the times between
                    del looked_at[k]
                    continue
                weight = around(face.model, patch.vertices[patch.faces[hit]], _SPREADING) if local else fading
                shapes[k] *= 1 - damping * weight[:, None]
                looked_at[k] = everything  # what is weakened here may be pushed through what is not
    deltas, gaze = shapes[: len(rig.deltas)], shapes[len(rig.deltas) :]
    return rig.changed(started, deltas=deltas, gaze=gaze)


def _neighbours(patch: EyePatch) -> np.ndarray:
    """Pairs (e, 2) of triangles of a patch that share an edge."""
    edges = np.sort(patch.faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    order = np.lexsort(edges.T)
    same = (edges[order[1:]] == edges[order[:-1]]).all(1)
    return np.column_stack([order[:-1][same], order[1:][same]]) // 3


def _angles(patch: EyePatch, pairs: np.ndarray, V: np.ndarray) -> np.ndarray:
    """Angles (e,), radians, between the normals of pairs (e, 2) of neighbours."""
    a, b, c = (V[patch.vertices[corner]] for corner in patch.faces.T)
    normals = np.cross(b - a, c - a)
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
    return np.asarray(np.arccos(np.clip((normals[pairs[:, 0]] * normals[pairs[:, 1]]).sum(1), -1, 1)))


def _suspects(model: MorphableModel, side: str, neutral: np.ndarray, shapes: np.ndarray) -> dict[int, np.ndarray]:
    """The triangles of a patch that may cross, for each shape of which there are some.

    Those around edges that have become sharp.
    """
    patch = eye_patch(model, side)
    pairs = _neighbours(patch)
    still = _angles(patch, pairs, neutral)
    found = {}
    for k in np.flatnonzero(np.abs(shapes[:, patch.vertices]).max(axis=(1, 2)) > _MOVES):
        bent = _angles(patch, pairs, neutral + shapes[k])
        sharp = np.unique(pairs[(bent > _SHARP) & (bent > still + _SHARPER)])
        if len(sharp):
            near = around(model, patch.vertices[patch.faces[sharp]], _REACH)[patch.vertices] > 0
            found[int(k)] = np.flatnonzero(near[patch.faces].any(1))
    return found


def _pressed(model: MorphableModel, patch: EyePatch, start: np.ndarray, way: np.ndarray) -> np.ndarray:
    """Ways (n, 3) that are affine around what still crosses, if fewer triangles do then."""
    hit = np.setdiff1d(crossing_all(patch, start + way), crossing_all(patch, start))
    if not _ALLOWED < len(hit) <= _FEW:
        return way
    tried = affine_around(model, start, start + way, patch.vertices[patch.faces[hit]], *_PRESSING) - start
    return tried if len(crossing_all(patch, start + tried)) < len(hit) else way


def _outside(start: np.ndarray, way: np.ndarray, at: np.ndarray, centre: np.ndarray, radius: float) -> np.ndarray:
    """Ways (n, 3) whose ends at some vertices are outside an eyeball."""
    way = way.copy()
    way[at] += outwards(start[at] + way[at] - centre, np.full(len(at), radius * (1 + CLEARANCE)))
    return way
