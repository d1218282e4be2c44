"""A closed mouth without teeth in its slit.

Constants were judged on the seven examples and 15 caricatures (``benchmarks/lips.py``).
"""

import time
from functools import lru_cache

import numpy as np
from scipy.sparse.csgraph import dijkstra
from scipy.spatial import cKDTree

from toongeo.geometry import adjacency
from toongeo.geometry.polyline import arc_shares, interpolated
from toongeo.model import MorphableModel
from toongeo.model.anatomy.lip_line import LipLine, lip_line
from toongeo.pipeline.align.align_face import AlignedFace
from toongeo.pipeline.rig.rig import Rig

__all__ = ["close_slit"]

_CLOSED = 0.06  # of the mouth's width: a mouth whose lips are less apart in the picture is drawn closed
_ORDERED = 0.01  # of the mouth's width: lips that are less apart in the picture keep some of their distance in depth
_OVERLAP = 0.025  # of the mouth's width: by which the inner sides of closed lips overlap
_BEHIND_MM = (0.1, 0.8, 4.0, 10.0)  # on the template, from the line: where the overlap begins, is full, fades, ends


def close_slit(face: AlignedFace, rig: Rig) -> Rig:
    """Shut a mouth that is drawn closed, without a change to its picture.

    Points of closed lips are set a little apart, and a picture does not tell how far one lip is before the other: from
    the front or the side a slit may gape that the camera does not see, with teeth in it. Both lips are brought to one
    depth, along the rays of the camera, and behind the line where they meet their inner sides overlap. Where the points
    of a lower lip lie above those of the upper one, the lips stay one before the other.

    Parameters
    ----------
    face : AlignedFace
    rig : Rig

    Returns
    -------
    Rig
        A new one with another neutral mouth, or the same if the mouth is open. Expressions move it as before.
    """
    started = time.perf_counter()
    line, neutral = lip_line(face.model), rig.neutral.copy()
    at_upper, at_lower = arc_shares(neutral[line.upper]), arc_shares(neutral[line.lower])
    ray, up = _ray_and_up(face, line, neutral)
    width = float(np.linalg.norm(neutral[line.upper[-1]] - neutral[line.upper[0]]))
    apart = interpolated(at_lower, at_upper, neutral[line.upper]) - neutral[line.lower]
    if np.abs(apart @ up).mean() > _CLOSED * width:
        return rig
    # Half of the way each, as far as the lips are in order.
    depth = (apart @ ray) * np.clip(apart @ up / (_ORDERED * width), 0, 1) / 2
    to_upper = -np.interp(at_upper, at_lower, depth)
    neutral[line.follows] += line.spread @ (np.r_[to_upper, depth[1:-1]][:, None] * ray)
    _overlap(face.model, line, neutral, up, _OVERLAP * width)
    return rig.changed(started, neutral=neutral)


def _ray_and_up(face: AlignedFace, line: LipLine, V: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Unit vectors: along the camera's ray through the mouth, and across the mouth in the picture."""
    camera, middle = face.fit.camera, V[line.vertices].mean(0, keepdims=True)
    px, depth = camera.project(middle), camera.depth(middle)
    ray = (camera.unproject(px, depth + 1) - camera.unproject(px, depth))[0]
    ray /= np.linalg.norm(ray)
    axis = V[line.upper[-1]] - V[line.upper[0]]
    up = np.cross(ray, axis)
    up *= np.sign(up[1]) / np.linalg.norm(up)
    return ray, up


def _overlap(model: MorphableModel, line: LipLine, V: np.ndarray, up: np.ndarray, overlap: float) -> None:
    """Bring the inner sides of the lips together behind the line where they meet, in place."""
    at_upper, at_lower = arc_shares(V[line.upper]), arc_shares(V[line.lower])
    meeting = interpolated(at_lower, at_upper, V[line.upper] @ up[:, None])[:, 0] + V[line.lower] @ up
    for inner, column, share, path, sign in zip(
        *_inner_sides(model), (line.upper, line.lower), (1.0, -1.0), strict=True
    ):
        at = arc_shares(V[path])
        target = np.interp(at, at_lower, meeting / 2) - sign * overlap
        way = target - V[path] @ up
        V[inner] += (share * way[column])[:, None] * up


@lru_cache(maxsize=4)
def _inner_sides(model: MorphableModel) -> tuple[list[np.ndarray], list[np.ndarray], list[np.ndarray]]:
    """Of upper and lower lip: vertices (k,) inside, the nearest position on the path, how much they move."""
    line = lip_line(model)
    wall = np.flatnonzero(model.region("mouth_cavity"))
    (to_upper, upper), (to_lower, lower) = (
        cKDTree(model.mean[path]).query(model.mean[wall]) for path in (line.upper, line.lower)
    )
    share = np.interp(np.minimum(to_upper, to_lower), _BEHIND_MM, [0, 1, 1, 0])
    sides = _hanging_on(model, line, wall)
    masks = [(sides == side) & (share > 0) for side in (0, 1)]
    return (
        [wall[mask] for mask in masks],
        [column[mask] for column, mask in zip((upper, lower), masks, strict=True)],
        [share[mask] for mask in masks],
    )


def _hanging_on(model: MorphableModel, line: LipLine, wall: np.ndarray) -> np.ndarray:
    """0 for vertices of the wall that fewer edges part from the upper lip's line than from the lower one's, else 1."""
    inside = np.r_[wall, line.vertices]
    edges = adjacency(model.faces, len(model.mean)).tocsr()[inside][:, inside]
    steps = [
        # Not from the corners, which both lips share.
        dijkstra(edges, indices=np.flatnonzero(np.isin(inside, path[3:-3])), unweighted=True, min_only=True)
        for path in (line.upper, line.lower)
    ]
    return np.asarray((steps[0] > steps[1])[: len(wall)], int)
