"""Noses that stand out no farther than noses do.

Constants were chosen on one half of the pictures (``benchmarks/looks.py``).
"""

import numpy as np

from toongeo.geometry import adjacency
from toongeo.model import MorphableModel
from toongeo.model.ibug68 import LID_RIMS, LIP_RIMS, PARTS
from toongeo.protocols import HeadCamera

__all__ = ["bounded_nose", "protrusion"]

# Inner corners of the eyes, corners of the mouth; ends of the jaw.
_CORNERS = [
    LID_RIMS["lid_upper_right"][-1],
    LID_RIMS["lid_upper_left"][0],
    *np.array(LIP_RIMS["lip_upper_outer"])[[0, -1]],
]
_BREADTH = PARTS["jaw"][[0, -1]]
# Protrusion over the mean face's: up to the first a nose stays, and none comes to stand out by more than both together.
_FREE, _MORE = 1.25, 0.3
# Of the face's breadth: so far at most the tip goes to one side. A turned head tells how long its nose is.
_ASIDE = 0.03
_MOST = 0.8  # of its height a nose may lose: it stays one
_RINGS = 8  # edges from the border of the nose, over which the change grows to its whole


def bounded_nose(model: MorphableModel, camera: HeadCamera, V: np.ndarray) -> np.ndarray:
    """Vertices whose nose, if it stands out much farther than the mean face's, is moved back along the line of sight.

    How far a nose comes towards the viewer no landmark of a frontal picture tells; a flow that lets what is drawn large
    grow in depth makes needles of noses. What the picture shows does not change: every vertex stays on its ray.

    Parameters
    ----------
    model : MorphableModel
    camera : HeadCamera
    V : (n, 3) float, mm, model frame

    Returns
    -------
    (n, 3) float64
        ``V`` itself if there is nothing to move.
    """
    nose = model.region("nose")
    if not nose.any():
        return V
    ratio = protrusion(model, V) / protrusion(model, model.mean)
    if ratio <= _FREE:
        return V
    bounded = _FREE + _MORE * (1 - np.exp(-(ratio - _FREE) / _MORE))
    middle, normal = _plane(V[model.landmarks])
    inside = _rings_inside(model, nose)
    border = nose & (inside == 1)
    height = (V - middle) @ normal
    above = np.clip(height - np.median(height[border]), 0, None)
    too_much = (1 - bounded / ratio) * height[nose].max()
    fade = np.clip(inside / _RINGS, 0, 1)
    sight = camera.view(np.eye(3))[:, 2] - camera.view(np.zeros((1, 3)))[0, 2]
    towards = max(float(normal @ sight), 0.5)
    aside = np.sqrt(max(1 - towards**2, 0.0)) / towards  # of a mm back, along the plane
    breadth = np.linalg.norm(np.subtract(*V[model.landmarks[_BREADTH]]))
    too_much = min(too_much, _ASIDE * breadth / max(aside, 1e-9))
    back = min(too_much / max(above[nose].max(), 1e-9), _MOST) * above * fade * fade * (3 - 2 * fade)
    depth = camera.depth(V) - back / towards
    moved = camera.unproject(camera.project(V), depth)
    return np.asarray(np.where((back > 0)[:, None], moved, V))


def protrusion(model: MorphableModel, V: np.ndarray) -> float:
    """How far the nose of a face V (n, 3) stands before the plane of eye and mouth corners, over the face's breadth."""
    points = V[model.landmarks]
    middle, normal = _plane(points)
    breadth = np.linalg.norm(np.subtract(*points[_BREADTH]))
    return float(((V[model.region("nose")] - middle) @ normal).max() / breadth)


def _plane(points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Middle (3,) and unit normal (3,), forwards, of the plane of inner eye corners and corners of the mouth."""
    corners = points[_CORNERS]
    middle = corners.mean(0)
    normal = np.linalg.svd(corners - middle)[2][2]
    return middle, normal * np.sign(normal[2])


def _rings_inside(model: MorphableModel, nose: np.ndarray) -> np.ndarray:
    """How many edges (n,) each vertex is from the outside of the nose, up to the rings that matter; 0 outside."""
    edges = adjacency(model.faces, len(nose)).astype(float)
    rings, near = np.zeros(len(nose)), ~nose
    for _ in range(_RINGS):
        rings += ~near
        near = near | (edges @ near > 0)
    return rings
