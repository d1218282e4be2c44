"""Expressions that do not fold the skin around the eyes."""

import dataclasses
import time

import numpy as np

from toongeo.model import MorphableModel
from toongeo.pipeline.align.align_face import AlignedFace
from toongeo.pipeline.rig.crossing_triangles import Sheet, around, crossing_all, crossing_triangles, smoothed_ways
from toongeo.pipeline.rig.eye_patch import EyePatch, eye_patch
from toongeo.pipeline.rig.fit_eyes import SIDES
from toongeo.pipeline.rig.lid_rings import lid_rings
from toongeo.pipeline.rig.rig import Rig

MOVES = 0.3  # mm: shapes that move the skin around an eye less than this are not looked at
SHARP = np.radians(65.0)  # between the normals of neighbours: skin that passes through itself has such an edge nearby
REACH = 8  # edges from there within which it is looked for
ALLOWED = 6  # triangles that may intersect others
DAMPING = (0.4, 0.7, 1.0, 1.0, 1.0)  # by how much a shape is weakened where it folds, time after time
SPREADING = 12  # edges over which that fades into the surroundings


def unfold_lids(face: AlignedFace, rig: Rig) -> Rig:
    """Weaken expressions where they make the skin around the eyes intersect itself.

    An eye that is drawn tall has little skin above it, and a brow or a lid that comes as far as the template's is
    pushed through it. There, and fading into the surroundings, the expression is weakened until it fits. Each vertex
    stays on its straight way, so what was clear of the eyeball remains so. The blinks are left as they are.

    Parameters
    ----------
    face : AlignedFace
    rig : Rig

    Returns
    -------
    Rig
        A new one; only shapes that folded the skin differ.
    """
    started = time.perf_counter()
    shapes = np.concatenate([rig.deltas, rig.gaze])
    blinks = [k for k, name in enumerate(rig.names) if name.startswith("eyeBlink")]
    for name in SIDES:
        patch = eye_patch(face.model, name)
        pairs = _neighbours(patch)
        moves = np.abs(shapes[:, patch.vertices]).max(axis=(1, 2)) > MOVES
        moves[blinks] = False
        still = _sharp(patch, pairs, rig.neutral)
        bent = {k: pairs[_sharp(patch, pairs, rig.neutral + shapes[k]) & ~still] for k in np.flatnonzero(moves)}
        rings = lid_rings(face.model, name).vertices
        margin = np.abs(shapes[:, rings]).max(axis=(1, 2)) > MOVES
        suspects = {k: np.unique(found) for k, found in bent.items() if len(found) or margin[k]}
        margins = np.flatnonzero(np.isin(patch.faces, np.searchsorted(patch.vertices, rings)).any(1))
        crossing = crossing_all(patch, rig.neutral)
        blink = rig.names.index(f"eyeBlink{name.capitalize()}")
        shapes[blink] = smoothed_ways(face.model, patch, rig.neutral, shapes[blink], crossing, ALLOWED)
        looked_at = {k: np.union1d(_near(face.model, patch, at, REACH), margins) for k, at in suspects.items()}
        for damping in DAMPING:
            sheets = [Sheet(rig.neutral + shapes[k], triangles) for k, triangles in looked_at.items()]
            for k, hit in zip(tuple(looked_at), crossing_triangles(patch, sheets), strict=True):
                hit = np.setdiff1d(hit, crossing)
                if len(hit) <= ALLOWED:
                    del looked_at[k]
                    continue
                weight = around(face.model, patch.vertices[patch.faces[hit]], SPREADING)
                shapes[k] *= 1 - damping * weight[:, None]
                looked_at[k] = np.arange(len(patch.faces))  # what is weakened here may be pushed through what is not
    deltas, gaze = shapes[: len(rig.deltas)], shapes[len(rig.deltas) :]
    report = {**rig.report, "seconds": rig.report["seconds"] + time.perf_counter() - started}
    return dataclasses.replace(rig, deltas=deltas, gaze=gaze, report=report)


def _neighbours(patch: EyePatch) -> np.ndarray:
    """Pairs (e, 2) of triangles of a patch that share an edge."""
    edges = np.sort(patch.faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    order = np.lexsort(edges.T)
    same = (edges[order[1:]] == edges[order[:-1]]).all(1)
    return np.column_stack([order[:-1][same], order[1:][same]]) // 3


def _sharp(patch: EyePatch, pairs: np.ndarray, V: np.ndarray) -> np.ndarray:
    """Which pairs (e, 2) of neighbours meet at a sharp edge, (e,) bool."""
    a, b, c = (V[patch.vertices[corner]] for corner in patch.faces.T)
    normals = np.cross(b - a, c - a)
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
    return np.asarray((normals[pairs[:, 0]] * normals[pairs[:, 1]]).sum(1) < np.cos(SHARP))


def _near(model: MorphableModel, patch: EyePatch, suspects: np.ndarray, reach: int) -> np.ndarray:
    """The triangles of a patch within so many edges of some of them (s,)."""
    near = around(model, patch.vertices[patch.faces[suspects]], reach)[patch.vertices] > 0
    return np.flatnonzero(near[patch.faces].any(1))
