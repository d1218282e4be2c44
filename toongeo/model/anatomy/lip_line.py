"""The line where the lips meet, and how the face around it follows when it moves."""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import scipy.sparse as sp
from scipy.spatial import cKDTree

from toongeo.geometry import cotangent_laplacian
from toongeo.geometry.operators.factor import factor_spd, solve
from toongeo.model import MorphableModel
from toongeo.model.anatomy.rims import opening_rim

__all__ = ["LipLine", "lip_line"]

_REACH_MM = 38.0  # on the template: how far from the line the face follows
_RED_MM = 5.0  # on the template: how far from the line a lip may come upon the other
_CLAMP = 1e-2  # least weight of an edge
_TENSION = 0.02  # 1/mm^2, of the plate: without it, a slope at the corner of the mouth would carry on beyond it


@dataclass(frozen=True, eq=False)
class LipLine:
    """Two paths over the skin from the right corner of the mouth to the left one, which they share.

    Attributes
    ----------
    upper, lower : (u,), (l,) int64
        Vertices where the red of a lip ends and the inside of the mouth begins.
    upper_red, lower_red : (r,) int64
        Skin of each lip next to its path.
    upper_column, lower_column : (r,) int64
        The vertex of the path, by its position in it, that is nearest to each.
    vertices : (u + l - 2,) int64
        Of both, each once: ``upper``, then ``lower`` without the corners.
    follows : (d,) int64
        Vertices around the line, and the line itself.
    spread : (d, u + l - 2) float64
        Their displacements for displacements of the line: a thin plate on the template, at rest beyond its reach.
    """

    upper: np.ndarray
    lower: np.ndarray
    upper_red: np.ndarray
    lower_red: np.ndarray
    upper_column: np.ndarray
    lower_column: np.ndarray
    vertices: np.ndarray
    follows: np.ndarray
    spread: np.ndarray


@lru_cache(maxsize=4)
def lip_line(model: MorphableModel) -> LipLine:
    """The line where the lips of a model meet.

    Parameters
    ----------
    model : MorphableModel

    Returns
    -------
    LipLine
    """
    upper, lower = _sides(model)
    vertices = np.r_[upper, lower[1:-1]]
    soft = model.region("skin") | model.region("mouth_cavity")
    near = cKDTree(model.mean[vertices]).query(model.mean)[0] < _REACH_MM
    # The nose stays: its underside would be drawn down with the upper lip.
    free = np.setdiff1d(np.flatnonzero(soft & near & ~model.region("nose")), vertices)
    around = (soft & near)[model.faces].any(1)
    used, faces = np.unique(model.faces[around & soft[model.faces].all(1)], return_inverse=True)
    V, F = model.mean[used], faces.reshape(-1, 3)
    stiffness = cotangent_laplacian(V, F, clamp=_CLAMP)
    area = np.linalg.norm(np.cross(V[F[:, 1]] - V[F[:, 0]], V[F[:, 2]] - V[F[:, 0]]), axis=1)
    mass = np.bincount(F.ravel(), np.repeat(area, 3), minlength=len(V)) / 6
    plate = sp.csr_matrix(stiffness @ sp.diags_array(1 / mass) @ stiffness + _TENSION * stiffness)
    inner, given = np.searchsorted(used, free), np.searchsorted(used, vertices)
    spread = solve(factor_spd(plate[inner][:, inner]), -plate[inner][:, given].toarray())
    red, column = zip(_red(model, upper, lower), _red(model, lower, upper), strict=True)
    follows = np.r_[vertices, free]
    return LipLine(upper, lower, *red, *column, vertices, follows, np.vstack([np.eye(len(vertices)), spread]))


def _red(model: MorphableModel, path: np.ndarray, other: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Skin (r,) that is near one path and farther from the other, and the nearest position on the path (r,)."""
    skin = np.setdiff1d(np.flatnonzero(model.region("face")), np.r_[path, other])
    distance, column = cKDTree(model.mean[path]).query(model.mean[skin])
    red = (distance < _RED_MM) & (distance < cKDTree(model.mean[other]).query(model.mean[skin])[0])
    return skin[red], column[red]


def _sides(model: MorphableModel) -> tuple[np.ndarray, np.ndarray]:
    """Upper and lower path (k,): the border of the skin at the mouth cavity, parted where it is widest."""
    line = opening_rim(model, "mouth_cavity")
    outside = model.faces[~model.region("mouth_cavity")[model.faces].any(1)]
    edges = outside[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
    edges = edges[np.isin(edges, line).all(1)]
    _, first, count = np.unique(np.sort(edges, 1), axis=0, return_index=True, return_counts=True)
    following = dict(edges[first[count == 1]].tolist())
    x = model.mean[:, 0]
    loop = [int(line[x[line].argmin()])]
    while (after := following[loop[-1]]) != loop[0]:
        loop.append(after)
    far = int(x[loop].argmax())
    paths = np.array(loop[: far + 1]), np.array([loop[0], *loop[: far - 1 : -1]])
    upper, lower = sorted(paths, key=lambda path: -model.mean[path, 1].mean())
    return upper, lower
