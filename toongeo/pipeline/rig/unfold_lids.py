"""Expressions that do not fold the skin around the eyes."""

import dataclasses
import time

import numpy as np

from toongeo.geometry import self_intersections
from toongeo.model import MorphableModel
from toongeo.pipeline.align.align_face import AlignedFace
from toongeo.pipeline.rig.clear_lids import neighbour_means
from toongeo.pipeline.rig.eye_patch import EyePatch, eye_patch
from toongeo.pipeline.rig.fit_eyes import SIDES
from toongeo.pipeline.rig.rig import Rig

MOVES = 0.3  # mm: shapes that move the skin around an eye less than this are not looked at
SHARP = np.radians(65.0)  # between the normals of neighbours: skin that passes through itself has such an edge nearby
REACH = 10  # edges from there within which it is looked for
ALLOWED = 6  # triangles that may intersect others
AGAIN = 4  # edges from what was found, within which it is looked for again
DAMPING = (0.4, 0.7, 1.0)  # by how much a shape is weakened where it folds, the first, second and third time
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
    deltas, gaze = rig.deltas.copy(), rig.gaze.copy()
    blinks = [k for k, name in enumerate(rig.names) if name.startswith("eyeBlink")]
    for name in SIDES:
        patch = eye_patch(face.model, name)
        pairs = _neighbours(patch)
        sharp, crossing = _sharp(patch, pairs, rig.neutral), _crossing(patch, rig.neutral, np.arange(len(patch.faces)))
        for shapes in (deltas, gaze):
            moves = np.abs(shapes[:, patch.vertices]).max(axis=(1, 2)) > MOVES
            if shapes is deltas:
                moves[blinks] = False
            for k in np.flatnonzero(moves):
                V = rig.neutral + shapes[k]
                suspects, reach = pairs[_sharp(patch, pairs, V) & ~sharp], REACH
                for damping in DAMPING if len(suspects) else ():
                    near = _around(face.model, patch.vertices[patch.faces[suspects]], reach)[patch.vertices] > 0
                    hit = np.setdiff1d(_crossing(patch, V, np.flatnonzero(near[patch.faces].any(1))), crossing)
                    if len(hit) <= ALLOWED:
                        break
                    weight = _around(face.model, patch.vertices[patch.faces[hit]], SPREADING)
                    shapes[k] *= 1 - damping * weight[:, None]
                    V, suspects, reach = rig.neutral + shapes[k], hit, AGAIN
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


def _crossing(patch: EyePatch, V: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Those of some triangles (k,) of a patch that intersect others of them."""
    if not len(triangles):
        return triangles
    return triangles[np.unique(self_intersections(V[patch.vertices], patch.faces[triangles]))]


def _around(model: MorphableModel, vertices: np.ndarray, steps: int) -> np.ndarray:
    """Weights (n,): 1 at vertices, less and less around them, zero beyond so many steps."""
    weight = np.zeros(len(model.mean))
    weight[vertices] = 1
    means = neighbour_means(model)
    for _ in range(steps):
        weight = np.maximum(weight, means @ weight)
    return weight
