"""The 68 landmark vertices and the 17 jaw contour lines of the refined head."""

from __future__ import annotations

import csv
from pathlib import Path

import igl
import numpy as np
from head import Head
from scipy.spatial import cKDTree
from source import Floats, Ints

# iBUG index of the same point on the other side of the face.
MIRRORED = np.r_[
    16:-1:-1,
    26:16:-1,
    27:31,
    35:30:-1,
    45:41:-1,
    47:45:-1,
    39:35:-1,
    41:39:-1,
    54:47:-1,
    59:54:-1,
    64:59:-1,
    67:64:-1,
]
# Axis inside the head about which a contour line runs from front to back, as z in mm.
_AXIS_Z = -63.0
# How far (rad about the axis) a line reaches in front of the frontal contour point and behind it, and how
# near (mm) it comes to the middle of the face, by jaw point 0..8.
_FRONT = (1.0, 1.0, 1.0, 0.9, 0.8, 0.6, 0.45, 0.4, 0.3)
_MIDDLE = (53.0, 48.0, 44.0, 40.0, 36.0, 25.0, 15.0, 7.0, 0.0)
_BACK = (0.1, 0.1, 0.1, 0.04, 0.04, 0.04, 0.04, 0.04, 0.04)


def picked_landmarks(head: Head) -> Ints:
    """The landmarks (68,) of the picks table and their mirror images; jaw points (0-16) are -1 still."""
    out = np.full(68, -1)
    with (Path(__file__).parent / "landmark_picks.csv").open(encoding="utf-8") as file:
        for row in csv.DictReader(line for line in file if not line.startswith("#")):
            k, ids = int(row["index"]), [int(v) for v in row["source"].split("-")]
            out[k] = head.fine_of(ids)
            out[MIRRORED[k]] = head.mirror1[out[k]]
    return out


def contour_lines(head: Head, landmarks: Ints, allowed: np.ndarray) -> list[Ints]:
    """17 lines of L1 vertices, front to back, that the jaw points slide on; `allowed` (n1,) are skin without
    ears.

    Line k lies in a half plane through the axis that leaves the face at the frontal outline; the outline from
    eye level to chin is divided into equal lengths.
    """
    x = head.fine(head.mean)
    eye_line = x[landmarks[[36, 45]], 1].mean()
    normals = igl.per_vertex_normals(x, head.triangles)
    usable = head.triangles[(allowed | (head.part1 == 1))[head.triangles].all(1)]
    angles = np.radians(np.linspace(-0.5, -90, 120))
    slices = [_slice(x, normals, usable, allowed, eye_line, a) for a in angles]
    outline = np.array([s[_frontal(s)][:2] for s in slices])
    length = np.r_[0, np.cumsum(np.linalg.norm(np.diff(outline, axis=0), axis=1))]
    nine = np.interp(np.linspace(0, length[-1], 9), length, angles)
    nine[8] = np.radians(-89.9)
    left = []
    for k, angle in enumerate(nine):
        points = _reach(_slice(x, normals, usable, allowed, eye_line, angle), _FRONT[k], _BACK[k], _MIDDLE[k])
        near = np.flatnonzero(allowed & (np.abs(x[:, 0]) < 1e-6 if k == 8 else x[:, 0] > -1e-6))
        ids = near[cKDTree(x[near]).query(points[:, :3])[1]]
        left.append(np.array(list(dict.fromkeys(ids.tolist()))))
    return [head.mirror1[line] for line in left[:8]] + left[8:] + left[7::-1]


def jaw_points(lines: list[Ints], normals: Floats) -> Ints:
    """The frontal jaw landmarks (17,): the first vertex of each line that turns away from the viewer."""
    first = [np.flatnonzero(normals[line, 2] <= 0) for line in lines]
    return np.array([line[f[0]] if len(f) else line[-1] for line, f in zip(lines, first, strict=True)])


def _slice(x: Floats, normals: Floats, triangles: Ints, allowed: np.ndarray, y0: float, angle: float) -> Floats:
    """The cut of the surface with a half plane about the z axis at height y0: rows x, y, z, angle about the
    inner axis, normal z, allowed; front to back."""
    along = np.array([np.cos(angle), np.sin(angle)])
    across = np.array([-along[1], along[0]])
    flat = x[:, :2] - [0, y0]
    side, radius = flat @ across, flat @ along
    edges = np.vstack([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    a, b = edges[side[edges[:, 0]] * side[edges[:, 1]] < 0].T
    t = (side[a] / (side[a] - side[b]))[:, None]
    r = radius[a] + (radius[b] - radius[a]) * t[:, 0]
    point = x[a] + (x[b] - x[a]) * t
    normal_z = normals[a, 2] + (normals[b, 2] - normals[a, 2]) * t[:, 0]
    turn = np.arctan2(r, point[:, 2] - _AXIS_Z)
    rows = np.column_stack([point, turn, normal_z, allowed[a] & allowed[b]])[r > 0]
    return rows[np.argsort(rows[:, 3], kind="stable")]


def _frontal(cut: Floats) -> int:
    """Row of a cut where the frontal outline lies: past the front of the face, the first that faces
    sideways."""
    found = np.flatnonzero((cut[:, 3] > 0.8) & ((cut[:, 4] <= 0) | (cut[:, 5] < 0.5)))
    return int(found[0]) if len(found) else len(cut) - 1


def _reach(cut: Floats, front: float, back: float, nearest: float) -> Floats:
    middle = _frontal(cut)
    last = middle
    while (
        last + 1 < len(cut)
        and cut[last + 1, 5] > 0.5
        and cut[last + 1, 4] > -0.45
        and cut[last + 1, 3] - cut[middle, 3] < back
    ):
        last += 1
    part = cut[np.searchsorted(cut[:, 3], cut[middle, 3] - front) : last + 1]
    return part[np.abs(part[:, 0]) >= nearest]
